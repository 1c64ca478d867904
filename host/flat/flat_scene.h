#pragma once
// A Scene as the kernels read it: leaf-ordered triangles, BVH, materials, an alias table of lights, all in the frame.

#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "core/image.h"
#include "flat/bvh.h"
#include "flat/feature.h"
#include "flat/frame.h"
#include "flat/solids.h"
#include "scene/scene.h"
#include "shared/types.h"

namespace vkcppm {

/// Of all that is listed by triangle and by texel, what is on the device need not be here any more.
struct FlatScene {
    SceneFrame frame;
    Bvh bvh;  // the scene's tree, then those of the shared meshes
    // In leaf order, as all that is listed by triangle: those of the scene's frame, then those of each shared mesh in
    // the mesh's own space.
    std::vector<gpu::TriangleGeometry> triangles;
    std::vector<std::uint8_t> first_corner;  // of the scene's triangle that kernels see first
    std::vector<gpu::Instance> instances;
    std::vector<gpu::TriangleShading> shading;
    std::vector<glm::vec4> texcoords;       // [3 x triangles] both sets of a corner, for textures and tangents
    std::vector<glm::uvec4> vertex_colors;  // [2 x triangles] 4 half floats a corner, then 2 unused words
    std::vector<glm::uvec4> tangents;       // [triangles] an octahedral tangent a corner, then TANGENTS_*
    std::vector<gpu::SurfaceMaterial> materials;
    std::vector<gpu::TextureLookup> textures;
    std::vector<std::uint32_t> images;          // texels of all images, a word each
    std::vector<gpu::Light> lights;             // alias table; empty where nothing emits
    std::vector<gpu::AskedLight> asked_lights;  // an alias table a lamp, or a group without a light tree
    std::vector<gpu::LightBranch> light_tree;   // over local lights, where they are more than one lamp
    std::vector<std::uint32_t> lamps;           // [triangles] there: the place of its lamp in the tree, or NO_LAMP
    std::vector<gpu::AskedGroup> asked;         // the groups of lights that there are
    double local_power = 0.0;                   // of the group of local lights, as light_power of all
    double environment_power = 0.0;
    double light_power = 0.0;            // of all, mean channel, W (frame-scaled): about, where lights have textures
    Extent environment_size;             // of the map, cut where its pixels were coarse
    std::vector<glm::vec4> environment;  // [pixels] radiance, keep of its alias table
    std::vector<glm::uvec2> environment_alias;  // [pixels] its other entry; environment_area, as bits
    std::string nested;                         // solids that touch, overlap or hold one another, in words; or empty
    std::vector<SolidFace> solids;              // where there are such: their faces, those of instances apart
    std::vector<Feature> features;              // what the scene asks of the kernels
    double area = 0.0;                          // of all triangles, in each instance, frame units squared
    double radius = 0.0;                        // of the bounding sphere about the origin, frame units
    glm::vec3 low{0.0f};                        // bounds of the triangles and the instances, padded
    glm::vec3 high{0.0f};
};

/// The triangle of the scene that is the flat scene's `triangle`, its corners in the order in which kernels see them.
Triangle source_of(const Scene& scene, const FlatScene& flat, std::size_t triangle);

}  // namespace vkcppm
