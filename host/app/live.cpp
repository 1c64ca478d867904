#include "app/live.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include "app/console.h"

namespace vkcppm {
namespace {

constexpr int patience_ms = 1000;         // for a viewer that does not answer
constexpr std::uint32_t tile_size = 128;  // pixels a side: what a viewer takes at a time

// Kinds of messages. A message is its length as 4 bytes, these included, its kind as 1, then members one after
// another, little-endian, strings with a 0 at their end.
constexpr std::uint8_t create_image = 4;
constexpr std::uint8_t update_image = 6;  // version 3: any layout of the numbers

static_assert(std::endian::native == std::endian::little);

/// Something of the socket that did not succeed; told and gone on from.
struct LiveError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

[[noreturn]] void fail_with_errno() { throw LiveError(std::strerror(errno == EAGAIN ? ETIMEDOUT : errno)); }

class Message {
public:
    explicit Message(std::uint8_t kind) {
        add(std::uint32_t(0));
        add(kind);
    }

    template <typename Number> void add(Number number) { add_bytes(&number, sizeof number); }
    void add_text(const std::string& text) { add_bytes(text.c_str(), text.size() + 1); }
    void add_channels() {
        add(std::int32_t(3));
        for (const char* name : {"R", "G", "B"}) add_text(name);
    }
    void add_bytes(const void* data, std::size_t count) { bytes_.append(static_cast<const char*>(data), count); }

    std::string take() {
        const auto length = std::uint32_t(bytes_.size());
        std::memcpy(bytes_.data(), &length, sizeof length);
        return std::move(bytes_);
    }

private:
    std::string bytes_;
};

constexpr std::uint8_t in_front = 1, as_it_is = 0;  // whether the viewer turns to the picture

std::string update_message(const std::string& name, const Image& image, std::uint32_t x, std::uint32_t y) {
    const std::uint32_t width = std::min(tile_size, image.extent.width - x);
    const std::uint32_t height = std::min(tile_size, image.extent.height - y);
    Message message(update_image);
    message.add(as_it_is);
    message.add_text(name);
    message.add_channels();
    for (const std::uint32_t number : {x, y, width, height}) message.add(std::int32_t(number));
    for (const std::int64_t offset : {0, 1, 2}) message.add(offset);
    for (const std::int64_t stride : {3, 3, 3}) message.add(stride);
    for (std::uint32_t row = y; row < y + height; ++row) {
        message.add_bytes(&image.rgb[std::size_t(row) * image.extent.width + x], width * sizeof(glm::vec3));
    }
    return message.take();
}

/// Connects within the patience. Returns the socket, or -1 with errno.
int connect_to(const addrinfo& at) {
    const int socket = ::socket(at.ai_family, at.ai_socktype | SOCK_CLOEXEC | SOCK_NONBLOCK, at.ai_protocol);
    if (socket < 0) return -1;
    int error = ::connect(socket, at.ai_addr, at.ai_addrlen) == 0 ? 0 : errno;
    if (error == EINPROGRESS) {
        pollfd waiting{socket, POLLOUT, 0};
        socklen_t size = sizeof error;
        if (::poll(&waiting, 1, patience_ms) != 1) {
            error = ETIMEDOUT;
        } else if (::getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size) != 0) {
            error = errno;
        }
    }
    if (error == 0) return socket;
    ::close(socket);
    errno = error;
    return -1;
}

int connect_to(const LiveAddress& address) {
    addrinfo wanted{};
    wanted.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    const int error = ::getaddrinfo(address.host.c_str(), address.port.c_str(), &wanted, &found);
    if (error != 0) throw LiveError(::gai_strerror(error));
    int socket = -1;
    for (const addrinfo* at = found; at && socket < 0; at = at->ai_next) socket = connect_to(*at);
    const int failed = errno;
    ::freeaddrinfo(found);
    errno = failed;
    if (socket < 0) fail_with_errno();
    return socket;
}

}  // namespace

std::string LiveAddress::text() const {
    return host.find(':') == std::string::npos ? fmt::format("{}:{}", host, port) : fmt::format("[{}]:{}", host, port);
}

std::string create_message(const std::string& name, Extent extent) {
    Message message(create_image);
    message.add(in_front);
    message.add_text(name);
    message.add(std::int32_t(extent.width));
    message.add(std::int32_t(extent.height));
    message.add_channels();
    return message.take();
}

std::vector<std::string> update_messages(const std::string& name, const Image& image) {
    std::vector<std::string> messages;
    for (std::uint32_t y = 0; y < image.extent.height; y += tile_size) {
        for (std::uint32_t x = 0; x < image.extent.width; x += tile_size) {
            messages.push_back(update_message(name, image, x, y));
        }
    }
    return messages;
}

LiveView::LiveView(LiveAddress address, std::string name) : address_(std::move(address)), name_(std::move(name)) {}

LiveView::~LiveView() {
    if (socket_ >= 0) ::close(socket_);
}

void LiveView::show(const Image& image) {
    try {
        if (socket_ < 0) {
            socket_ = connect_to(address_);
            send(create_message(name_, image.extent));
        }
        for (const std::string& message : update_messages(name_, image)) send(message);
        warned_ = false;
    } catch (const LiveError& error) {
        if (socket_ >= 0) ::close(std::exchange(socket_, -1));
        if (warned_) return;
        print_message(fmt::format("warning: --live {}: {}; the render goes on, and the viewer is tried again",
                                  address_.text(), error.what()));
        warned_ = true;
    }
}

void LiveView::send(const std::string& message) {
    std::string_view rest = message;
    while (!rest.empty()) {
        const ssize_t sent = ::send(socket_, rest.data(), rest.size(), MSG_NOSIGNAL);
        if (sent > 0) {
            rest.remove_prefix(std::size_t(sent));
            continue;
        }
        pollfd waiting{socket_, POLLOUT, 0};
        if (errno == EAGAIN && ::poll(&waiting, 1, patience_ms) == 1) continue;
        if (errno != EINTR) fail_with_errno();
    }
}

}  // namespace vkcppm
