#pragma once
// The settings of a render as values: a member a row of render/settings_table.h. Defaults are the paper's (Lin et al.
// 2020, supplementary section 1).

#include <cstdint>
#include <optional>
#include <string>

#include "core/image.h"

namespace vkcppm {

/// Beyond, the counter of random numbers starts again and iterations repeat.
inline constexpr std::uint32_t max_iterations = (1u << 30) - 1;

/// Light paths an iteration where Settings::photons is absent and nothing counts them for the scene.
inline constexpr std::uint32_t usual_light_paths = 65536;

/// Values of Settings::direct.
inline constexpr const char* direct_sampled = "sampled";
inline constexpr const char* direct_gathered = "gathered";

/// Values of Settings::disc_area.
inline constexpr const char* area_measured = "measured";
inline constexpr const char* area_whole = "whole";

struct Settings {
#define SETTING(member, type, standard, name, kind, values, unit, help) type member = standard;
#include "render/settings_table.h"
#undef SETTING
    bool operator==(const Settings&) const = default;
};

/// Light paths an iteration: those that are set, or the usual number.
inline std::uint32_t photons_of(const Settings& settings) { return settings.photons.value_or(usual_light_paths); }

}  // namespace vkcppm
