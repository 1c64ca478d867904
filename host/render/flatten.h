#pragma once
// A Scene as the kernels read it: leaf-ordered triangles, BVH, surfaces, an alias table of lights, all in the frame.

#include <cstdint>
#include <string>
#include <vector>

#include "render/bvh.h"
#include "render/frame.h"
#include "scene/scene.h"
#include "shared/types.h"

namespace vkcppm {

struct FlatScene {
    SceneFrame frame;
    Bvh bvh;
    std::vector<gpu::TriangleGeometry> triangles;  // in leaf order
    std::vector<gpu::TriangleShading> shading;     // in leaf order
    std::vector<gpu::SurfaceMaterial> materials;
    std::vector<gpu::Light> lights;                // alias table; empty where nothing emits
    std::uint32_t features = 0;                    // FEATURE_* that any triangle's material has
    double area = 0.0;                             // of all triangles, frame units squared
    double radius = 0.0;                           // of the bounding sphere about the origin, frame units
    glm::vec3 low{0.0f};                           // bounds of the triangles, padded
    glm::vec3 high{0.0f};
    std::vector<std::string> warnings;             // what is left out, one line each
};

FlatScene flatten(const Scene& scene);

}  // namespace vkcppm
