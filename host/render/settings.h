#pragma once
// What a render is asked to do.

#include <cstdint>
#include <vector>

#include "flat/feature.h"
#include "render/settings_members.h"
#include "scene/scene.h"

namespace vkcppm {

struct FlatScene;

/// Throws Error(usage) where a setting is out of range, with its name, value and limit, or where one does not go with
/// another.
void check_settings(const Settings& settings);

/// Checks them, and resolves what depends on the scene: the size of the picture and the camera. Once, where a command
/// begins: a camera may have the index of another as its name.
Settings resolve_settings(const Settings& settings, const Scene& scene);

/// The camera of resolved settings, which hold its index.
const Camera& camera_of(const Settings& settings, const Scene& scene);

/// The diameter of the lens, m, of resolved settings: as it was asked for, or the focal length over the f-number, for a
/// film of 36 mm on the picture's longer side.
double lens_diameter(const Settings& settings, const Camera& camera);

/// What the settings ask of the kernels.
std::vector<Feature> features_of(const Settings& settings);

/// FEATURE_* of the scene and of what the settings ask for.
std::uint32_t feature_bits(const FlatScene& scene, const Settings& settings);

}  // namespace vkcppm
