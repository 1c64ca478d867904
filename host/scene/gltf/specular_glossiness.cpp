#include "scene/gltf/specular_glossiness.h"

#include <array>

namespace vkcppm {

namespace {

using nlohmann::json;

/// The extension of a material; null where it has none, or is unlit.
const json* extension_of(const json& material) {
    const auto extensions = material.find("extensions");
    if (extensions == material.end() || extensions->contains("KHR_materials_unlit")) return nullptr;
    const auto found = extensions->find(specular_glossiness_extension);
    return found == extensions->end() ? nullptr : &*found;
}

}  // namespace

void convert_specular_glossiness(GltfFile& file) {
    if (!file.document.contains("materials")) return;
    for (json& material : file.document["materials"]) {
        if (!extension_of(material)) continue;
        const json source = *extension_of(material);
        json base = {{"baseColorFactor", source.value("diffuseFactor", std::array{1.0, 1.0, 1.0, 1.0})},
                     {"metallicFactor", 0.0},
                     {"roughnessFactor", 1.0 - source.value("glossinessFactor", 1.0)}};
        json specular = {{"specularColorFactor", source.value("specularFactor", std::array{1.0, 1.0, 1.0})}};
        if (source.contains("diffuseTexture")) base["baseColorTexture"] = source["diffuseTexture"];
        if (const auto texture = source.find("specularGlossinessTexture"); texture != source.end()) {
            base["metallicRoughnessTexture"] = specular["specularColorTexture"] = *texture;
            base["roughnessFactor"] = 1.0;
        }
        material["pbrMetallicRoughness"] = std::move(base);
        material["extensions"]["KHR_materials_ior"] = {{"ior", 0.0}};
        material["extensions"]["KHR_materials_specular"] = std::move(specular);
    }
}

std::optional<double> glossiness_factor(const json& material) {
    const json* source = extension_of(material);
    if (!source || !source->contains("specularGlossinessTexture")) return std::nullopt;
    return source->value("glossinessFactor", 1.0);
}

}  // namespace vkcppm
