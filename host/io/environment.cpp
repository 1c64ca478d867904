#include "io/environment.h"

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "core/error.h"
#include "core/fnv1a.h"
#include "io/exr.h"
#include "io/hdr.h"
#include "core/input_file.h"

namespace vkcppm {
namespace fs = std::filesystem;
namespace {

constexpr std::uintmax_t most_bytes = std::uintmax_t(1) << 30;  // 128 a pixel: more is taken for a mistake

std::vector<std::uint8_t> read_bytes(const fs::path& file) {
    std::error_code error;
    require_file(file);
    const std::uintmax_t size = fs::file_size(file, error);
    if (!error && size > most_bytes) {
        throw Error(ExitCode::bad_input,
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
    throw Error(ExitCode::bad_input, file.string() + ": is neither an OpenEXR nor a Radiance picture");
}

std::string shown(const Image& image, std::size_t i) {
    const glm::vec3& v = image.rgb[i];
    return fmt::format("pixel ({}, {}) is ({:g}, {:g}, {:g})", i % image.extent.width, i / image.extent.width, v.r, v.g,
                       v.b);
}

/// Pixels of a kind: the first of them, as it was, and how many they are.
struct OddPixels {
    std::string first;
    std::size_t count = 0;

    void add(const Image& image, std::size_t i) {
        if (count++ == 0) first = shown(image, i);
    }

    void tell(std::string_view what, const fs::path& file, std::vector<std::string>& warnings) const {
        if (count == 0) return;
        const std::string more = count > 1 ? fmt::format(" (and {} more)", count - 1) : "";
        warnings.push_back(fmt::format("{}: {}{}: {}", file.string(), first, more, what));
    }
};

/// Takes what is negative for 0, with a warning: sharpening, another gamut and lossy compression leave such pixels.
/// What is infinite was too bright for a half float, as the sun is in many panoramas: it becomes the brightest of them.
void mend(Image& image, const fs::path& file, std::vector<std::string>& warnings) {
    constexpr float infinity = std::numeric_limits<float>::infinity(), brightest_half = 65504.0f;
    OddPixels negative, infinite;
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        glm::vec3& v = image.rgb[i];
        if (v.r == infinity || v.g == infinity || v.b == infinity) {
            infinite.add(image, i);
            for (int c = 0; c < 3; ++c) v[c] = v[c] == infinity ? brightest_half : v[c];
        }
        if (!is_finite(v)) {
            throw Error(ExitCode::bad_input,
                        fmt::format("{}: {}; radiance must be finite", file.string(), shown(image, i)));
        }
        if (v.r >= 0.0f && v.g >= 0.0f && v.b >= 0.0f) continue;
        negative.add(image, i);
        v = glm::max(v, glm::vec3(0.0f));
    }
    negative.tell("negative radiance is taken as 0", file, warnings);
    infinite.tell("infinite radiance is taken as 65504, the brightest of half floats", file, warnings);
}

}  // namespace

Image read_environment(const fs::path& file, std::uint64_t& hash, std::vector<std::string>& warnings) {
    const std::vector<std::uint8_t> bytes = read_bytes(file);
    Image image = decode(bytes, file);
    mend(image, file, warnings);
    hash = fnv1a(bytes, hash);
    return image;
}

Image turned(const Image& image, double degrees) {
    const auto [width, height] = image.extent;
    const double turns = degrees / 360.0 - std::floor(degrees / 360.0);
    const double columns = (1.0 - turns) * width;  // towards higher ones
    const auto whole = std::uint32_t(columns);
    const auto share = float(columns - whole);
    Image result = image;
    for (std::uint32_t y = 0; y < height; ++y) {
        const std::size_t row = std::size_t(y) * width;
        for (std::uint32_t x = 0; x < width; ++x) {
            const std::uint32_t from = (x + 2 * width - whole % width) % width, before = (from + width - 1) % width;
            result.rgb[row + x] =
                share == 0.0f ? image.rgb[row + from] : glm::mix(image.rgb[row + from], image.rgb[row + before], share);
        }
    }
    return result;
}

}  // namespace vkcppm
