#include "render/kernels.h"

#include <array>
#include <cassert>

#include "core/fnv1a.h"

namespace vkcppm {
namespace {

constexpr std::uint32_t eye_words[] = {
#include "eye.spv.inc"
};
constexpr std::uint32_t photon_words[] = {
#include "photon.spv.inc"
};
constexpr std::uint32_t grid_plan_words[] = {
#include "grid_plan.spv.inc"
};
constexpr std::uint32_t grid_clear_words[] = {
#include "grid_clear.spv.inc"
};
constexpr std::uint32_t grid_key_words[] = {
#include "grid_key.spv.inc"
};
constexpr std::uint32_t grid_order_words[] = {
#include "grid_order.spv.inc"
};
constexpr std::uint32_t scan_sums_words[] = {
#include "scan_sums.spv.inc"
};
constexpr std::uint32_t scan_blocks_words[] = {
#include "scan_blocks.spv.inc"
};
constexpr std::uint32_t scan_apply_words[] = {
#include "scan_apply.spv.inc"
};
constexpr std::uint32_t radix_count_words[] = {
#include "radix_count.spv.inc"
};
constexpr std::uint32_t radix_scatter_words[] = {
#include "radix_scatter.spv.inc"
};
constexpr std::uint32_t knn_words[] = {
#include "knn.spv.inc"
};
constexpr std::uint32_t gather_words[] = {
#include "gather.spv.inc"
};
constexpr std::uint32_t update_words[] = {
#include "update.spv.inc"
};
constexpr std::uint32_t advance_words[] = {
#include "advance.spv.inc"
};
constexpr std::uint32_t resolve_words[] = {
#include "resolve.spv.inc"
};
constexpr std::uint32_t path_words[] = {
#include "path.spv.inc"
};

constexpr std::array modules = {
    KernelModule{"eye", eye_words},
    KernelModule{"photon", photon_words},
    KernelModule{"grid_plan", grid_plan_words},
    KernelModule{"grid_clear", grid_clear_words},
    KernelModule{"grid_key", grid_key_words},
    KernelModule{"grid_order", grid_order_words},
    KernelModule{"scan_sums", scan_sums_words},
    KernelModule{"scan_blocks", scan_blocks_words},
    KernelModule{"scan_apply", scan_apply_words},
    KernelModule{"radix_count", radix_count_words},
    KernelModule{"radix_scatter", radix_scatter_words},
    KernelModule{"knn", knn_words},
    KernelModule{"gather", gather_words},
    KernelModule{"update", update_words},
    KernelModule{"advance", advance_words},
    KernelModule{"resolve", resolve_words},
    KernelModule{"path", path_words},
};

}  // namespace

std::span<const KernelModule> kernel_modules() { return modules; }

const KernelModule& kernel_module(std::string_view name) {
    for (const KernelModule& module : modules) {
        if (module.name == name) return module;
    }
    assert(false);
    return modules.front();
}

std::uint64_t kernels_hash() {
    std::uint64_t hash = fnv1a_start;
    for (const KernelModule& module : modules) hash = fnv1a_of(module.spirv, hash);
    return hash;
}

}  // namespace vkcppm
