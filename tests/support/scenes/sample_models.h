#pragma once
// Small models, one a feature of glTF that the loader reads or says that it leaves out.

#include <ostream>
#include <string>
#include <vector>

#include "support/scenes/gltf_builder.h"

namespace vkcppm::test {

struct SampleModel {
    std::string name;
    GltfBuilder file;
    std::size_t triangles = 0;               // of the scene
    std::vector<std::string> warnings = {};  // parts of its warnings, one each, but for the one about a missing camera
};

inline void PrintTo(const SampleModel& model, std::ostream* stream) { *stream << model.name; }

std::vector<SampleModel> sample_models();

}  // namespace vkcppm::test
