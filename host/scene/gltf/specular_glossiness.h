#pragma once
// KHR_materials_pbrSpecularGlossiness, archived and yet in many files, in terms of the extensions that took its place.

#include <optional>

#include <nlohmann/json.hpp>

#include "scene/gltf/file.h"

namespace vkcppm {

constexpr const char* specular_glossiness_extension = "KHR_materials_pbrSpecularGlossiness";

/// Rewrites the materials that have the extension as dielectrics that reflect its specular colour at normal incidence
/// and all at grazing: KHR_materials_ior 0 with KHR_materials_specular. Its values replace the metallic-roughness ones
/// beside it. Its texture becomes that of the specular colour and, as it is, the metallic-roughness texture.
void convert_specular_glossiness(GltfFile& file);

/// Of a rewritten material: the factor of the glossiness that alpha of its metallic-roughness texture holds; none where
/// that texture holds roughness.
std::optional<double> glossiness_factor(const nlohmann::json& material);

}  // namespace vkcppm
