#pragma once
// The kernels: the rows of shaders/shared/kernels.h, and their SPIR-V, embedded.

#include <cstdint>
#include <span>
#include <string_view>

#include "shared/kernels.h"

namespace vkcppm {

// clang-format off
#define ENUMERATOR(name, ...) name,
enum class KernelId { KERNELS(ENUMERATOR) };
enum class Pass { PASSES(ENUMERATOR) };
#undef ENUMERATOR
// clang-format on

/// As `--hash` tells of it.
std::string_view name_of(Pass pass);

/// In which forms a kernel is worth compiling: render/kernel_choice.h.
enum class Forms { one, groups, groups_and_waits };

/// How often it is compiled: once, or for each estimator.
enum class Modules { one, each };

struct KernelRow {
    KernelId id;
    std::string_view name;
    Pass pass;
    Forms forms;
    Modules modules;
    std::uint32_t unfinished;  // PASS_* that it sets where it runs out of steps; 0: it does not
};

/// All of them, in the order of KernelId.
std::span<const KernelRow> kernel_rows();

inline const KernelRow& row_of(KernelId kernel) { return kernel_rows()[std::size_t(kernel)]; }

/// SPIR-V of a kernel; of those of Modules::each, with the hooks of the estimator of that name.
std::span<const std::uint32_t> words_of(KernelId kernel, std::string_view estimator);

/// FNV-1a of the words of all modules: another where a kernel is another.
std::uint64_t kernels_hash();

}  // namespace vkcppm
