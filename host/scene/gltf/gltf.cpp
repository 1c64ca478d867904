#include "scene/gltf/gltf.h"

#include <algorithm>
#include <iterator>
#include <new>

#include <tiny_gltf.h>

#include "core/fnv1a.h"
#include "scene/bad_scene.h"
#include "scene/gltf/accessors.h"
#include "scene/gltf/animation.h"
#include "scene/gltf/cameras.h"
#include "scene/gltf/draco.h"
#include "scene/gltf/file.h"
#include "scene/gltf/images.h"
#include "scene/gltf/lights.h"
#include "scene/gltf/materials.h"
#include "scene/gltf/meshes.h"
#include "scene/gltf/nodes.h"
#include "scene/gltf/schema.h"
#include "scene/gltf/skins.h"
#include "scene/gltf/specular_glossiness.h"
#include "scene/gltf/variants.h"
#include "scene/gltf/views.h"
#include "scene/warnings.h"

namespace vkcppm {

namespace {

using nlohmann::json;

/// The document as tinygltf's structures. Only what the loader reads is handed over: the buffers are read already,
/// materials are read from the JSON, and images, animations and the like can't trip the parser.
tinygltf::Model parse_model(const GltfFile& file) {
    json document;
    for (const char* member :
         {"asset", "scene", "scenes", "nodes", "meshes", "accessors", "bufferViews", "cameras", "extensions"}) {
        if (const auto found = file.document.find(member); found != file.document.end()) document[member] = *found;
    }
    // tinygltf 2.7 refuses indices without a bufferView, which glTF allows: they get one past the last of the file.
    const std::size_t no_view = document["bufferViews"].size();
    document["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 1}});
    for (json& accessor : document["accessors"]) accessor.emplace("bufferView", no_view);
    // It also refuses spot lights without the object "spot", all of whose members have defaults.
    if (const json::json_pointer lights("/extensions/KHR_lights_punctual/lights"); document.contains(lights)) {
        for (json& light : document[lights]) {
            if (light["type"] == "spot") light.emplace("spot", json::object());
        }
    }
    const std::string text = document.dump();
    if (text.size() > INT32_MAX) {
        bad_scene(file.name, "the size of the JSON", fmt::to_string(text.size()),
                  fmt::format("the limit is {} bytes", INT32_MAX));
    }
    tinygltf::Model model;
    std::string error, warning;
    if (!tinygltf::TinyGLTF().LoadASCIIFromString(&model, &error, &warning, text.data(), unsigned(text.size()), "",
                                                  tinygltf::NO_REQUIRE)) {
        std::ranges::replace(error, '\n', ' ');
        bad_scene(file.name, "the document", "refused by tinygltf", error);
    }
    return model;
}

void warn_of_ignored_parts(const GltfFile& file, const GltfOptions& options, Warnings& warnings) {
    const auto unsupported = unsupported_extensions(file.document, "extensionsUsed", file.name);
    if (!unsupported.empty()) {
        warnings.add("ignored, this program lacks them", fmt::format("extensions {}", fmt::join(unsupported, ", ")));
    }
    if (options.animation.empty() && !file.document.value("animations", json::array()).empty()) {
        warnings.add("at rest, --animation NAME moves them", "animations");
    }
}

/// The hash of what the file is read as: another pose, variant or material is another scene.
std::uint64_t hash_of(const GltfOptions& options, std::uint64_t hash) {
    if (!options.animation.empty()) {
        hash = fnv1a_of(fmt::format("--animation {} --at {}", options.animation, options.at), hash);
    }
    if (!options.variant.empty()) hash = fnv1a_of("--variant " + options.variant, hash);
    for (const MaterialChange& change : options.set) hash = fnv1a_of("--set " + change.text(), hash);
    if (options.punctual_units != PunctualUnits::by_generator) {
        hash = fnv1a_of(fmt::format("--punctual-units {}", name_of(options.punctual_units)), hash);
    }
    return hash;
}

Scene read_scene(GltfFile& file, tinygltf::Model& model, const GltfOptions& options, Warnings& warnings) {
    Scene scene;
    warn_of_ignored_parts(file, options, warnings);
    GltfViews views(file);
    GltfAccessors accessors(file, model, views);
    GltfImages images(file, views, warnings);
    if (!options.variant.empty()) use_variant(file, model, options.variant);
    if (!options.animation.empty()) pose_nodes(file, model, accessors, options.animation, options.at, warnings);
    const std::vector<PlacedNode> nodes = place_nodes(file, model, warnings);
    std::vector<PlacedNode> visible;
    std::ranges::copy_if(nodes, std::back_inserter(visible), &PlacedNode::is_visible);
    GltfSkins skins(file, accessors, nodes, warnings);
    scene.materials = read_materials(file, used_materials(file, model, visible), images, warnings);
    GltfImages::Taken taken = images.take_images();
    place_images(scene.materials, taken.at);
    scene.images = std::move(taken.images);
    scene.hash = hash_of(options, images.hash());
    scene.inputs = file.files;
    add_meshes(file, model, accessors, skins, visible, options.sharing, scene, warnings);
    for (const PlacedNode& node : nodes) {
        if (auto camera = read_camera(file, model, node, warnings)) scene.cameras.push_back(std::move(*camera));
    }
    const bool has_lights = std::ranges::any_of(visible, [&](const PlacedNode& node) {
        return model.nodes[node.index].extensions.contains("KHR_lights_punctual");
    });
    const double per_watt = has_lights ? lumens_per_watt(file, options.punctual_units, warnings) : 1.0;
    for (const PlacedNode& node : visible) {
        if (auto light = read_light(file, model, node, per_watt, warnings)) scene.lights.push_back(std::move(*light));
    }
    if (scene.cameras.empty()) {
        warnings.add("there is no camera, one that frames it is used", "the scene");
        scene.cameras.push_back(framing_camera(scene));
    }
    if (scene.triangles.empty()) warnings.add("there is no triangle", "the scene");
    scene.warnings = warnings.lines(file.name);
    return scene;
}

}  // namespace

Scene load_gltf(const std::filesystem::path& path, const GltfOptions& options) {
    try {
        GltfFile file = read_gltf_file(path, options.root);
        Warnings warnings;
        decode_draco(file, warnings);
        convert_specular_glossiness(file);
        change_materials(file, options.set);
        tinygltf::Model model = parse_model(file);
        Scene scene = read_scene(file, model, options, warnings);
        scene.file = path;
        return scene;
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        bad_scene(path.string(), "its size", "too large", "the memory is exhausted");
    } catch (const std::exception& error) {  // what a library throws on input it does not expect
        bad_scene(path.string(), "the file", "refused", error.what());
    }
}

}  // namespace vkcppm
