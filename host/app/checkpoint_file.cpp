#include "app/checkpoint_file.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/provenance.h"
#include "app/version.h"
#include "core/error.h"
#include "core/fnv1a.h"
#include "core/input_file.h"
#include "io/atomic_file.h"
#include "render/kernels.h"

namespace vkcppm {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view magic = "vkcppmck";
constexpr std::uint64_t format = 4;  // of the header and of Integrator::save(): raised where either changes
constexpr std::uint64_t fixed_bytes = magic.size() + 3 * sizeof(std::uint64_t);
constexpr std::uint64_t most_header_bytes = 256u << 20;     // a million points of a curve
constexpr std::uint64_t most_state_bytes_per_pixel = 1024;  // no estimator keeps so much
constexpr std::uint64_t most_other_state_bytes = 4096;      // grid and histogram, padding of buffers
constexpr std::size_t chunk_bytes = 1u << 20;               // read at once for the checksum

static_assert(std::endian::native == std::endian::little, "files are little-endian");

class Writer {
public:
    explicit Writer(std::string& out) : out_(out) {}
    template <typename T> void value(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        out_.append(reinterpret_cast<const char*>(&value), sizeof(value));
    }
    void count(std::size_t count) { value(std::uint64_t(count)); }
    void text(std::string_view text) {
        count(text.size());
        out_.append(text);
    }

private:
    std::string& out_;
};

/// Reads what a Writer wrote; past the end it throws Error(bad_input).
class Reader {
public:
    Reader(std::string_view bytes, const fs::path& file) : rest_(bytes), file_(file) {}
    template <typename T> T value() {
        static_assert(std::is_trivially_copyable_v<T>);
        T value;
        std::memcpy(&value, take(sizeof(value)).data(), sizeof(value));
        return value;
    }
    /// Of things of at least `each` bytes that follow.
    std::size_t count(std::size_t each) {
        const auto count = value<std::uint64_t>();
        if (count > rest_.size() / each) fail(fmt::format("{} entries where {} bytes follow", count, rest_.size()));
        return count;
    }
    std::string text() { return std::string(take(count(1))); }
    void expect_end() const {
        if (!rest_.empty()) fail(fmt::format("{} bytes after its end", rest_.size()));
    }
    [[noreturn]] void fail(const std::string& what) const {
        throw Error(ExitCode::bad_input, fmt::format("{}: the checkpoint's header has {}", file_.string(), what));
    }

private:
    std::string_view take(std::size_t bytes) {
        if (bytes > rest_.size()) fail(fmt::format("{} bytes where {} are read", rest_.size(), bytes));
        const std::string_view taken = rest_.substr(0, bytes);
        rest_.remove_prefix(bytes);
        return taken;
    }
    std::string_view rest_;
    const fs::path& file_;
};

void write_header(Writer& header, const Identity& identity, const Checkpoint& checkpoint) {
    header.count(identity.size());
    for (const auto& [name, value] : identity) {
        header.text(name);
        header.text(value);
    }
    const Report& report = checkpoint.report;
    header.text(report.device);
    header.text(report.driver);
    header.value(report.iterations);
    header.value(report.emitted_paths);
    header.value(report.stored_photons);
    header.value(report.rays);
    header.value(report.invalid);
    header.value(report.wall_seconds);
    header.value(report.cpu_seconds);
    header.count(report.passes.size());
    for (const PassReport& pass : report.passes) {
        header.text(pass.name);
        header.value(pass.calls);
        header.value(pass.device_seconds);
    }
    header.count(checkpoint.curve.size());
    for (const CurvePoint& point : checkpoint.curve) header.value(point);
}

Identity read_identity(Reader& header) {
    Identity identity(header.count(2 * sizeof(std::uint64_t)));
    for (auto& [name, value] : identity) {
        name = header.text();
        value = header.text();
    }
    return identity;
}

/// What follows the identity.
Checkpoint read_header(Reader& header) {
    Checkpoint checkpoint;
    Report& report = checkpoint.report;
    report.device = header.text();
    report.driver = header.text();
    report.iterations = header.value<std::uint64_t>();
    if (report.iterations < 1 || report.iterations > max_iterations) {
        header.fail(fmt::format("{} iterations, outside 1..{}", report.iterations, max_iterations));
    }
    report.emitted_paths = header.value<std::uint64_t>();
    report.stored_photons = header.value<std::uint64_t>();
    report.rays = header.value<std::uint64_t>();
    report.invalid = header.value<std::uint64_t>();
    report.wall_seconds = header.value<double>();
    report.cpu_seconds = header.value<double>();
    report.passes.resize(header.count(3 * sizeof(std::uint64_t)));
    for (PassReport& pass : report.passes) {
        pass.name = header.text();
        pass.calls = header.value<std::uint64_t>();
        pass.device_seconds = header.value<double>();
    }
    checkpoint.curve.resize(header.count(sizeof(CurvePoint)));
    for (CurvePoint& point : checkpoint.curve) point = header.value<CurvePoint>();
    header.expect_end();
    return checkpoint;
}

/// A checkpoint file, open and found whole.
class OpenCheckpoint {
public:
    explicit OpenCheckpoint(const fs::path& file) : file_(file) {
        require_file(file);
        stream_.open(file, std::ios::binary);
        std::error_code ignored;
        const std::uint64_t size = stream_ ? fs::file_size(file, ignored) : 0;
        std::string fixed = size < fixed_bytes + sizeof(std::uint64_t) ? "" : read(fixed_bytes);
        if (!fixed.starts_with(magic)) fail("is no checkpoint of vkcppm");
        std::uint64_t words[3];
        std::memcpy(words, fixed.data() + magic.size(), sizeof(words));
        if (words[0] != format) {
            fail(fmt::format("is a checkpoint of format {}, this program reads format {}", words[0], format));
        }
        header_bytes_ = words[1];
        state_bytes_ = words[2];
        const std::uint64_t rest = size - fixed_bytes - sizeof(std::uint64_t);
        if (header_bytes_ > rest || state_bytes_ != rest - header_bytes_) {
            fail(fmt::format("is damaged: it has {} bytes, its header tells of {} + {} and {} around them", size,
                             header_bytes_, state_bytes_, fixed_bytes + sizeof(std::uint64_t)));
        }
        if (header_bytes_ > most_header_bytes) {
            fail(fmt::format("has a header of {} bytes, the limit is {}", header_bytes_, most_header_bytes));
        }
        std::uint64_t hash = fnv1a_of(fixed);
        for (std::uint64_t left = rest; left > 0;) {
            const std::string chunk = read(std::min<std::uint64_t>(left, chunk_bytes));
            hash = fnv1a_of(chunk, hash);
            left -= chunk.size();
        }
        std::uint64_t stored = 0;
        std::memcpy(&stored, read(sizeof(stored)).data(), sizeof(stored));
        if (stored != hash) {
            fail(fmt::format("is damaged: its checksum is {}, it says {}", hash_text(hash), hash_text(stored)));
        }
    }

