#include "scene/gltf/variants.h"

#include <algorithm>

#include <tiny_gltf.h>

#include "scene/gltf/choice.h"

namespace vkcppm {

using nlohmann::json;

void use_variant(const GltfFile& file, tinygltf::Model& model, const std::string& variant) {
    static const json::json_pointer variants("/extensions/KHR_materials_variants/variants");
    static const json::json_pointer mappings("/extensions/KHR_materials_variants/mappings");
    const std::size_t chosen =
        choose("--variant", variant, file.document.value(variants, json::array()), "variants", file.name);
    for (std::size_t m = 0; m < model.meshes.size(); ++m) {
        for (std::size_t p = 0; p < model.meshes[m].primitives.size(); ++p) {
            const json& source = file.document["meshes"][m]["primitives"][p];
            for (const json& mapping : source.value(mappings, json::array())) {
                const auto is_chosen = [&](const json& index) { return index == chosen; };
                if (std::ranges::any_of(mapping["variants"], is_chosen)) {
                    model.meshes[m].primitives[p].material = mapping["material"].get<int>();
                }
            }
        }
    }
}

}  // namespace vkcppm
