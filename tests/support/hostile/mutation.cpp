#include "support/hostile/mutation.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include <nlohmann/json.hpp>

namespace vkcppm::test {
namespace {

using nlohmann::json;

/// Whole numbers below n. std::uniform_int_distribution differs between libraries.
class Dice {
public:
    explicit Dice(std::uint32_t seed) : engine_(seed) {}
    std::size_t below(std::size_t n) { return n == 0 ? 0 : engine_() % n; }
    bool one_in(std::size_t n) { return below(n) == 0; }
    template <typename T> const T& of(const std::vector<T>& all) { return all[below(all.size())]; }

private:
    std::mt19937 engine_;
};

const std::vector<json>& odd_values() {
    static const std::vector<json> values = {-1,
                                             0,
                                             1,
                                             2,
                                             3,
                                             4,
                                             7,
                                             255,
                                             256,
                                             65535,
                                             65536,
                                             1 << 24,
                                             2147483647,
                                             2147483648u,
                                             4294967295u,
                                             4294967296,
                                             9007199254740992,
                                             std::numeric_limits<std::int64_t>::min(),
                                             std::numeric_limits<std::uint64_t>::max(),
                                             0.5,
                                             -0.5,
                                             1e-300,
                                             1e-30,
                                             1e18,
                                             1e38,
                                             1e39,
                                             1e300,
                                             -1e300,
                                             3.14159,
                                             nullptr,
                                             true,
                                             false,
                                             "",
                                             "x",
                                             "../secret.bin",
                                             "%2e%2e/x",
                                             "/etc/passwd",
                                             "data:;base64,AAAA",
                                             "http://x",
                                             std::string(2000, 'a'),
                                             std::string(1, '\0'),
                                             json::array(),
                                             json::object(),
                                             json::array({json::array()}),
                                             json::array({0, 0, 0}),
                                             json::array({1e300}),
                                             "VEC3",
                                             "MAT4",
                                             "SCALAR",
                                             "MASK",
                                             "BLEND",
                                             "spot",
                                             "perspective",
                                             "orthographic",
                                             "CUBICSPLINE",
                                             5120,
                                             5121,
                                             5123,
                                             5125,
                                             5126,
                                             34963};
    return values;
}

/// Members that files seldom have, each with a value for which it is read.
const std::vector<std::pair<const char*, json>>& rare_members() {
    static const std::vector<std::pair<const char*, json>> members = {
        {"sparse",
         {{"count", 1}, {"indices", {{"bufferView", 0}, {"componentType", 5121}}}, {"values", {{"bufferView", 0}}}}},
        {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", 0}, {"SCALE", 0}}}}}}},
        {"extensions",
         {{"EXT_meshopt_compression",
           {{"buffer", 0},
            {"byteLength", 40},
            {"byteStride", 4},
            {"count", 8},
            {"mode", "ATTRIBUTES"},
            {"filter", "OCTAHEDRAL"}}}}},
        {"extensions",
         {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
          {"KHR_materials_volume", {{"thicknessFactor", 1}, {"attenuationDistance", 1e-3}}},
          {"KHR_materials_dispersion", {{"dispersion", 5}}},
          {"KHR_materials_ior", {{"ior", 0}}}}},
        {"extensions",
         {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}, {"clearcoatTexture", {{"index", 0}}}}},
          {"KHR_materials_specular", {{"specularFactor", 0}}},
          {"KHR_materials_anisotropy", {{"anisotropyStrength", 1}, {"anisotropyRotation", 1e300}}},
          {"KHR_materials_iridescence", {{"iridescenceFactor", 1}, {"iridescenceIor", 1e38}}},
          {"KHR_materials_iridescence", {{"iridescenceFactor", 1}, {"iridescenceThicknessMaximum", 1e300}}},
          {"KHR_materials_sheen",
           {{"sheenColorFactor", {1e300, -1, 1}}, {"sheenRoughnessFactor", 9}, {"sheenColorTexture", {{"index", 0}}}}},
          {"KHR_materials_unlit", json::object()}}},
        {"extensions", {{"KHR_texture_transform", {{"offset", {1e9, -1e9}}, {"rotation", 1e9}, {"scale", {0, 1e30}}}}}},
        {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}},
        {"targets", json::array({{{"POSITION", 0}}, {{"NORMAL", 0}}})},
        {"weights", {1e300, -1}},
        {"matrix", {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}},
        {"scale", {0, 1, -1}},
        {"scale", {1e-200, 1e-200, 1e-200}},
        {"children", {0}},
        {"byteStride", 4},
        {"byteOffset", 1},
        {"mode", 5},
        {"indices", 0},
        {"normalized", true},
        {"alphaMode", "MASK"},
        {"emissiveFactor", {1, 1, 1}},
        {"normalTexture", {{"index", 0}, {"scale", 1e30}}},
        {"baseColorTexture", {{"index", 0}, {"texCoord", 1}}},
        {"camera", 0},
        {"skin", 0},
        {"skins", json::array({{{"joints", {0, 0}}, {"inverseBindMatrices", 0}}})},
        {"joints", {0, 1, 0}},
        {"inverseBindMatrices", 0},
        {"JOINTS_0", 0},
        {"WEIGHTS_0", 0},
        {"animations",
         json::array({{{"samplers", json::array({{{"input", 0}, {"output", 0}}})},
                       {"channels", json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}})}}})},
        {"interpolation", "CUBICSPLINE"},
        {"path", "weights"},
        {"range", 1e-30},
        {"orthographic", {{"xmag", 1e-30}, {"ymag", 1e30}, {"znear", 0}, {"zfar", 1}}},
        {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}},
        {"extensions",
         {{"KHR_materials_variants", {{"mappings", json::array({{{"variants", {0}}, {"material", 0}}})}}}}},
        {"extensions",
         {{"KHR_meshopt_compression",
           {{"buffer", 0},
            {"byteLength", 48},
            {"byteStride", 4},
            {"count", 9},
            {"mode", "ATTRIBUTES"},
            {"filter", "COLOR"}}}}},
        {"extensions", {{"KHR_draco_mesh_compression", {{"bufferView", 0}, {"attributes", {{"POSITION", 0}}}}}}},
        {"attributes", {{"POSITION", 1}, {"NORMAL", 0}}},
        {"extensions", {{"EXT_texture_webp", {{"source", 0}}}}},
        {"uri", "data:;base64,AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA=="},
    };
    return members;
}

