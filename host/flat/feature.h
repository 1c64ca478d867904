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

}  // namespace vkcppm
