#pragma once
// SwiftShader runs a loop for all lanes of a SIMD group until the last leaves it. Those that have left compute along,
// and what they load is 0 then; yet a value that is used behind the loop is what the last trip computed, for all of
// them. A phi of the loop's merge block keeps the value with which a lane left. So modules get such phis for drivers
// like it, and a way out of the loop that is never taken, for a phi of one way alone is no phi to an optimizer.

#include <cstdint>
#include <span>
#include <vector>

namespace vkcppm {

/// The module with what is computed in a loop used outside by way of a phi in the loop's merge block alone, whatever
/// an optimizer makes of it. A phi cannot choose pointers and images, none of which may be used outside of the loop
/// that computes or loads it: of kernels that is so once their texels are storage (vk/texels.h). A module that holds an
/// instruction whose operands are not known (vk/spirv.h) is returned as it is.
std::vector<std::uint32_t> with_loops_closed(std::span<const std::uint32_t> spirv);

}  // namespace vkcppm