/// Every value below `value`, itself included; a long array of numbers stands for itself.
void collect(json& value, std::vector<json*>& all) {
    all.push_back(&value);
    if (value.is_structured() && all.size() < 20000) {
        for (json& element : value) collect(element, all);
    }
}

void change_value(json& document, Dice& dice) {
    std::vector<json*> all;
    collect(document, all);
    json& chosen = *all[dice.below(all.size())];
    switch (dice.below(8)) {
        case 0:
        case 1: chosen = dice.of(odd_values()); break;
        case 2: {
            const json other = *all[dice.below(all.size())];
            chosen = other;
            break;
        }
        case 3:
            if (chosen.is_number_integer()) {
                chosen = std::int64_t(chosen.get<std::uint64_t>() + (dice.one_in(2) ? 1u : ~std::uint64_t(0)));
            } else if (chosen.is_number()) {
                chosen = chosen.get<double>() * (dice.one_in(2) ? 1e10 : -1e-10);
            } else if (chosen.is_string()) {
                const std::string text = chosen;
                chosen = text.substr(std::min(text.size(), dice.below(4)));
            }
            break;
        case 4:
            if (chosen.is_object() && !chosen.empty()) {
                auto member = chosen.begin();
                std::advance(member, dice.below(chosen.size()));
                chosen.erase(member);
            } else if (chosen.is_array() && !chosen.empty()) {
                chosen.erase(dice.below(chosen.size()));
            }
            break;
        case 5:
            if (chosen.is_array() && !chosen.empty()) {
                const json repeated = chosen[dice.below(chosen.size())];
                const std::size_t times = dice.one_in(20) ? 500 : 1 + dice.below(3);
                for (std::size_t i = 0; i < times; ++i) chosen.push_back(repeated);
            }
            break;
        default:
            if (chosen.is_object()) {
                const auto& [name, value] = dice.of(rare_members());
                json& member = chosen[name];
                if (member.is_object() && value.is_object()) {
                    member.update(value);
                } else {
                    member = value;
                }
            } else if (chosen.is_number()) {
                chosen = dice.of(odd_values());
            }
            break;
    }
}

