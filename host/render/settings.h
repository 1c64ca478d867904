#pragma once
// What a render is asked to do. Defaults are the paper's (Lin et al. 2020, supplementary section 1).

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "flat/feature.h"
#include "scene/scene.h"

namespace vkcppm {

/// Beyond, the counter of random numbers starts again and iterations repeat.
inline constexpr std::uint32_t max_iterations = (1u << 30) - 1;

/// A member a row of render/settings_table.h.
struct Settings {
#define SETTING(member, type, standard, name, kind, values, unit, help) type member = standard;
#include "render/settings_table.h"
#undef SETTING
    bool operator==(const Settings&) const = default;
};

/// Throws Error(usage) where a setting is out of range, with its name, value and limit.
/// `scene` resolves what depends on it: the size of the picture and the camera.
Settings resolve_settings(const Settings& settings, const Scene& scene);

/// The camera of resolved settings, which hold its index.
const Camera& camera_of(const Settings& settings, const Scene& scene);

/// What the settings ask of the kernels.
std::vector<Feature> features_of(const Settings& settings);

}  // namespace vkcppm
