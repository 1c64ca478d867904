#include "flat/features.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "flat/surface.h"

namespace vkcppm {
namespace {

/// Adds features with their reason, in the order of the calls.
class Collector {
public:
    Collector(const Scene& scene, const std::vector<SurfaceTraits>& traits)
        : scene_(scene), traits_(traits), used_(scene.materials.size(), false) {
        for (const Triangle& triangle : scene.triangles) used_[triangle.material] = true;
    }

    /// Where any material on a triangle has the trait.
    void material(std::uint32_t bit, const char* name, const std::function<bool(const SurfaceTraits&)>& has) {
        std::size_t first = scene_.materials.size(), count = 0;
        for (std::size_t i = 0; i < traits_.size(); ++i) {
            if (!used_[i] || !has(traits_[i])) continue;
            first = std::min(first, i);
            ++count;
        }
        if (count == 0) return;
        const std::string more = count > 1 ? fmt::format(" and {} more", count - 1) : "";
        add(bit, name, fmt::format("material '{}'{}", scene_.materials[first].name, more));
    }

    void light(std::uint32_t bit, const char* name, PunctualLight::Kind kind) {
        const auto is = [&](const PunctualLight& light) { return light.kind == kind; };
        const auto first = std::find_if(scene_.lights.begin(), scene_.lights.end(), is);
        if (first == scene_.lights.end()) return;
        const auto count = std::count_if(scene_.lights.begin(), scene_.lights.end(), is);
        add(bit, name,
            fmt::format("light '{}'{}", first->name, count > 1 ? fmt::format(" and {} more", count - 1) : ""));
    }

    void add(std::uint32_t bit, const char* name, std::string reason) {
        features_.push_back({bit, name, std::move(reason)});
    }

    bool has(std::uint32_t bit) const { return (bits_of(features_) & bit) != 0; }
    std::vector<Feature> take() { return std::move(features_); }

private:
    const Scene& scene_;
    const std::vector<SurfaceTraits>& traits_;
    std::vector<bool> used_;
    std::vector<Feature> features_;
};

}  // namespace

std::vector<Feature> features_of(const Scene& scene, const std::vector<SurfaceTraits>& traits, const FlatScene& flat) {
    using Traits = const SurfaceTraits&;
    using Kind = PunctualLight::Kind;
    Collector collect(scene, traits);
    collect.material(FEATURE_REFLECTION, "reflection", [](Traits t) { return t.reflects(); });
    collect.material(FEATURE_TRANSMISSION, "transmission", [](Traits t) { return t.glass; });
    std::size_t smooth = 0;
    for (const gpu::TriangleShading& shading : flat.shading) {
        const Traits t = traits[shading.material & ~SHADING_FLAT];
        if (t.gathers() && (t.normal_map || (shading.material & SHADING_FLAT) == 0)) ++smooth;
    }
    if (smooth > 0) {
        collect.add(FEATURE_SMOOTH, "shading normals",
                    fmt::format("{} triangles that gather photons have some", smooth));
    }
    collect.material(FEATURE_GLOSS, "directional gathering",
                     [](Traits t) { return t.gathers() && (t.is_rough() || (t.diffuse && t.reflects())); });
    collect.material(FEATURE_ROUGH, "rough lobes", [](Traits t) { return t.is_rough(); });
    collect.material(FEATURE_COAT, "coats", [](Traits t) { return t.coat; });
    collect.material(FEATURE_CLEARCOAT, "clearcoats", [](Traits t) { return t.clearcoat; });
    collect.material(FEATURE_THIN, "thin walls", [](Traits t) { return t.thin; });
    collect.material(FEATURE_VOLUME, "absorption", [](Traits t) { return t.absorbs; });
    collect.material(FEATURE_DISPERSION, "dispersion", [](Traits t) { return t.disperses; });
    collect.material(FEATURE_TEXTURES, "textures", [](Traits t) { return t.textured; });
    collect.material(FEATURE_NORMAL_MAPS, "normal maps", [](Traits t) { return t.normal_map; });
    if (collect.has(FEATURE_NORMAL_MAPS) && !scene.tangents.empty()) {
        collect.add(FEATURE_TANGENTS, "tangents", "normal maps, and vertices that have some");
    }
    if (!scene.colors.empty()) collect.add(FEATURE_VERTEX_COLORS, "vertex colours", "vertices that have some");
    collect.material(FEATURE_ALPHA, "alpha", [](Traits t) { return t.alpha; });
    collect.material(FEATURE_UNLIT, "unlit surfaces", [](Traits t) { return t.unlit; });
    collect.material(FEATURE_AREA_LIGHTS, "area lights", [](Traits t) { return t.emits && !t.unlit; });
    const auto textured =
        std::count_if(flat.lights.begin(), flat.lights.end(), [](const gpu::Light& l) { return l.textured != 0; });
    if (textured > 0) {
        collect.add(FEATURE_TEXTURED_LIGHTS, "textured lights",
                    fmt::format("{} parts of emitters with a texture or alpha", textured));
    }
    collect.light(FEATURE_POINT_LIGHTS, "point lights", Kind::point);
    collect.light(FEATURE_SPOT_LIGHTS, "spot lights", Kind::spot);
    collect.light(FEATURE_DIRECTIONAL_LIGHTS, "directional lights", Kind::directional);
    if (!flat.environment.empty()) {
        collect.add(FEATURE_ENVIRONMENT, "environment",
                    fmt::format("a map of {}x{}", scene.environment->size.width, scene.environment->size.height));
    }
    return collect.take();
}

std::uint32_t bits_of(const std::vector<Feature>& features) {
    std::uint32_t bits = 0;
    for (const Feature& feature : features) bits |= feature.bit;
    return bits;
}

std::string gathering_rule() {
    return "Eye paths gather photons on diffuse lobes and follow lobes without roughness. A rough lobe is both "
           "followed,\n"
           "with its own density p, and gathered on, as by k photons (--knn) of density cos/pi, weighed by the "
           "balance\n"
           "heuristic: of its light p / (p + k cos/pi) is found by following and the rest by photons. Where a rough "
           "lobe\n"
           "may be followed a point of a light is asked for too, weighed against meeting it by the same heuristic. "
           "What\n"
           "of a punctual light comes by way of mirrors or smooth glass is brought by photons alone.";
}

}  // namespace vkcppm
