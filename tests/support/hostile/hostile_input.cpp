#include "support/hostile/hostile_input.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string_view>

#include "core/fnv1a.h"
#include "flat/flatten.h"
#include "io/environment.h"
#include "io/exr.h"
#include "scene/diagnosis/diagnosis.h"
#include "scene/gltf/gltf.h"
#include "scene/gltf/picture.h"
#include "support/files/files.h"
#include "support/hostile/soundness.h"
#include "support/thrown.h"

namespace vkcppm::test {
namespace {

constexpr std::size_t longest_line = 600;
constexpr std::size_t most_flattened_triangles = 4096;  // more triangles find nothing new

/// What is wrong with the line of an error about `file`.
std::string bad_line(const Error& error, const std::filesystem::path& file) {
    const std::string line = error.what();
    if (error.code() != ExitCode::bad_input) return "exit code " + std::to_string(int(error.code())) + ": " + line;
    if (!line.starts_with(file.string() + ": ")) return "it does not begin with the file: " + line;
    if (line.size() > longest_line + file.string().size()) return "it is long: " + line;
    if (std::ranges::any_of(line, [](unsigned char c) { return c == '\n'; })) return "it is no line: " + line;
    for (const char* catch_all :
         {"the file is refused; ", "the document is refused by tinygltf", "its size is too large; "}) {
        if (line.starts_with(file.string() + ": " + catch_all)) return "no check of ours found it: " + line;
    }
    return "";
}

std::string read_scene(const std::filesystem::path& file, const GltfOptions& options) {
    Scene scene = load_gltf(file, options);
    if (const std::string text = unsoundness(scene); !text.empty()) return "unsound: " + text;
    const auto is_line = [](const std::string& line) { return line.find('\n') == std::string::npos; };
    if (!std::ranges::all_of(diagnose(scene), is_line)) return "a diagnosis of two lines";
    if (scene.triangles.size() > most_flattened_triangles) return "";
    const FlatScene flat = flatten(scene);
    if (!std::isfinite(flat.area) || !std::isfinite(flat.radius) || !std::isfinite(flat.light_power)) {
        return "the measures of the flat scene are not finite";
    }
    return "";
}

/// With copies, mostly, with instances wherever there can be some, and in the midst of all animations.
std::string read_scene(const std::filesystem::path& file) {
    return read_scene(file, GltfOptions()) + read_scene(file, {.sharing = Sharing::always}) +
           read_scene(file, {.animation = "all", .at = 0.3});
}

std::string read_environment_of(const std::filesystem::path& file) {
    std::uint64_t hash = fnv1a_start;
    std::vector<std::string> warnings;
    const Image image = read_environment(file, hash, warnings);
    return image.rgb.size() == image.extent.pixels() && !image.rgb.empty() ? "" : "an environment without pixels";
}

std::string read_exr_picture(const std::filesystem::path& file) {
    const Image image = read_exr(file);
    read_exr_channels(file, "");  // all of them
    read_exr_attributes(file);
    return image.rgb.size() == image.extent.pixels() && !image.rgb.empty() ? "" : "a picture without pixels";
}

std::string read_texture(const std::string& bytes) {
    const std::span data(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    try {
        const Extent size = picture_size(data);
        if (size.pixels() == 0) return "a texture without texels";
        if (size.width > 16384 || size.height > 16384 || size.pixels() > (1u << 22)) return "";
        const Picture picture = decode_picture(data);
        const bool is_whole = picture.rgba.size() == 4 * size.pixels() &&
                              (picture.rest.empty() || picture.rest.size() == picture.rgba.size());
        return is_whole ? "" : "a texture of another size than it has";
    } catch (const std::runtime_error& error) {
        return std::string_view(error.what()).empty() ? "no reason" : "";
    }
}

}  // namespace

std::string misbehaviour(const std::string& bytes) {
    const auto begins = [&](std::string_view magic) { return bytes.starts_with(magic); };
    if (begins("\x89PNG") || begins("\xff\xd8\xff") || begins("RIFF")) return read_texture(bytes);
    static const TemporaryFolder folder;
    const std::filesystem::path file = folder / "hostile";
    write_bytes(file, bytes);
    std::string found;
    const auto check = [&](std::string (*read)(const std::filesystem::path&)) {
        const auto error = thrown_by([&] { found += read(file); });
        if (error) found += bad_line(*error, file);
    };
    if (begins("\x76\x2f\x31\x01")) check(read_exr_picture);
    if (begins("\x76\x2f\x31\x01") || begins("#?")) {
        check(read_environment_of);
    } else {
        check(read_scene);
    }
    return found;
}

}  // namespace vkcppm::test
