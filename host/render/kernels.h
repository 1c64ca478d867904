#pragma once
// The SPIR-V of every kernel, embedded. One row a kernel of shaders/kernels.

#include <cstdint>
#include <span>
#include <string_view>

namespace vkcppm {

struct KernelModule {
    std::string_view name;
    std::span<const std::uint32_t> spirv;
};

std::span<const KernelModule> kernel_modules();

/// The module of that name; asserts that there is one.
const KernelModule& kernel_module(std::string_view name);

}  // namespace vkcppm
