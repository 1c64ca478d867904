#pragma once
// The modules of all kernels, and what is wrong with one.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "render/estimators.h"
#include "render/kernels.h"
#include "support/files/files.h"
#include "support/files/places.h"
#include "support/files/process.h"
#include "support/files/temporary_folder.h"

namespace vkcppm::test {

using Words = std::vector<std::uint32_t>;

/// Calls `take` with every module: its kernel, and its estimator or the first where it is of all.
inline void for_each_module(const std::function<void(const KernelRow&, std::string_view)>& take) {
    for (const KernelRow& row : kernel_rows()) {
        for (const EstimatorRow& estimator : row.modules == Modules::each ? estimators() : estimators().first(1)) {
            take(row, estimator.name);
        }
    }
}

inline Words words_of_kernel(KernelId kernel, std::string_view estimator = "cppm") {
    const auto words = words_of(kernel, estimator);
    return {words.begin(), words.end()};
}

/// What spirv-val says of a module: nothing where it is valid.
inline std::string faults(const Words& words) {
    const TemporaryFolder folder;
    write_bytes(folder / "module.spv", {reinterpret_cast<const char*>(words.data()), words.size() * sizeof(words[0])});
    const ProcessResult result = run_process(
        {spirv_val(), "--target-env", "vulkan1.2", "--scalar-block-layout", (folder / "module.spv").string()},
        folder.path());
    return result.exit_code == 0 ? "" : result.err + result.out + fmt::format(" (exit {})", result.exit_code);
}

}  // namespace vkcppm::test
