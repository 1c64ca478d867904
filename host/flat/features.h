#pragma once
// What a scene asks of the kernels: pipelines are specialised to exactly this set.

#include <cstdint>
#include <string>
#include <vector>

#include "flat/feature.h"
#include "flat/flat_scene.h"
#include "flat/material.h"
#include "scene/scene.h"

namespace vkcppm {

/// The features of a scene, in the order of their bits. traits: of its materials. `flat` must be whole but for its
/// features.
std::vector<Feature> features_of(const Scene& scene, const std::vector<MaterialTraits>& traits, const FlatScene& flat);

std::uint32_t bits_of(const std::vector<Feature>& features);

}  // namespace vkcppm
