#include "render/kernels.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "core/fnv1a.h"
#include "render/estimators.h"

namespace vkcppm {
namespace {

// clang-format off
#define KERNEL_ROW(name, pass, forms, modules, unfinished) \
    KernelRow{KernelId::name, #name, Pass::pass, Forms::forms, Modules::modules, unfinished},
constexpr std::array rows = {KERNELS(KERNEL_ROW)};
#undef KERNEL_ROW
// clang-format on

/// estimator: "any" for kernels of Modules::one.
struct Module {
    KernelId kernel;
    std::string_view estimator;
    std::span<const std::uint32_t> words;
};

// CMake writes both files by the rows.
#include "kernel_words.inc"
// clang-format off
#define MODULE(kernel, estimator, words) Module{KernelId::kernel, estimator, words},
constexpr std::array modules = {
#include "kernel_modules.inc"
};
#undef MODULE
// clang-format on

constexpr const Module* find(KernelId kernel, std::string_view estimator) {
    const std::string_view wanted = rows[std::size_t(kernel)].modules == Modules::one ? "any" : estimator;
    for (const Module& module : modules) {
        if (module.kernel == kernel && module.estimator == wanted) return &module;
    }
    return nullptr;
}

constexpr bool complete() {
    std::size_t count = 0;
    for (const KernelRow& row : rows) count += row.modules == Modules::one ? 1 : estimator_rows.size();
    for (const KernelRow& row : rows) {
        for (const EstimatorRow& estimator : estimator_rows) {
            if (!find(row.id, estimator.name)) return false;
        }
    }
    return count == modules.size();
}
static_assert(complete(), "CMake's reading of shared/kernels.h and shared/estimators.h is another than the compiler's");

}  // namespace

std::string_view name_of(Pass pass) {
    // clang-format off
#define NAME(name) #name,
    static constexpr std::array names = {PASSES(NAME)};
#undef NAME
    // clang-format on
    return names[std::size_t(pass)];
}

std::span<const KernelRow> kernel_rows() { return rows; }

std::span<const std::uint32_t> words_of(KernelId kernel, std::string_view estimator) {
    const Module* module = find(kernel, estimator);
    assert(module);
    return module->words;
}

std::uint64_t kernels_hash() {
    std::uint64_t hash = fnv1a_start;
    for (const Module& module : modules) hash = fnv1a_of(module.words, hash);
    return hash;
}

}  // namespace vkcppm
