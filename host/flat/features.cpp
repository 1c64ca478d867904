#include "flat/features.h"

#include <algorithm>
#include <cassert>
#include <functional>

#include <fmt/format.h>

#include "flat/material.h"

namespace vkcppm {
namespace {

/// What a scene's features are told from.
struct Asked {
    const Scene& scene;
    const std::vector<MaterialTraits>& traits;
    const FlatScene& flat;
    std::vector<bool> used;         // [materials] on a triangle
    std::vector<Feature> features;  // found so far
};

/// Text for the first of several things of a kind, and how many there are; none: empty.
std::string named(const char* kind, const std::string& first, std::size_t count) {
    if (count == 0) return {};
    return fmt::format("{} '{}'{}", kind, first, count > 1 ? fmt::format(" and {} more", count - 1) : "");
}

/// The reason of a feature that materials ask for: those on a triangle that have the trait. Empty: none.
std::string reason_of(const Asked& asked, const std::function<bool(const MaterialTraits&)>& has) {
    std::size_t first = 0, count = 0;
    for (std::size_t i = 0; i < asked.traits.size(); ++i) {
        if (asked.used[i] && has(asked.traits[i]) && count++ == 0) first = i;
    }
    return named("material", count > 0 ? asked.scene.materials[first].name : "", count);
}

std::string reason_of(const Asked& asked, PunctualLight::Kind kind) {
    const auto is = [&](const PunctualLight& light) { return light.kind == kind; };
    const auto first = std::find_if(asked.scene.lights.begin(), asked.scene.lights.end(), is);
    if (first == asked.scene.lights.end()) return {};
    return named("light", first->name, std::size_t(std::count_if(first, asked.scene.lights.end(), is)));
}

/// The reason of a feature that the scene as a whole asks for, one function a row SCENE of FEATURE_TABLE: a row without
/// one does not link. Empty: the scene does not have it.
template <std::uint32_t feature> std::string reason_of(const Asked& asked);

template <> std::string reason_of<FEATURE_SMOOTH>(const Asked& asked) {
    std::size_t smooth = 0;
    for (const gpu::TriangleShading& shading : asked.flat.shading) {
        const MaterialTraits& t = asked.traits[shading.material & ~SHADING_FLAT];
        if (t.gathers() && (t.normal_map || (shading.material & SHADING_FLAT) == 0)) ++smooth;
    }
    return smooth > 0 ? fmt::format("{} triangles that gather photons have some", smooth) : "";
}

template <> std::string reason_of<FEATURE_TANGENTS>(const Asked& asked) {
    if (asked.scene.tangents.empty()) return {};
    const auto turns = [](const MaterialTraits& t) { return t.normal_map || t.anisotropic; };
    return reason_of(asked, turns).empty() ? "" : "normal maps or anisotropy, and vertices that have some";
}

template <> std::string reason_of<FEATURE_VERTEX_COLORS>(const Asked& asked) {
    return asked.scene.colors.empty() ? "" : "vertices that have some";
}

template <> std::string reason_of<FEATURE_INSTANCES>(const Asked& asked) {
    if (asked.flat.instances.empty()) return {};
    return fmt::format("{} of {} meshes", asked.flat.instances.size(), asked.scene.meshes.size());
}

template <> std::string reason_of<FEATURE_TEXTURED_LIGHTS>(const Asked& asked) {
    const auto textured = std::count_if(asked.flat.lights.begin(), asked.flat.lights.end(),
                                        [](const gpu::Light& l) { return l.textured != 0; });
    return textured > 0 ? fmt::format("{} parts of emitters with a texture, alpha or a clearcoat", textured) : "";
}

template <> std::string reason_of<FEATURE_NESTED>(const Asked& asked) { return asked.flat.nested; }

template <> std::string reason_of<FEATURE_POINT_LIGHTS>(const Asked& asked) {
    return reason_of(asked, PunctualLight::Kind::point);
}

template <> std::string reason_of<FEATURE_SPOT_LIGHTS>(const Asked& asked) {
    return reason_of(asked, PunctualLight::Kind::spot);
}

template <> std::string reason_of<FEATURE_DIRECTIONAL_LIGHTS>(const Asked& asked) {
    return reason_of(asked, PunctualLight::Kind::directional);
}

template <> std::string reason_of<FEATURE_ENVIRONMENT>(const Asked& asked) {
    if (asked.flat.environment.empty()) return {};
    return fmt::format("a map of {}x{}", asked.scene.environment->size.width, asked.scene.environment->size.height);
}

}  // namespace

Feature make_feature(std::uint32_t bit, std::string reason) {
    const auto named = [](std::uint32_t of) {
    // clang-format off
#define NAME_FEATURE(row, NAME, words) if (of == FEATURE_##NAME) return #words;
#define NAME_FEATURE_OF_MATERIAL(row, NAME, words, trait) NAME_FEATURE(row, NAME, words)
        FEATURE_TABLE(NAME_FEATURE_OF_MATERIAL, NAME_FEATURE, NAME_FEATURE)
        // clang-format on
        assert(false && "no feature has this bit");
        return "";
    };
    return {bit, named(bit), std::move(reason)};
}

std::vector<Feature> features_of(const Scene& scene, const std::vector<MaterialTraits>& traits, const FlatScene& flat) {
    Asked asked{scene, traits, flat, std::vector<bool>(traits.size(), false), {}};
    for (const Triangle& triangle : scene.triangles) asked.used[triangle.material] = true;
    const auto add = [&](std::uint32_t bit, std::string reason) {
        if (!reason.empty()) asked.features.push_back(make_feature(bit, std::move(reason)));
    };
    // clang-format off
#define MATERIAL(bit, NAME, words, trait) \
    add(FEATURE_##NAME, reason_of(asked, [](const MaterialTraits& t) { return t.asks_for_##NAME(); }));
#define SCENE(bit, NAME, words) add(FEATURE_##NAME, reason_of<FEATURE_##NAME>(asked));
#define SETTING(bit, NAME, words)
    FEATURE_TABLE(MATERIAL, SCENE, SETTING)
#undef MATERIAL
#undef SCENE
#undef SETTING
    // clang-format on
    return std::move(asked.features);
}

std::uint32_t bits_of(const std::vector<Feature>& features) {
    std::uint32_t bits = 0;
    for (const Feature& feature : features) bits |= feature.bit;
    return bits;
}

}  // namespace vkcppm
