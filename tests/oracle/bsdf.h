#pragma once
// How a surface scatters: the glTF 2.0 material (appendix B) with transmission, volume, ior, specular, clearcoat,
// anisotropy, iridescence and sheen, in double precision.

#include <array>
#include <iterator>
#include <optional>
#include <random>

#include <boost/container/static_vector.hpp>
#include <glm/vec3.hpp>

namespace vkcppm::oracle {

/// Uniform in [0, 1).
double uniform(std::mt19937_64& random);

enum class Lobe { diffuse, reflection, transmission, coat, sheen };
inline constexpr Lobe all_lobes[] = {Lobe::diffuse, Lobe::reflection, Lobe::transmission, Lobe::coat, Lobe::sheen};

/// Parameters after textures. Directions wo (towards the eye) and wi (towards the light) are unit and point away from
/// the surface; the normals are on the side of wo, which is the inside of a solid where `front` is false. Reflection
/// goes to the geometric normal's side, transmission to the other.
/// h is the half vector, D the GGX distribution, V = G2 / (4 |n.wo| |n.wi|) with the height-correlated Smith G2
/// (Heitz 2014, "Understanding the Masking-Shadowing Function"). alpha == 0 is a delta lobe, unless anisotropy
/// stretches it: KHR_materials_anisotropy has alpha_t = mix(alpha, 1, strength^2) along the tangent and alpha_b = alpha
/// across it, which is at least 0.001 there.
/// A direction wo below a shading normal sees no rough lobe of that normal.
/// All but the coat lies below the sheen, which takes from it what KHR_materials_sheen's albedo scaling says.
struct Bsdf {
    glm::dvec3 geometric_normal{0.0, 0.0, 1.0};  // unit
    glm::dvec3 normal{0.0, 0.0, 1.0};            // unit, shading
    glm::dvec3 coat_normal{0.0, 0.0, 1.0};       // unit, shading
    glm::dvec3 base_color{1.0};
    double metallic = 0.0;
    double alpha = 1.0;                 // roughness^2
    double anisotropy = 0.0;            // strength
    glm::dvec3 tangent{1.0, 0.0, 0.0};  // unit, in the plane of the shading normal: where facets are wider
    double film = 0.0;                  // share of the surface with a thin film: fresnel_film
    double film_ior = 1.3;
    double film_thickness = 400.0;  // nm
    double transmission = 0.0;
    double ior = 1.5;             // of reflectances; 0: infinite, reflectance 1
    double refraction_ior = 1.5;  // of Snell's law: differs where a path draws its wavelength here
    double specular = 1.0;
    glm::dvec3 specular_color{1.0};
    double coat = 0.0;
    double coat_alpha = 0.0;  // clearcoatRoughness^2
    glm::dvec3 sheen_color{0.0};
    double sheen_alpha = 1.0;  // sheenRoughness^2: oracle/sheen.h
    bool thin = true;          // no volume behind: transmitted light passes straight on
    bool front = true;         // wo is on the outside

    /// The bidirectional scattering function of one lobe, less what lies on top takes, 1/sr, without the cosine and
    /// without delta lobes. That of transmission into a solid is for radiance over squared index:
    /// f(wo, wi) eta_o^2 = f(wi, wo) eta_i^2.
    glm::dvec3 evaluate(Lobe lobe, const glm::dvec3& wo, const glm::dvec3& wi) const;

    /// The sum over all lobes.
    glm::dvec3 evaluate(const glm::dvec3& wo, const glm::dvec3& wi) const;

    /// The sum of f |n.wi| over all lobes, each with the normal of its own: what light from wi is multiplied by.
    glm::dvec3 evaluate_cosine(const glm::dvec3& wo, const glm::dvec3& wi) const;

    /// A direction with all of its light: f |n.wi| integrated over the delta. What an opaque material reflects to below
    /// the geometric surface is absorbed; a transmissive one lets it in.
    struct Delta {
        Lobe lobe;
        glm::dvec3 direction;  // unit
        glm::dvec3 weight;
    };
    using Deltas = boost::container::static_vector<Delta, 3>;
    Deltas delta_lobes(const glm::dvec3& wo) const;

