#pragma once
// What makes a glTF file malformed, one change each.

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "support/scenes/gltf_builder.h"

namespace vkcppm::test {

/// A change to the file of one triangle that makes it malformed, and what the message must hold.
struct Fault {
    const char* name;
    std::function<void(GltfBuilder&)> make;
    std::vector<std::string> parts;
};

inline void PrintTo(const Fault& fault, std::ostream* stream) { *stream << fault.name; }

const std::vector<Fault>& faults();

}  // namespace vkcppm::test
