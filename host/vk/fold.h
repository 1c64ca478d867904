#pragma once
// A kernel has the code of all scenes, and constants that say which of it a scene needs. Drivers, and the validation
// layer before them, read all of it for each pipeline before they drop most. Here it is dropped before they see it, in
// a few milliseconds: constants, dead branches and dead code, and nothing else of an optimizer.

#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace vkcppm {

/// Values of specialization constants by id (SPEC_*).
using Specialization = std::map<std::uint32_t, std::uint32_t>;

/// The module with the values of `constants`, and the defaults of those that are not there, in place of specialization
/// constants (SpecId), and without what they make unreachable or useless. What is left computes the same bits:
/// floating-point arithmetic is not touched. A module that holds an instruction whose operands the fold does not know,
/// or a shape of control flow, is returned as it is.
std::vector<std::uint32_t> folded(std::span<const std::uint32_t> spirv, const Specialization& constants);

}  // namespace vkcppm
