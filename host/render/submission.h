#pragma once
// How much work goes to the device at once.

#include <cstdint>
#include <functional>

#include "render/settings.h"

namespace vkcppm {

/// Iterations of the next submission after `done` of them in `seconds`: one at first, then as many as take about a
/// tenth of a second, so that progress stays lively and a watchdog quiet. Within the bounds of the settings, and not
/// past the next number of iterations after which `is_measured`.
std::uint32_t submission_size(std::uint32_t done, double seconds, const Settings& settings,
                              const std::function<bool(std::uint32_t)>& is_measured);

}  // namespace vkcppm