    std::string header() {
        stream_.seekg(fixed_bytes);
        return read(header_bytes_);
    }

    std::vector<std::byte> state(std::size_t pixels) {
        const std::uint64_t most = pixels * most_state_bytes_per_pixel + most_other_state_bytes;
        if (state_bytes_ > most) {
            fail(fmt::format("has a state of {} bytes, the limit of its picture is {}", state_bytes_, most));
        }
        stream_.seekg(std::streamoff(fixed_bytes + header_bytes_));
        std::vector<std::byte> state(state_bytes_);
        read_into(reinterpret_cast<char*>(state.data()), state.size());
        return state;
    }

private:
    [[noreturn]] void fail(const std::string& why) const {
        throw Error(ExitCode::bad_input, fmt::format("{} {}", file_.string(), why));
    }
    void read_into(char* to, std::size_t bytes) {
        if (!stream_.read(to, std::streamsize(bytes))) fail(fmt::format("cannot be read: {}", std::strerror(errno)));
    }
    std::string read(std::size_t bytes) {
        std::string text(bytes, '\0');
        read_into(text.data(), bytes);
        return text;
    }

    const fs::path& file_;
    std::ifstream stream_;
    std::uint64_t header_bytes_ = 0;
    std::uint64_t state_bytes_ = 0;
};

}  // namespace

std::uint64_t hash_of(const Image& image) { return fnv1a_of(std::span<const glm::vec3>(image.rgb)); }

Identity identity_of(const SceneOptions& options, const Scene& scene, const Settings& settings,
                     const Image* reference) {
    Identity identity = {{"version", version()}, {"kernels", hash_text(kernels_hash())}};
    nlohmann::ordered_json json = settings_json(settings, setting::is_identity);
    const nlohmann::ordered_json of_scene = scene_json(options, scene);
    json["scene_hash"] = of_scene["hash"];
    json["thin_glass"] = of_scene["thin_glass"];
    if (reference) json["reference_hash"] = hash_text(hash_of(*reference));
    for (const auto& [name, value] : json.items()) {
        identity.emplace_back(name, value.is_string() ? value.get<std::string>() : json_text(value));
    }
    return identity;
}

void require_same(const Identity& there, const Identity& asked, const fs::path& file, const std::string& in) {
    const auto value_in = [](const Identity& identity, const std::string& name) -> std::string {
        const auto found = std::ranges::find(identity, name, &Identity::value_type::first);
        return found == identity.end() ? "absent" : found->second;
    };
    std::vector<std::string> differences;
    const auto look_at = [&](const std::string& name) {
        const std::string a = value_in(there, name), b = value_in(asked, name);
        if (a != b) differences.push_back(fmt::format("{}: {} in {}, {} asked", name, a, in, b));
    };
    for (const auto& [name, value] : asked) look_at(name);
    for (const auto& [name, value] : there) {
        if (value_in(asked, name) == "absent") look_at(name);
    }
    if (!differences.empty()) {
        throw Error(ExitCode::usage,
                    fmt::format("{} is of another render: {}", file.string(), fmt::join(differences, "; ")));
    }
}

void write_checkpoint(const fs::path& file, const Identity& identity, const Checkpoint& checkpoint) {
    std::string header;
    Writer header_writer(header);
    write_header(header_writer, identity, checkpoint);
    std::string fixed(magic);
    Writer fixed_writer(fixed);
    for (const std::uint64_t word : {format, std::uint64_t(header.size()), std::uint64_t(checkpoint.state.size())}) {
        fixed_writer.value(word);
    }
    // The state is by far the largest: it is written from where it lies.
    const std::string_view state(reinterpret_cast<const char*>(checkpoint.state.data()), checkpoint.state.size());
    std::string hash;
    Writer(hash).value(fnv1a_of(state, fnv1a_of(header, fnv1a_of(fixed))));
    write_file(file, {fixed, header, state, hash});
}

Checkpoint read_checkpoint(const fs::path& file, const Identity& identity, std::size_t pixels) {
    OpenCheckpoint open(file);
    const std::string bytes = open.header();
    Reader header(bytes, file);
    require_same(read_identity(header), identity, file, "the checkpoint");
    Checkpoint checkpoint = read_header(header);
    checkpoint.state = open.state(pixels);
    return checkpoint;
}

}  // namespace vkcppm
