#pragma once
// How the kernels treat a glTF material: the one place where its factors and textures become a surface.

#include <string>
#include <vector>

#include "flat/textures.h"
#include "scene/scene.h"
#include "shared/types.h"

namespace vkcppm {

/// What a material can show somewhere on a surface, textures and vertex colours considered.
struct SurfaceTraits {
    bool diffuse = false;
    bool metal = false;
    bool coat = false;     // a dielectric coat over a diffuse base
    bool glass = false;    // transmits
    bool thin = false;     //   without a volume
    bool absorbs = false;  //   with absorption in its volume
    bool disperses = false;
    bool rough = false;   // a lobe of reflection or transmission of roughness above 0
    bool smooth = false;  // a delta lobe of reflection or transmission
    bool clearcoat = false;
    bool rough_clearcoat = false;
    bool alpha = false;  // is partly not there
    bool unlit = false;
    bool textured = false;
    bool normal_map = false;
    bool emits = false;
    bool reflects() const { return metal || coat || glass || clearcoat; }
    bool gathers() const { return !unlit && (diffuse || is_rough()); }
    bool is_lamp() const { return emits && !unlit; }
    /// What arrives is weighed by its direction: a coat over a diffuse base, or a rough lobe.
    bool glossy() const { return gathers() && (is_rough() || (diffuse && reflects())); }
    bool is_rough() const { return (rough && (metal || coat || glass)) || rough_clearcoat; }
};

/// least_alpha: as of least_alphas() in scene/diagnosis/alpha.h.
SurfaceTraits traits_of(const Material& material, float least_alpha);

/// [materials] Those of every material of the scene.
std::vector<SurfaceTraits> traits_of(const Scene& scene);

/// The surface that stands for the material. scale: frame units a metre. Its textures are added to `textures`.
gpu::SurfaceMaterial surface_of(const Material& material, const SurfaceTraits& traits, double scale,
                                TextureTable& textures);

/// One line for `vkcppm info`: the lobes, their parameters, textures, emission.
std::string describe_material(const Material& material, const SurfaceTraits& traits);

}  // namespace vkcppm
