#pragma once
// One thing that a scene or the settings ask of the kernels.

#include <cstdint>
#include <string>

namespace vkcppm {

struct Feature {
    std::uint32_t bit = 0;  // FEATURE_*
    std::string name;
    std::string reason;  // what in the scene or the settings asks for it
};

/// One by its bit, with the name of its row of FEATURE_TABLE.
Feature make_feature(std::uint32_t bit, std::string reason);

}  // namespace vkcppm
