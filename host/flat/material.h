#pragma once
// What kernels read of a glTF material: the one place where its factors and textures become that.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "flat/textures.h"
#include "scene/scene.h"
#include "shared/types.h"

namespace vkcppm {

enum class Lobe : std::uint32_t {
#define NAME_LOBE(number, NAME, name, present) name = number,
    LOBES(NAME_LOBE)
#undef NAME_LOBE
};
#define COUNT_LOBE(number, NAME, name, present) +1
inline constexpr std::size_t lobe_count = LOBES(COUNT_LOBE);
#undef COUNT_LOBE

/// How a material has a lobe somewhere on a surface; not at all: none of it.
struct LobeTraits {
    bool smooth = false;  // of width 0, a delta
    bool rough = false;   // of facets, of a width above 0
    bool wide = false;    // without facets: of width WIDE
    bool there() const { return smooth || rough || wide; }
};

/// What a material can show somewhere on a surface, textures and vertex colours considered.
struct MaterialTraits {
    std::array<LobeTraits, lobe_count> lobes{};
    bool metal = false;
    bool coat = false;     // a dielectric coat over a diffuse base
    bool thin = false;     // transmits without a volume
    bool absorbs = false;  // transmits with absorption in its volume
    bool disperses = false;
    bool specular_glass = false;  // KHR_materials_specular has a say on what glass reflects
    bool culled = false;          // the camera does not see its back
    bool alpha = false;           // is partly not there
    bool unlit = false;
    bool textured = false;
    bool normal_map = false;
    bool anisotropic = false;
    bool iridescent = false;
    bool emits = false;
    bool has(Lobe lobe) const { return lobes[std::size_t(lobe)].there(); }
    bool smooth() const { return std::ranges::any_of(lobes, &LobeTraits::smooth); }
    bool is_rough() const { return std::ranges::any_of(lobes, &LobeTraits::rough); }
    bool reflects() const { return has(Lobe::reflection) || has(Lobe::clearcoat); }
    bool gathers() const { return is_rough() || std::ranges::any_of(lobes, &LobeTraits::wide); }
    bool is_lamp() const { return emits && !unlit; }
    /// What arrives is weighed by its direction: it gathers, and not on the diffuse lobe alone.
    bool glossy() const;
    /// bool asks_for_<NAME>() const: the trait of each row MATERIAL of FEATURE_TABLE.
#define ASKS_FOR(bit, NAME, words, trait) \
    bool asks_for_##NAME() const { return trait; }
#define NO_TRAIT(bit, NAME, words)
    FEATURE_TABLE(ASKS_FOR, NO_TRAIT, NO_TRAIT)
#undef ASKS_FOR
#undef NO_TRAIT
};

/// least_alpha: as of least_alphas() in scene/diagnosis/alpha.h.
MaterialTraits traits_of(const Material& material, float least_alpha);

/// [materials] Those of every material of the scene.
std::vector<MaterialTraits> traits_of(const Scene& scene);

/// What kernels read of the material. scale: frame units a metre. Its textures are added to `textures`.
gpu::SurfaceMaterial gpu_material(const Material& material, const MaterialTraits& traits, double scale,
                                  TextureTable& textures);

/// One line for `vkcppm info`: the lobes, their parameters, textures, emission.
std::string describe_material(const Material& material, const MaterialTraits& traits);

}  // namespace vkcppm
