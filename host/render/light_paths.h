#pragma once
// How many light paths an iteration emits where nobody says.

#include <cstdint>

#include "render/scene_on_device.h"
#include "render/settings.h"

namespace vkcppm {

/// Light paths an iteration for resolved settings: those that they say, else a power of two, few where a path is long
/// or stores many photons, more for large pictures. It is counted on some light paths of a seed of their own, so that
/// it is one for all seeds and a function of scene and settings. Throws what Integrator throws.
///
/// With P pixels, photons of n paths leave a variance ~ 1 / (n s) at s photons a path for a cost n r at r rays a path,
/// and eye paths one that goes with 1 / P of the pixels for a cost ~ P: the error after a time is least at
/// n = A sqrt(P / (r s)), where A holds what scenes do not tell beforehand. It was fitted to eleven scenes
/// (tests/bench/results/transport.md). Photons that hardly ever land matter little: no more than five rays a pixel.
std::uint32_t light_paths(const SceneOnDevice& scene, const Camera& camera, const Settings& settings);

}  // namespace vkcppm
