#pragma once
// One room a feature: small scenes in which paths find all light, as their lamps are large.

#include <functional>
#include <ostream>
#include <vector>

#include "render/settings.h"
#include "scene/scene.h"

namespace vkcppm::test {

/// A closed room [0, 2]^3 of grey walls with a floor, a ball, an upright pane and a large lamp of their own materials.
Scene make_room();

/// A change of that room, or of the settings, that shows one feature.
struct Case {
    const char* name;
    std::function<void(Scene&, Settings&)> change;
};
inline void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

const std::vector<Case>& material_cases();

/// The room with a ball of rough metal, all else of rough plastic, under a light so small that what follows rough lobes
/// hardly ever meets it. The camera does not see it.
const std::vector<Case>& small_light_cases();

}  // namespace vkcppm::test
