#include "app/outputs.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "core/ending.h"
#include "core/error.h"
#include "io/atomic_file.h"

namespace vkcppm {
namespace fs = std::filesystem;
namespace {

/// Endings by which programs tell formats: a file of one format that is called like another is taken for broken.
constexpr std::array<std::string_view, 22> known_endings = {
    ".exr", ".png", ".json", ".jpg", ".jpeg", ".hdr",  ".tif", ".tiff", ".bmp",  ".tga",   ".gif",
    ".pfm", ".ppm", ".webp", ".pdf", ".svg",  ".gltf", ".glb", ".bin",  ".html", ".blend", ".csv"};

void check_ending(const Output& output) {
    const std::string ending = ending_of(*output.file);
    if (ending == output.ending || std::ranges::find(known_endings, ending) == known_endings.end()) return;
    const std::string written = *output.ending ? fmt::format("a file of {}", output.ending) : "a format of its own";
    throw Error(ExitCode::usage, fmt::format("{}: {} ends in {}, but {} is written", output.option,
                                             output.file->string(), ending, written));
}

/// One name for a file whatever it is called: absolute, without links. Of a file that is not there yet the folder alone
/// has links to follow, which weakly_canonical() does only where it is told of one.
fs::path name_of(const fs::path& file) {
    if (file.empty()) return file;  // no name, which whoever opens it refuses
    if (is_standard_output(file)) return "/dev/stdout";
    // A pipe of the shell's has none, and no file in a folder that is gone: whoever opens it says so.
    std::error_code error;
    const fs::path absolute = fs::absolute(file, error);
    const fs::path name = error ? absolute : fs::weakly_canonical(absolute, error);
    return error ? file : name;
}

}  // namespace

bool is_same_file(const fs::path& a, const fs::path& b) { return name_of(a) == name_of(b); }

void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (!error) return;
    throw Error(ExitCode::cannot_write, fmt::format("cannot make the folder {}: {}", folder.string(), error.message()));
}

void check_outputs(const std::vector<std::optional<fs::path>>& inputs, const std::vector<Output>& outputs,
                   bool prints) {
    std::vector<fs::path> taken;
    for (const auto& input : inputs) {
        if (input) taken.push_back(name_of(*input));
    }
    for (const Output& output : outputs) {
        if (!output.file) continue;
        const fs::path name = name_of(*output.file);
        if (std::ranges::find(taken, name) != taken.end()) {
            throw Error(ExitCode::usage,
                        fmt::format("{}: {} is an input or another output", output.option, output.file->string()));
        }
        if (is_standard_output(*output.file) && (prints || !*output.ending)) {
            throw Error(ExitCode::usage, fmt::format("{}: {} is standard output, which this is not written to",
                                                     output.option, output.file->string()));
        }
        taken.push_back(name);
        check_ending(output);
        check_writable(*output.file);
    }
}

}  // namespace vkcppm