    /// Density, 1/sr, with which sample() chooses wi by lobes that are not deltas; integrates to their share of the
    /// choice, less what sample() loses to the wrong side of the surface and to total reflection.
    double pdf(const glm::dvec3& wo, const glm::dvec3& wi) const;

    /// A direction and the factor f |n.wi| / pdf on the path's radiance. A lobe is chosen by its estimated albedo,
    /// GGX by visible normals (Heitz 2018, "Sampling the GGX Distribution of Visible Normals").
    struct Sample {
        glm::dvec3 direction;       // unit
        glm::dvec3 weight;          // of all lobes that are no deltas, or of the one delta
        double pdf = 0.0;           // as pdf(), 1/sr; 0: a delta lobe
        Lobe lobe = Lobe::diffuse;  // that chose the direction
    };
    /// None where the path ends: absorbed, or sampled where the lobe is black.
    std::optional<Sample> sample(const glm::dvec3& wo, std::mt19937_64& random) const;

    /// Share of the light from everywhere, alike in all directions, that goes on to wo: the integral of f |n.wi| over
    /// the sphere and the delta lobes. Midpoint rule with steps^2 points a lobe, over cosine-distributed directions or
    /// half vectors distributed as D (n.h), where sample() has visible normals.
    glm::dvec3 directional_albedo(const glm::dvec3& wo, int steps = 256) const;

    /// Whether evaluate() is black for all directions.
    bool only_deltas() const;

    /// Whether light can cross the surface.
    bool transmits() const { return (1.0 - metallic) * transmission > 0.0; }

private:
    /// The distribution of half vectors: GGX of these widths along x and y about z.
    struct Facets {
        glm::dvec3 x, y, z;
        double alpha_x, alpha_y;
        double ggx(const glm::dvec3& h) const;
        double masking_root(const glm::dvec3& w) const;
        double visibility(const glm::dvec3& wo, const glm::dvec3& wi) const;
        double visible_normal_pdf(const glm::dvec3& wo, const glm::dvec3& h) const;
        glm::dvec3 sample_visible_normal(const glm::dvec3& wo, std::mt19937_64& random) const;
        glm::dvec3 world(const glm::dvec3& local) const { return local.x * x + local.y * y + local.z * z; }
    };
    Facets facets_of(Lobe lobe) const;
    const glm::dvec3& normal_of(Lobe lobe) const { return lobe == Lobe::coat ? coat_normal : normal; }
    bool is_delta(Lobe lobe) const;
    bool has(Lobe lobe) const;
    glm::dvec3 dielectric0() const;
    glm::dvec3 filmed(const glm::dvec3& bare, double weight, const glm::dvec3& f0, double cosine) const;
    double fresnel_exact(double cosine) const;
    glm::dvec3 fresnel_glass(double cosine) const;
    double through_glass(double cosine) const;
    glm::dvec3 fresnel_coat(double cosine) const;
    glm::dvec3 reflectance(double cosine) const;
    double below_coat(double cosine) const;
    double below_sheen(const glm::dvec3& wo, const glm::dvec3& wi) const;
    std::optional<glm::dvec3> refract(const glm::dvec3& wo, const glm::dvec3& h) const;
    glm::dvec3 half_vector(Lobe lobe, const glm::dvec3& wo, const glm::dvec3& wi) const;
    double lobe_pdf(Lobe lobe, const glm::dvec3& wo, const glm::dvec3& wi) const;
    glm::dvec3 lobe_albedo(Lobe lobe, const glm::dvec3& wo, int steps) const;
    std::optional<glm::dvec3> scatter(Lobe lobe, const glm::dvec3& wo, const glm::dvec3& h) const;
    double half_vector_jacobian(Lobe lobe, const glm::dvec3& wo, const glm::dvec3& wi, const glm::dvec3& h) const;
    using Choice = std::array<double, std::size(all_lobes)>;  // probability [lobe]; all zero: nothing scatters
    Choice choice(const glm::dvec3& wo) const;
    double pdf(const Choice& choice, const glm::dvec3& wo, const glm::dvec3& wi) const;
};

}  // namespace vkcppm::oracle
