#pragma once
// The other side of --live: a viewer that takes what tev's protocol sends, written from the protocol alone.

#include <atomic>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <thread>

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/image.h"

namespace vkcppm::test {

/// Listens on a port of this machine until it goes, and takes one sender after another.
class Viewer {
public:
    /// patience: messages after which it hangs up, as a viewer that is closed.
    explicit Viewer(int patience = 1 << 30) : patience_(patience) {
        listening_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        at_.sin_family = AF_INET;
        at_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof at_;
        auto* at = reinterpret_cast<sockaddr*>(&at_);
        if (::bind(listening_, at, size) != 0 || ::listen(listening_, 4) != 0 ||
            ::getsockname(listening_, at, &size) != 0) {
            throw std::runtime_error("no port to listen on");
        }
        port_ = std::to_string(ntohs(at_.sin_port));
        thread_ = std::thread([this] { listen(); });
    }
    Viewer(const Viewer&) = delete;
    Viewer& operator=(const Viewer&) = delete;
    ~Viewer() { stop(); }

    std::string port() const { return port_; }

    /// Ends listening; what follows is what was seen.
    void stop() {
        if (!thread_.joinable()) return;
        // A last sender that says nothing comes after all that wait.
        ending_ = true;
        const int last = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        ::connect(last, reinterpret_cast<sockaddr*>(&at_), sizeof at_);
        ::close(last);
        thread_.join();
        ::close(listening_);
    }

    Image image;
    std::string name;
    std::string fault;  // of what was sent; empty: none
    int created = 0, updated = 0;

private:
    void listen() {
        while (true) {
            const int socket = ::accept(listening_, nullptr, nullptr);
            if (socket < 0) return;
            std::uint32_t length = 0;
            bool silent = true;
            while (patience_ > 0 && take(socket, &length, 4)) {
                silent = false;
                std::string bytes(length < 5 ? 0 : length - 4, '\0');
                if (bytes.empty() || !take(socket, bytes.data(), bytes.size())) {
                    fault = "a message is cut short";
                    break;
                }
                --patience_;
                try {
                    read(bytes);
                } catch (const std::exception& error) {
                    fault = error.what();
                }
            }
            ::close(socket);
            if (ending_ && silent) return;
        }
    }

    static bool take(int socket, void* bytes, std::size_t count) {
        return ::recv(socket, bytes, count, MSG_WAITALL) == ssize_t(count);
    }

    /// What is left of a message.
    struct Reader {
        const std::string& bytes;
        std::size_t at = 0;
        template <typename Number> Number number() {
            Number value{};
            if (at + sizeof value > bytes.size()) throw std::runtime_error("a message ends early");
            std::memcpy(&value, bytes.data() + at, sizeof value);
            at += sizeof value;
            return value;
        }
        std::string text() {
            const std::string value = bytes.c_str() + at;
            at += value.size() + 1;
            return value;
        }
    };

    void read(const std::string& bytes) {
        Reader message{bytes};
        const auto kind = message.number<std::uint8_t>();
        message.number<std::uint8_t>();  // whether to turn to it
        const std::string of = message.text();
        if (kind == 4) {
            name = of;
            image.extent.width = std::uint32_t(message.number<std::int32_t>());
            image.extent.height = std::uint32_t(message.number<std::int32_t>());
            image.rgb.assign(image.extent.pixels(), glm::vec3(-1.0f));
            if (channels(message) != "R G B ") throw std::runtime_error("channels of a picture");
            ++created;
        } else if (kind == 6) {
            if (of != name) throw std::runtime_error("a picture that nobody has made");
            if (channels(message) != "R G B ") throw std::runtime_error("channels of a tile");
            const auto x = message.number<std::int32_t>(), y = message.number<std::int32_t>();
            const auto width = message.number<std::int32_t>(), height = message.number<std::int32_t>();
            std::int64_t offset[3], stride[3];
            for (std::int64_t& number : offset) number = message.number<std::int64_t>();
            for (std::int64_t& number : stride) number = message.number<std::int64_t>();
            const std::size_t first = message.at;
            for (int i = 0; i < width * height; ++i) {
                const std::size_t pixel = std::size_t(y + i / width) * image.extent.width + std::size_t(x + i % width);
                for (int c = 0; c < 3; ++c) {
                    message.at = first + 4 * std::size_t(offset[c] + i * stride[c]);
                    image.rgb.at(pixel)[c] = message.number<float>();
                }
            }
            ++updated;
        } else {
            throw std::runtime_error("a message of kind " + std::to_string(kind));
        }
        if (message.at != bytes.size()) throw std::runtime_error("a message is too long");
    }

    static std::string channels(Reader& message) {
        std::string names;
        const auto count = message.number<std::int32_t>();
        for (int i = 0; i < count; ++i) names += message.text() + " ";
        return names;
    }

    int listening_ = -1;
    sockaddr_in at_{};
    std::atomic<bool> ending_ = false;
    int patience_;
    std::string port_;
    std::thread thread_;
};

}  // namespace vkcppm::test
