#include "app/outputs.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "io/atomic_file.h"

namespace vkcppm {
namespace fs = std::filesystem;

void check_outputs(const std::vector<std::optional<fs::path>>& inputs, const std::vector<Output>& outputs) {
    std::vector<fs::path> taken;
    for (const auto& input : inputs) {
        if (input) taken.push_back(fs::weakly_canonical(*input));
    }
    for (const auto& [option, file] : outputs) {
        if (!file) continue;
        const fs::path canonical = fs::weakly_canonical(*file);
        if (std::ranges::find(taken, canonical) != taken.end()) {
            throw Error(ExitCode::usage, fmt::format("{}: {} is an input or another output", option, file->string()));
        }
        taken.push_back(canonical);
        check_writable(*file);
    }
}

}  // namespace vkcppm
