#include "scene/gltf/schema.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <span>

#include <nlohmann/json.hpp>

#include "scene/bad_scene.h"

namespace vkcppm {

namespace {

using nlohmann::json;

enum class Kind {
    boolean,
    string,
    number,
    numbers,
    integer,
    integer_map,
    index,
    indices,
    index_map,
    index_maps,
    object,
    objects
};

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double int_limit = std::numeric_limits<std::int32_t>::max();  // tinygltf holds these members as int
constexpr double byte_limit = 9007199254740992.0;                       // 2^53: exact in double and far above any file

/// One member of a JSON object. Which of the later fields matter follows from the kind.
struct Field {
    const char* name;
    Kind kind;
    bool required = false;
    std::span<const Field> fields{};              // object, objects: the members
    const char* collection = "";                  // index, indices, index_map(s): JSON pointer to the array referred to
    std::size_t length = 0;                       // numbers: how many; 0 is any number of them
    double minimum = -infinity;                   // integer, integer_map
    double maximum = infinity;                    // integer, integer_map
    unsigned multiple = 1;                        // integer: a multiple of this
    bool or_zero = false;                         // integer: also 0, which some exporters write for none
    std::span<const std::string_view> choices{};  // string
};

constexpr Field object(const char* name, std::span<const Field> fields, bool required = false) {
    return {.name = name, .kind = Kind::object, .required = required, .fields = fields};
}
constexpr Field objects(const char* name, std::span<const Field> fields, bool required = false) {
    return {.name = name, .kind = Kind::objects, .required = required, .fields = fields};
}
constexpr Field index(const char* name, const char* collection, bool required = false) {
    return {.name = name, .kind = Kind::index, .required = required, .collection = collection};
}
constexpr Field number(const char* name, bool required = false) {
    return {.name = name, .kind = Kind::number, .required = required};
}
constexpr Field numbers(const char* name, std::size_t length) {
    return {.name = name, .kind = Kind::numbers, .length = length};
}
constexpr Field integer(const char* name, double minimum, double maximum, bool required = false) {
    return {.name = name, .kind = Kind::integer, .required = required, .minimum = minimum, .maximum = maximum};
}
constexpr Field choice(const char* name, std::span<const std::string_view> choices, bool required = false) {
    return {.name = name, .kind = Kind::string, .required = required, .choices = choices};
}
constexpr Field index_map(const char* name, bool required = false) {
    return {.name = name, .kind = Kind::index_map, .required = required, .collection = "/accessors"};
}
constexpr Field text(const char* name) { return {.name = name, .kind = Kind::string}; }

constexpr std::string_view accessor_types[] = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
constexpr std::string_view camera_types[] = {"perspective", "orthographic"};
constexpr std::string_view light_types[] = {"directional", "point", "spot"};
constexpr std::string_view alpha_modes[] = {"OPAQUE", "MASK", "BLEND"};
constexpr std::string_view meshopt_modes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
constexpr std::string_view meshopt_filters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
constexpr std::string_view khr_meshopt_filters[] = {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", "COLOR"};

constexpr std::string_view supported_extensions[] = {
    "EXT_mesh_gpu_instancing", "EXT_meshopt_compression", "EXT_texture_webp",      "KHR_draco_mesh_compression",
    "KHR_lights_punctual",     "KHR_materials_variants",  "KHR_mesh_quantization", "KHR_meshopt_compression",
    "KHR_node_visibility",     "KHR_texture_transform",
#define EXTENSION(name, ...) #name,
#include "scene/material_extensions.h"
};

/// Those that change nothing of what is seen at a moment: metadata, sounds, physics, what is done with a file; and
/// KHR_animation_pointer, of which a motion that is asked for says what it leaves at rest.
constexpr std::string_view extensions_without_looks[] = {
    "AGI_articulations",        "EXT_mesh_features", "EXT_mesh_manifold",     "EXT_structural_metadata",
    "FB_geometry_metadata",     "GODOT_single_root", "KHR_animation_pointer", "KHR_audio_emitter",
    "KHR_implicit_shapes",      "KHR_interactivity", "KHR_node_hoverability", "KHR_node_selectability",
    "KHR_physics_rigid_bodies", "KHR_xmp",           "KHR_xmp_json_ld",
};

constexpr const char* lights_pointer = "/extensions/KHR_lights_punctual/lights";

// glTF asks for one byte, one element, one primitive at least in buffers, views, accessors and meshes. Exporters write
// empty ones for geometry that has nothing in it.

constexpr Field fallback_fields[] = {{.name = "fallback", .kind = Kind::boolean}};
constexpr Field buffer_extension_fields[] = {object("EXT_meshopt_compression", fallback_fields),
                                             object("KHR_meshopt_compression", fallback_fields)};
constexpr Field buffer_fields[] = {
    integer("byteLength", 0, byte_limit, true),
    text("uri"),
    object("extensions", buffer_extension_fields),
};

/// Of a compressed bufferView, with the filters that the extension has.
#define MESHOPT_FIELDS(filters)                                                                                    \
    {                                                                                                              \
        index("buffer", "/buffers", true), integer("byteOffset", 0, byte_limit),                                   \
            integer("byteLength", 1, byte_limit, true), integer("byteStride", 2, 256, true),                       \
            integer("count", 1, byte_limit, true), choice("mode", meshopt_modes, true), choice("filter", filters), \
    }
constexpr Field meshopt_fields[] = MESHOPT_FIELDS(meshopt_filters);
constexpr Field khr_meshopt_fields[] = MESHOPT_FIELDS(khr_meshopt_filters);
#undef MESHOPT_FIELDS
constexpr Field buffer_view_extension_fields[] = {object("EXT_meshopt_compression", meshopt_fields),
                                                  object("KHR_meshopt_compression", khr_meshopt_fields)};
constexpr Field buffer_view_fields[] = {
    index("buffer", "/buffers", true),
    integer("byteOffset", 0, byte_limit),
    integer("byteLength", 0, byte_limit, true),
    {.name = "byteStride", .kind = Kind::integer, .minimum = 4, .maximum = 252, .multiple = 4, .or_zero = true},
    object("extensions", buffer_view_extension_fields),
};

constexpr Field sparse_indices_fields[] = {
    index("bufferView", "/bufferViews", true),
    integer("byteOffset", 0, int_limit),
    integer("componentType", 5121, 5125, true),
};
constexpr Field sparse_values_fields[] = {
    index("bufferView", "/bufferViews", true),
    integer("byteOffset", 0, int_limit),
};
constexpr Field sparse_fields[] = {
    integer("count", 0, int_limit, true),
    object("indices", sparse_indices_fields, true),
    object("values", sparse_values_fields, true),
};
constexpr Field accessor_fields[] = {
    index("bufferView", "/bufferViews"),
    integer("byteOffset", 0, byte_limit),
    integer("componentType", 5120, 5126, true),
    {.name = "normalized", .kind = Kind::boolean},
    integer("count", 0, byte_limit, true),
    choice("type", accessor_types, true),
    object("sparse", sparse_fields),
};

constexpr const char* variants_pointer = "/extensions/KHR_materials_variants/variants";
constexpr Field variant_mapping_fields[] = {
    {.name = "variants", .kind = Kind::indices, .required = true, .collection = variants_pointer},
    index("material", "/materials", true),
};
constexpr Field variant_mappings_fields[] = {objects("mappings", variant_mapping_fields, true)};
constexpr Field draco_fields[] = {
    index("bufferView", "/bufferViews", true),
    {.name = "attributes", .kind = Kind::integer_map, .required = true, .minimum = 0, .maximum = UINT32_MAX},
};
constexpr Field primitive_extension_fields[] = {object("KHR_materials_variants", variant_mappings_fields),
                                                object("KHR_draco_mesh_compression", draco_fields)};

constexpr Field primitive_fields[] = {
    index_map("attributes", true),
    index("indices", "/accessors"),
    index("material", "/materials"),
    integer("mode", 0, 6),
    {.name = "targets", .kind = Kind::index_maps, .collection = "/accessors"},
    object("extensions", primitive_extension_fields),
};
constexpr Field mesh_fields[] = {objects("primitives", primitive_fields), text("name"), numbers("weights", 0)};

constexpr Field node_light_fields[] = {index("light", lights_pointer, true)};
constexpr Field instancing_fields[] = {index_map("attributes", true)};
constexpr Field visibility_fields[] = {{.name = "visible", .kind = Kind::boolean}};
constexpr Field node_extension_fields[] = {
    object("KHR_lights_punctual", node_light_fields),
    object("EXT_mesh_gpu_instancing", instancing_fields),
    object("KHR_node_visibility", visibility_fields),
};
constexpr Field node_fields[] = {
    text("name"),
    index("camera", "/cameras"),
    index("mesh", "/meshes"),
    index("skin", "/skins"),
    {.name = "children", .kind = Kind::indices, .collection = "/nodes"},
    numbers("matrix", 16),
    numbers("translation", 3),
    numbers("rotation", 4),
    numbers("scale", 3),
    numbers("weights", 0),
    object("extensions", node_extension_fields),
};

constexpr Field skin_fields[] = {
    index("inverseBindMatrices", "/accessors"),
    {.name = "joints", .kind = Kind::indices, .required = true, .collection = "/nodes"},
};

constexpr std::string_view animation_paths[] = {"translation", "rotation", "scale", "weights", "pointer"};
constexpr std::string_view interpolations[] = {"LINEAR", "STEP", "CUBICSPLINE"};
constexpr Field channel_target_fields[] = {index("node", "/nodes"), choice("path", animation_paths, true)};
constexpr Field channel_fields[] = {integer("sampler", 0, int_limit, true),
                                    object("target", channel_target_fields, true)};
constexpr Field animation_sampler_fields[] = {
    index("input", "/accessors", true),
    index("output", "/accessors", true),
    choice("interpolation", interpolations),
};
constexpr Field animation_fields[] = {
    text("name"),
    objects("channels", channel_fields, true),
    objects("samplers", animation_sampler_fields, true),
};

constexpr Field scene_fields[] = {text("name"), {.name = "nodes", .kind = Kind::indices, .collection = "/nodes"}};

constexpr Field perspective_fields[] = {number("yfov", true), number("znear", true), number("zfar"),
                                        number("aspectRatio")};
constexpr Field orthographic_fields[] = {number("xmag", true), number("ymag", true), number("znear", true),
                                         number("zfar", true)};
constexpr Field camera_fields[] = {
    choice("type", camera_types, true),
    text("name"),
    object("perspective", perspective_fields),
    object("orthographic", orthographic_fields),
};

constexpr Field sampler_member(const char* name) { return integer(name, -byte_limit, byte_limit); }
constexpr Field sampler_fields[] = {
    sampler_member("magFilter"),
    sampler_member("minFilter"),
    sampler_member("wrapS"),
    sampler_member("wrapT"),
};
constexpr Field image_fields[] = {text("name"), text("uri"), text("mimeType"), index("bufferView", "/bufferViews")};
constexpr Field webp_fields[] = {index("source", "/images")};
constexpr Field texture_extension_fields[] = {object("EXT_texture_webp", webp_fields)};
constexpr Field texture_fields[] = {index("sampler", "/samplers"), index("source", "/images"),
                                    object("extensions", texture_extension_fields)};

constexpr Field texture_transform_fields[] = {
    numbers("offset", 2),
    number("rotation"),
    numbers("scale", 2),
    integer("texCoord", 0, int_limit),
};
constexpr Field texture_info_extension_fields[] = {object("KHR_texture_transform", texture_transform_fields)};
constexpr Field texture_info_fields[] = {
    index("index", "/textures", true),
    integer("texCoord", 0, int_limit),
    object("extensions", texture_info_extension_fields),
};
constexpr Field normal_texture_fields[] = {
    index("index", "/textures", true),
    integer("texCoord", 0, int_limit),
    number("scale"),
    object("extensions", texture_info_extension_fields),
};
constexpr Field pbr_fields[] = {
    numbers("baseColorFactor", 4),
    number("metallicFactor"),
    number("roughnessFactor"),
    object("baseColorTexture", texture_info_fields),
    object("metallicRoughnessTexture", texture_info_fields),
};
constexpr Field texture(const char* name) { return object(name, texture_info_fields); }
constexpr Field color(const char* name) { return numbers(name, 3); }
constexpr Field color_with_alpha(const char* name) { return numbers(name, 4); }
// clang-format off
#define FACTOR(member, json, standard, low, high) number(json),
#define COLOR(member, json, standard, high) color(json),
#define TEXTURE(NUMBER, member, json, words, encoding, where) texture(json),
#define NORMALS(NUMBER, member, json, words, scale, where) object(json, normal_texture_fields),
#define OTHER(kind, json) kind(json),
// A list, as one may have no members.
#define EXTENSION(name, ...) constexpr std::initializer_list<Field> name##_fields = {__VA_ARGS__};
#include "scene/material_extensions.h"
constexpr Field material_extension_fields[] = {
#define EXTENSION(name, ...) object(#name, {name##_fields.begin(), name##_fields.size()}),
#include "scene/material_extensions.h"
};
// clang-format on
constexpr Field material_fields[] = {
    text("name"),
    object("pbrMetallicRoughness", pbr_fields),
    object("normalTexture", normal_texture_fields),
    object("occlusionTexture", texture_info_fields),
    object("emissiveTexture", texture_info_fields),
    numbers("emissiveFactor", 3),
    choice("alphaMode", alpha_modes),
    number("alphaCutoff"),
    {.name = "doubleSided", .kind = Kind::boolean},
    object("extensions", material_extension_fields),
};

constexpr Field spot_fields[] = {number("innerConeAngle"), number("outerConeAngle")};
constexpr Field light_fields[] = {
    text("name"),    choice("type", light_types, true), numbers("color", 3), number("intensity"),
    number("range"), object("spot", spot_fields),
};
constexpr Field lights_fields[] = {objects("lights", light_fields, true)};
constexpr Field variant_fields[] = {text("name")};
constexpr Field variants_fields[] = {objects("variants", variant_fields, true)};
constexpr Field root_extension_fields[] = {object("KHR_lights_punctual", lights_fields),
                                           object("KHR_materials_variants", variants_fields)};

constexpr Field root_fields[] = {
    index("scene", "/scenes"),
    objects("scenes", scene_fields),
    objects("nodes", node_fields),
    objects("meshes", mesh_fields),
    objects("accessors", accessor_fields),
    objects("bufferViews", buffer_view_fields),
    objects("buffers", buffer_fields),
    objects("materials", material_fields),
    objects("textures", texture_fields),
    objects("images", image_fields),
    objects("samplers", sampler_fields),
    objects("cameras", camera_fields),
    objects("skins", skin_fields),
    objects("animations", animation_fields),
    object("extensions", root_extension_fields),
};

class Checker {
public:
    Checker(const json& document, std::string_view file) : document_(document), file_(file) {}

    void check_object(json& value, const std::string& path, std::span<const Field> fields) const {
        if (!value.is_object()) fail(path, value, "it must be an object");
        for (const Field& field : fields) {
            const std::string member = path.empty() ? field.name : path + "." + field.name;
            const auto found = value.find(field.name);
            if (found != value.end()) {
                check_field(*found, member, field);
            } else if (field.required) {
                bad_scene(file_, member, "missing", "glTF requires it");
            }
        }
    }

private:
    void check_field(json& value, const std::string& path, const Field& field) const {
        switch (field.kind) {
            case Kind::boolean:
                if (!value.is_boolean()) fail(path, value, "it must be true or false");
                break;
            case Kind::string: check_string(value, path, field.choices); break;
            case Kind::number: check_number(value, path); break;
            case Kind::numbers: check_numbers(value, path, field.length); break;
            case Kind::integer: check_integer(value, path, field); break;
            case Kind::integer_map:
                check_map(value, path, [&](json& number, const std::string& p) { check_integer(number, p, field); });
                break;
            case Kind::index: check_index(value, path, field.collection); break;
            case Kind::indices:
                check_array(value, path);
                for (std::size_t i = 0; i < value.size(); ++i) {
                    check_index(value[i], element(path, i), field.collection);
                }
                break;
            case Kind::index_map: check_index_map(value, path, field.collection); break;
            case Kind::index_maps:
                check_array(value, path);
                for (std::size_t i = 0; i < value.size(); ++i) {
                    check_index_map(value[i], element(path, i), field.collection);
                }
                break;
            case Kind::object: check_object(value, path, field.fields); break;
            case Kind::objects:
                check_array(value, path);
                for (std::size_t i = 0; i < value.size(); ++i) check_object(value[i], element(path, i), field.fields);
                break;
        }
    }

    void check_string(const json& value, const std::string& path, std::span<const std::string_view> choices) const {
        if (!value.is_string()) fail(path, value, "it must be a string");
        if (choices.empty()) return;
        for (const std::string_view choice : choices) {
            if (value.get_ref<const std::string&>() == choice) return;
        }
        fail(path, value, fmt::format("it must be one of {}", fmt::join(choices, ", ")));
    }

    /// Rewrites the number as floating point: tinygltf 2.7 truncates the integers of extensions to 32 bits.
    void check_number(json& value, const std::string& path) const {
        if (!value.is_number()) fail(path, value, "it must be a number");
        value = value.get<double>();
    }

    void check_numbers(json& value, const std::string& path, std::size_t length) const {
        check_array(value, path);
        if (length > 0 && value.size() != length) {
            bad_scene(file_, path, fmt::format("an array of {}", value.size()), fmt::format("it must hold {}", length));
        }
        for (std::size_t i = 0; i < value.size(); ++i) check_number(value[i], element(path, i));
    }

    /// Rewrites a number without a fraction as an integer: 100, 100.0 and 1e2 are one value (glTF 2.0, section 2.7).
    static bool is_integer(json& value) {
        if (value.is_number_integer()) return true;
        if (!value.is_number_float()) return false;
        const double number = value.get<double>();
        if (!(std::abs(number) <= byte_limit) || number != std::trunc(number)) return false;
        value = std::int64_t(number);
        return true;
    }

    void check_integer(json& value, const std::string& path, const Field& field) const {
        if (!is_integer(value)) fail(path, value, "it must be an integer");
        const double number = value.get<double>();
        if (number == 0.0 && field.or_zero) return;
        if (number < field.minimum || number > field.maximum) {
            fail(path, value, fmt::format("it must lie in {:.0f} to {:.0f}", field.minimum, field.maximum));
        }
        if (value.get<std::uint64_t>() % field.multiple != 0) {
            fail(path, value, fmt::format("it must be a multiple of {}", field.multiple));
        }
    }

    /// check(member, its path) of every member of an object.
    template <typename Check> void check_map(json& value, const std::string& path, const Check& check) const {
        if (!value.is_object()) fail(path, value, "it must be an object");
        for (auto& [name, member] : value.items()) check(member, path + "[" + json_text(name) + "]");
    }

    void check_index_map(json& value, const std::string& path, const char* collection) const {
        check_map(value, path, [&](json& index, const std::string& p) { check_index(index, p, collection); });
    }

    void check_index(json& value, const std::string& path, const char* collection) const {
        const json::json_pointer pointer(collection);
        const std::size_t size = document_.contains(pointer) ? document_[pointer].size() : 0;
        if (!is_integer(value)) fail(path, value, "it must be an index");
        if (value.get<double>() < 0.0 || value.get<double>() >= double(size)) {
            fail(path, value, fmt::format("{} has {}", pointer.back(), size));
        }
    }

    void check_array(const json& value, const std::string& path) const {
        if (!value.is_array()) fail(path, value, "it must be an array");
    }

    [[noreturn]] void fail(const std::string& path, const json& value, std::string_view limit) const {
        bad_scene(file_, path.empty() ? "the JSON" : path, json_text(value), limit);
    }

    static std::string element(const std::string& path, std::size_t i) { return fmt::format("{}[{}]", path, i); }

    const json& document_;
    std::string_view file_;
};

/// `array`[i] of type `type` must have the member of that name, e.g. a perspective camera the object "perspective".
void require_type_member(const json& array, std::string_view path, std::string_view type, std::string_view file) {
    for (std::size_t i = 0; i < array.size(); ++i) {
        if (array[i]["type"] == type && !array[i].contains(type)) {
            bad_scene(file, fmt::format("{}[{}].{}", path, i, type), "missing", "an object of this type requires it");
        }
    }
}

}  // namespace

std::vector<std::string> unsupported_extensions(const json& document, std::string_view member, std::string_view file) {
    const json names = document.value(member, json::array());
    if (!names.is_array()) bad_scene(file, member, json_text(names), "it must be an array");
    std::vector<std::string> unsupported;
    for (const json& name : names) {
        if (!name.is_string()) bad_scene(file, member, json_text(name), "it must hold strings");
        const auto& text = name.get_ref<const std::string&>();
        const auto is_among = [&](const auto& known) { return std::ranges::find(known, text) != std::end(known); };
        if (!is_among(supported_extensions) && !is_among(extensions_without_looks)) {
            unsupported.push_back(json_text(name));
        }
    }
    return unsupported;
}

std::string json_text(const json& value) {
    constexpr std::size_t limit = 60;
    std::string text = value.dump(-1, ' ', true);
    if (text.size() > limit) text = text.substr(0, limit - 3) + "...";
    return text;
}

void check_gltf_schema(json& document, std::string_view file) {
    Checker(document, file).check_object(document, "", root_fields);
    const json none = json::array();
    const json cameras = document.value("cameras", none);
    for (const std::string_view type : camera_types) require_type_member(cameras, "cameras", type, file);
}

}  // namespace vkcppm
