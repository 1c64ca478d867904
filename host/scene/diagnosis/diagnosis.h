#pragma once
// Why a picture may lack its light or its caustics, told before any time is spent on it.

#include <string>
#include <vector>

#include "scene/scene.h"

namespace vkcppm {

/// Of each of these that the scene has, one line that names the first and counts the others:
/// - glass without a volume on a closed mesh: thin-walled, so it does not refract;
/// - glass with a volume on a mesh that has no inside (open, flat, or of triangles that disagree about the front) or
///   that is inside out. A mesh that is inside out within another is a cavity, and right;
/// - glass that alpha makes vanish somewhere;
/// - a light inside solid glass;
/// - no light at all;
/// - a mesh that is so small beside the scene that the light on it is blurred over all of it;
/// - light of an intensity that no common source has in W/sr, W/m^2 or W m^-2 sr^-1.
/// Takes n log n of the triangles of glass and of emitters among it. Whether a light is inside is asked for as many
/// lights as a fixed number of solid angles allows, in order.
std::vector<std::string> diagnose(const Scene& scene);

}  // namespace vkcppm
