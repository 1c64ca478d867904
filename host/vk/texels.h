#pragma once
// Texel buffers are read fastest on software Vulkan, and some drivers allow no more than 65,536 texels in one, as few
// as Vulkan permits. There kernels read the same words as storage: the modules are changed before the driver sees them,
// so that kernels are written once.

#include <cstdint>
#include <span>
#include <vector>

namespace vkcppm {

/// Bindings that a module declares, those of texels as TEXELS_BINDING + number; sorted, each once.
std::vector<std::uint32_t> bindings_of(std::span<const std::uint32_t> spirv);

/// The module with every fetch from a texel buffer as a load from the storage buffer of the same row, at its own
/// binding. A load behind the end, unlike a fetch, is defined where the device was made with robustBufferAccess alone.
/// Throws Error(internal) where the module holds an instruction whose operands are not known (vk/spirv.h).
std::vector<std::uint32_t> with_storage_for_texels(std::span<const std::uint32_t> spirv);

}  // namespace vkcppm