/// A .glb, or the text of a .gltf, in its parts.
struct Parts {
    json document;
    std::string rest;  // the chunks behind the JSON of a .glb
    bool is_glb = false;
};

bool split(const std::string& bytes, Parts& parts) {
    std::string text = bytes;
    if (bytes.starts_with("glTF") && bytes.size() >= 20) {
        std::uint32_t length = 0;
        std::memcpy(&length, bytes.data() + 12, sizeof length);
        if (length > bytes.size() - 20) return false;
        parts.is_glb = true;
        parts.rest = bytes.substr(20 + length);
        text = bytes.substr(20, length);
    }
    int depth = 0;  // of all brackets, in strings as well: the functions above recurse
    for (const char c : text) {
        depth += c == '[' || c == '{' ? 1 : c == ']' || c == '}' ? -1 : 0;
        if (depth > 200) return false;
    }
    parts.document = json::parse(text, nullptr, false);
    return parts.document.is_object();
}

std::string join(const Parts& parts) {
    std::string text = parts.document.dump(-1, ' ', false, json::error_handler_t::replace);
    if (!parts.is_glb) return text;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::array<std::uint32_t, 5> header = {0x46546c67, 2, std::uint32_t(20 + text.size() + parts.rest.size()),
                                                 std::uint32_t(text.size()), 0x4e4f534a};
    return std::string(reinterpret_cast<const char*>(header.data()), sizeof header) + text + parts.rest;
}

void change_bytes(std::string& bytes, Dice& dice) {
    if (bytes.empty()) return;
    const std::size_t at = dice.below(bytes.size());
    const std::size_t count = 1 + dice.below(std::min<std::size_t>(bytes.size() - at, 16));
    static const std::vector<std::uint32_t> words = {
        0, 1, 0x7fffffff, 0x80000000, 0xffffffff, 0x7fc00000, 0x7f800000, 0x7f7fffff, 1, 0x00010000, 0xff000000};
    switch (dice.below(6)) {
        case 0: bytes[at] = char(bytes[at] ^ (1 << dice.below(8))); break;
        case 1: bytes[at] = char(dice.below(256)); break;
        case 2: bytes.erase(at, count); break;
        case 3: bytes.insert(at, bytes.substr(at, count)); break;
        case 4: {
            const std::uint32_t word = dice.of(words);
            std::memcpy(bytes.data() + at, &word, std::min(sizeof word, bytes.size() - at));
            break;
        }
        default:
            if (dice.one_in(4)) bytes.resize(at);
            break;
    }
}

}  // namespace

std::string mutation(const std::string& bytes, std::uint32_t seed) {
    Dice dice(seed);
    const std::size_t changes = 1 + dice.below(4);
    Parts parts;
    if (!dice.one_in(5) && split(bytes, parts)) {
        for (std::size_t i = 0; i < changes; ++i) change_value(parts.document, dice);
        return join(parts);
    }
    std::string changed = bytes;
    for (std::size_t i = 0; i < changes; ++i) change_bytes(changed, dice);
    return changed;
}

}  // namespace vkcppm::test
