#pragma once
// How solids of glass lie to one another: whether they touch, overlap or hold one another, and which of them then
// counts. Kernels tell them apart by their materials (shaders/include/media.glsl).

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "flat/frame.h"
#include "flat/material.h"
#include "scene/diagnosis/shell.h"
#include "scene/scene.h"

namespace vkcppm {

/// True of the material of a solid of glass: light goes into it and refracts.
inline bool is_solid(const MaterialTraits& traits) { return traits.has(Lobe::transmission) && !traits.thin; }

/// The shells of solid glass, in the order of their first triangles. Those of a material are looked at by themselves
/// where they are whole, for bodies that touch by their edges are not one; the others together, as a body may have
/// several materials.
std::vector<Shell> solid_shells(const Scene& scene, const std::vector<MaterialTraits>& traits);

/// Of those shells, what is inside one another, in words: the names of the materials of two solids that overlap or of
/// which one holds the other. Empty: none does. That solids touch is found where faces are parted (flat/coincidence.h).
/// Of instances the boxes are looked at. O(n log n) where few faces are close to one another; where to know would take
/// very long the answer is yes.
std::string nested_solids(const Scene& scene, std::span<const Shell> shells);

/// [materials] 0: of no solid; else the larger one counts where several solids are: that of smaller bodies, in the
/// mean, so that what lies in another one is there, and a glass keeps its shape in what it is filled with. The same for
/// materials that have a body in common. shells: solid_shells().
std::vector<std::uint32_t> priorities_of(const Scene& scene, const std::vector<MaterialTraits>& traits,
                                         std::span<const Shell> shells);

/// A face of a solid.
struct SolidFace {
    std::array<glm::vec3, 3> corners;
    std::uint32_t material;
    std::uint32_t priority;
};

/// The solids that a point is in, as of a path: the one that counts, then up to four, 16 bits each.
struct Media {
    std::uint32_t first;
    glm::uvec2 others;
};

/// In the space of the faces.
Media media_at(const std::vector<SolidFace>& faces, const glm::vec3& point);

}  // namespace vkcppm
