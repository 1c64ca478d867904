#pragma once
// Where surfaces are partly not there.

#include <vector>

#include "scene/scene.h"

namespace vkcppm {

/// [materials] The least alpha on the triangles of each: factor, base colour texture and vertex colours together. 1
/// where the alpha mode is opaque.
std::vector<float> least_alphas(const Scene& scene);

/// True where a material whose alpha goes down to `least_alpha` lets light pass: below 1 by BLEND, below the cutoff by
/// MASK.
bool is_partly_there(const Material& material, float least_alpha);

}  // namespace vkcppm
