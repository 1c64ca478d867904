#pragma once
// Kernels that ballot count on the lanes of a SIMD group (subgroup) being together where the source says so. Two
// extensions promise it to modules that ask for it. What asks is a word in the module; the device's own compiler is the
// first that must know it, so it is added when a kernel is made.

#include <cstdint>
#include <span>
#include <vector>

#include "vk/policy.h"

namespace vkcppm {

struct Promise {
    Reconvergence of;
    const char* extension;        // of the device
    std::uint32_t feature_type;   // VkStructureType of its one feature
    const char* spirv_extension;  // of the module
    std::uint32_t mode;           // ExecutionMode of the entry point
};

/// The strongest first.
inline constexpr Promise promises[] = {
    {Reconvergence::maximal, "VK_KHR_shader_maximal_reconvergence", 1000434000, "SPV_KHR_maximal_reconvergence", 6023},
    {Reconvergence::uniform, "VK_KHR_shader_subgroup_uniform_control_flow", 1000323000,
     "SPV_KHR_subgroup_uniform_control_flow", 4421},
};

/// The module as it is, or where it has ballots so that it asks for the promise.
std::vector<std::uint32_t> with_promise(std::span<const std::uint32_t> spirv, Reconvergence promise);

}  // namespace vkcppm
