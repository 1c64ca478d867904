#pragma once
// Triangles whose emission or presence hangs on a texture, cut into parts that are drawn in proportion to what they
// emit.

#include <optional>
#include <vector>

#include "flat/weighed_light.h"
#include "scene/scene.h"
#include "shared/types.h"

namespace vkcppm {

/// Of the textures of a material, where a part was that covers them whole.
struct MeansOfImages {
    std::optional<double> emissive, alpha;
};

/// Adds the parts of `triangle` to `lights`, none where it is dark. whole: the triangle as a light, with the flux that
/// the emissive factor alone would give. means: of its material, filled in on the way.
void add_textured_emitter(const Scene& scene, const Triangle& triangle, const gpu::Light& whole,
                          std::vector<WeighedLight>& lights, MeansOfImages& means);

}  // namespace vkcppm
