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

/// FNV-1a of the words of all of them: another where a kernel is another.
std::uint64_t kernels_hash();

}  // namespace vkcppm
