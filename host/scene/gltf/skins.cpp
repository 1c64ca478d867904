#include "scene/gltf/skins.h"

#include <glm/gtc/type_ptr.hpp>

#include "scene/bad_scene.h"

namespace vkcppm {

using nlohmann::json;

GltfSkins::GltfSkins(const GltfFile& file, GltfAccessors& accessors, const std::vector<PlacedNode>& nodes,
                     Warnings& warnings)
    : file_(file), accessors_(accessors), warnings_(warnings) {
    if (!file.document.contains("skins")) return;
    for (const PlacedNode& node : nodes) to_world_[node.index] = node.to_world;
}

const JointMatrices* GltfSkins::joints(int node) {
    const json& source = file_.document["nodes"][node];
    if (!source.contains("skin") || !source.contains("mesh")) return nullptr;
    const auto skin = source["skin"].get<std::size_t>();
    const auto [found, is_new] = skins_.try_emplace(skin);
    if (is_new) found->second = read(skin);
    return found->second ? &*found->second : nullptr;
}

std::optional<JointMatrices> GltfSkins::read(std::size_t skin) {
    const json& source = file_.document["skins"][skin];
    const std::string object = fmt::format("skins[{}]", skin);
    JointMatrices matrices;
    for (const json& joint : source["joints"]) {
        const auto placed = to_world_.find(joint.get<int>());
        if (placed == to_world_.end()) {
            warnings_.add("it is ignored, a joint of it is not in the scene",
                          fmt::format("{} (nodes[{}])", object, joint.get<int>()));
            return std::nullopt;
        }
        matrices.push_back(placed->second);
    }
    if (!source.contains("inverseBindMatrices")) return matrices;
    const int accessor = source["inverseBindMatrices"].get<int>();
    if (accessors_.count(accessor) < matrices.size()) {
        bad_scene(file_.name, fmt::format("accessors[{}].count (inverseBindMatrices of {})", accessor, object),
                  fmt::to_string(accessors_.count(accessor)), fmt::format("the skin has {} joints", matrices.size()));
    }
    const std::vector<double> inverse_binds = accessors_.numbers(accessor, 16, "inverseBindMatrices");
    for (std::size_t i = 0; i < matrices.size(); ++i) matrices[i] *= glm::make_mat4(&inverse_binds[16 * i]);
    return matrices;
}

}  // namespace vkcppm
