#include "io/environment.h"

#include <cmath>
#include <cstring>
#include <fstream>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "core/fnv1a.h"
#include "io/exr.h"
#include "io/hdr.h"

namespace vkcppm {
namespace fs = std::filesystem;
namespace {

constexpr std::uintmax_t most_bytes = std::uintmax_t(1) << 30;  // 128 a pixel: more is taken for a mistake

std::vector<std::uint8_t> read_bytes(const fs::path& file) {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) throw Error(ExitCode::no_input, file.string() + ": no such file");
    const std::uintmax_t size = fs::file_size(file, error);
    if (!error && size > most_bytes) {
        throw Error(ExitCode::bad_scene,
                    fmt::format("{}: its size is {}; the limit is {} bytes", file.string(), size, most_bytes));
    }
    std::vector<std::uint8_t> bytes(error ? 0 : std::size_t(size));
    std::ifstream in(file, std::ios::binary);
    if (error || !in.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()))) {
        throw Error(ExitCode::no_input, file.string() + ": cannot be read");
    }
    return bytes;
}

bool begins_with(const std::vector<std::uint8_t>& bytes, std::string_view magic) {
    return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

Image decode(const std::vector<std::uint8_t>& bytes, const fs::path& file) {
    if (begins_with(bytes, "\x76\x2f\x31\x01")) return read_exr(file, most_environment_pixels);
    if (begins_with(bytes, "#?")) return decode_hdr(bytes, file, most_environment_pixels);
    throw Error(ExitCode::bad_scene, file.string() + ": is neither an OpenEXR nor a Radiance picture");
}

void check(const Image& image, const fs::path& file) {
    const Extent& size = image.extent;
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        const glm::vec3& v = image.rgb[i];
        const auto is_radiance = [](float x) { return x >= 0.0f && std::isfinite(x); };
        if (is_radiance(v.r) && is_radiance(v.g) && is_radiance(v.b)) continue;
        throw Error(ExitCode::bad_scene,
                    fmt::format("{}: pixel ({}, {}) is ({:g}, {:g}, {:g}); radiance must be finite and not negative",
                                file.string(), i % size.width, i / size.width, v.r, v.g, v.b));
    }
}

}  // namespace

Image read_environment(const fs::path& file, std::uint64_t& hash) {
    const std::vector<std::uint8_t> bytes = read_bytes(file);
    Image image = decode(bytes, file);
    check(image, file);
    hash = fnv1a(bytes, hash);
    return image;
}

}  // namespace vkcppm
