#include "oracle/bsdf.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "oracle/channels.h"
#include "oracle/fresnel.h"
#include "oracle/sheen.h"

namespace vkcppm::oracle {
namespace {

using std::numbers::pi;

constexpr double coat_reflectance = 0.04;  // KHR_materials_clearcoat: index 1.5
constexpr double least_across = 1e-3;      // width across the tangent where there is anisotropy
constexpr double least_albedo = 0.05;      // of a rough lobe in the choice: its estimate may be far off

double mean(const glm::dvec3& v) { return (v.x + v.y + v.z) / 3.0; }

double cosine(const glm::dvec3& a, const glm::dvec3& b) { return std::clamp(glm::dot(a, b), 0.0, 1.0); }

double absolute_cosine(const glm::dvec3& a, const glm::dvec3& b) { return std::min(std::abs(glm::dot(a, b)), 1.0); }

/// Mirrored at the plane of `normal`.
glm::dvec3 mirrored(const glm::dvec3& w, const glm::dvec3& normal) { return w - 2.0 * glm::dot(w, normal) * normal; }

glm::dvec3 reflected(const glm::dvec3& wo, const glm::dvec3& h) { return 2.0 * glm::dot(wo, h) * h - wo; }

struct Frame {
    glm::dvec3 x, y, z;
    explicit Frame(const glm::dvec3& normal) : z(normal) {
        const glm::dvec3 other = std::abs(z.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        x = glm::normalize(glm::cross(other, z));
        y = glm::cross(z, x);
    }
    glm::dvec3 world(const glm::dvec3& local) const { return local.x * x + local.y * y + local.z * z; }
};

glm::dvec3 sample_cosine(const glm::dvec3& normal, std::mt19937_64& random) {
    const double radius2 = uniform(random), angle = 2.0 * pi * uniform(random);
    const double radius = std::sqrt(radius2);
    return Frame(normal).world({radius * std::cos(angle), radius * std::sin(angle), std::sqrt(1.0 - radius2)});
}

}  // namespace

/// D(h), 1/sr: 1 / (pi alpha_x alpha_y ((x.h)^2 / alpha_x^2 + (y.h)^2 / alpha_y^2 + (z.h)^2)^2), zero behind.
double Bsdf::Facets::ggx(const glm::dvec3& h) const {
    const double c = glm::dot(z, h);
    if (c <= 0.0) return 0.0;
    const double sum = std::pow(glm::dot(x, h) / alpha_x, 2) + std::pow(glm::dot(y, h) / alpha_y, 2) + c * c;
    return 1.0 / (pi * alpha_x * alpha_y * sum * sum);
}

double Bsdf::Facets::masking_root(const glm::dvec3& w) const {
    return std::hypot(alpha_x * glm::dot(x, w), alpha_y * glm::dot(y, w), glm::dot(z, w));
}

/// V of the absolute cosines, 1/sr.
double Bsdf::Facets::visibility(const glm::dvec3& wo, const glm::dvec3& wi) const {
    return 0.5 / (std::abs(glm::dot(wi, z)) * masking_root(wo) + std::abs(glm::dot(wo, z)) * masking_root(wi));
}

/// Density of visible normals, G1(wo) (wo.h) D(h) / (n.wo).
double Bsdf::Facets::visible_normal_pdf(const glm::dvec3& wo, const glm::dvec3& h) const {
    const double co = glm::dot(wo, z), ch = glm::dot(wo, h);
    if (co <= 0.0 || ch <= 0.0) return 0.0;
    return 2.0 * ch * ggx(h) / (co + masking_root(wo));
}

/// Of visible_normal_pdf: the hemisphere stretched by alpha, its projected disk, and back.
glm::dvec3 Bsdf::Facets::sample_visible_normal(const glm::dvec3& wo, std::mt19937_64& random) const {
    const glm::dvec3 view =
        glm::normalize(glm::dvec3(alpha_x * glm::dot(x, wo), alpha_y * glm::dot(y, wo), glm::dot(z, wo)));
    // `across` lies in the surface's plane; `up` completes the view's own disk.
    const glm::dvec3 flat(-view.y, view.x, 0.0);
    const double length = glm::length(flat);
    const glm::dvec3 across = length > 0.0 ? flat / length : glm::dvec3(1, 0, 0);
    const glm::dvec3 up = glm::cross(view, across);
    const double radius = std::sqrt(uniform(random)), angle = 2.0 * pi * uniform(random);
    const double a = radius * std::cos(angle);
    const double s = (1.0 + view.z) / 2.0;
    const double b = (1.0 - s) * std::sqrt(std::max(0.0, 1.0 - a * a)) + s * radius * std::sin(angle);
    const glm::dvec3 n = a * across + b * up + std::sqrt(std::max(0.0, 1.0 - a * a - b * b)) * view;
    return world(glm::normalize(glm::dvec3(alpha_x * n.x, alpha_y * n.y, std::max(1e-300, n.z))));
}

Bsdf::Facets Bsdf::facets_of(Lobe lobe) const {
    if (lobe == Lobe::coat || anisotropy == 0.0) {
        const Frame frame(normal_of(lobe));
        const double width = lobe == Lobe::coat ? coat_alpha : alpha;
        return {frame.x, frame.y, frame.z, width, width};
    }
    const glm::dvec3 x = glm::normalize(tangent - glm::dot(tangent, normal) * normal);
    const double across = std::max(alpha, least_across);
    return {x, glm::cross(normal, x), normal, glm::mix(across, 1.0, anisotropy * anisotropy), across};
}

double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

bool Bsdf::is_delta(Lobe lobe) const {
    switch (lobe) {
        case Lobe::diffuse:
        case Lobe::sheen: return false;
        case Lobe::reflection: return alpha == 0.0 && anisotropy == 0.0;
        case Lobe::transmission: return (alpha == 0.0 && anisotropy == 0.0) || (!thin && refraction_ior == 1.0);
        case Lobe::coat: return coat_alpha == 0.0;
    }
    return false;
}

/// Whether the lobe carries any light.
bool Bsdf::has(Lobe lobe) const {
    const double opaque = (1.0 - metallic) * (1.0 - transmission);
    switch (lobe) {
        case Lobe::diffuse: return opaque > 0.0 && largest(base_color) > 0.0;
        case Lobe::reflection: return metallic > 0.0 || transmits() || (opaque > 0.0 && specular > 0.0);
        case Lobe::transmission: return transmits() && ior != 0.0;
        case Lobe::coat: return coat > 0.0;
        case Lobe::sheen: return largest(sheen_color) > 0.0;
    }
    return false;
}

bool Bsdf::only_deltas() const {
    return std::all_of(std::begin(all_lobes), std::end(all_lobes),
                       [this](Lobe lobe) { return is_delta(lobe) || !has(lobe); });
}

double Bsdf::fresnel_exact(double cosine) const {
    if (ior == 0.0) return 1.0;
    return ior == 1.0 ? 0.0 : fresnel_dielectric(cosine, thin || front ? ior : 1.0 / ior);
}

/// Reflectance at normal incidence, without its strength.
glm::dvec3 Bsdf::dielectric0() const {
    const double normal_incidence = ior == 0.0 ? 1.0 : std::pow((1.0 - ior) / (1.0 + ior), 2);
    return glm::min(normal_incidence * specular_color, 1.0);
}

/// KHR_materials_iridescence: what a surface reflects where it is partly covered by the film. `bare` without, `weight`
/// times the film's over f0 with it; `cosine` on the side of the film.
glm::dvec3 Bsdf::filmed(const glm::dvec3& bare, double weight, const glm::dvec3& f0, double cosine) const {
    if (film == 0.0) return bare;
    return glm::mix(bare, weight * fresnel_film(f0, cosine, film_ior, film_thickness), film);
}

/// KHR_materials_specular on glass: f0 times colour and strength, f90 times strength. A channel of colour c has c times
/// the exact reflectance and 1 - c times Schlick's of a normal incidence of 0, at the larger of the angles on both
/// sides; total reflection stays total.
glm::dvec3 Bsdf::fresnel_glass(double cosine) const {
    const double exact = fresnel_exact(cosine);
    if (ior == 1.0) return filmed(glm::dvec3(0.0), specular, dielectric0(), cosine);
    double larger = cosine;  // the cosine of the larger angle
    if (ior != 0.0) {
        const double sine = std::sqrt(1.0 - cosine * cosine) / (thin || front ? ior : 1.0 / ior);
        if (sine >= 1.0) return glm::dvec3(1.0);
        larger = std::min(cosine, std::sqrt(1.0 - sine * sine));
    }
    const double most = ior == 0.0 ? 1.0 : std::pow((1.0 + ior) / (1.0 - ior), 2);  // of f0 is 1
    const glm::dvec3 color = glm::min(specular_color, most);
    const glm::dvec3 mixed = color * exact + (1.0 - color) * fresnel_schlick(glm::dvec3(0.0), 1.0, larger);
    return filmed(specular * glm::clamp(mixed, 0.0, 1.0), specular, dielectric0(), larger);
}

/// Of all channels alike, as much as the brightest leaves.
double Bsdf::through_glass(double cosine) const { return 1.0 - largest(fresnel_glass(cosine)); }

glm::dvec3 Bsdf::fresnel_coat(double cosine) const {
    return filmed(fresnel_schlick(dielectric0() * specular, specular, cosine), specular, dielectric0(), cosine);
}

glm::dvec3 Bsdf::reflectance(double cosine) const {
    glm::dvec3 sum(0.0);
    if (metallic > 0.0) sum += metallic * filmed(fresnel_metal(base_color, cosine), 1.0, base_color, cosine);
    if (metallic < 1.0 && transmission < 1.0) sum += (1.0 - metallic) * (1.0 - transmission) * fresnel_coat(cosine);
    if (transmits()) sum += (1.0 - metallic) * transmission * fresnel_glass(cosine);
    return sum;
}

double Bsdf::below_coat(double cosine) const {
    return coat > 0.0 ? 1.0 - coat * fresnel_schlick(glm::dvec3(coat_reflectance), 1.0, cosine).x : 1.0;
}

/// KHR_materials_sheen: min(1 - max3(color) E(n.wo), 1 - max3(color) E(n.wi)).
double Bsdf::below_sheen(const glm::dvec3& wo, const glm::dvec3& wi) const {
    if (!has(Lobe::sheen)) return 1.0;
    const double most = std::max(sheen_albedo(absolute_cosine(wo, normal), sheen_alpha),
                                 sheen_albedo(absolute_cosine(wi, normal), sheen_alpha));
    return 1.0 - largest(sheen_color) * std::min(1.0, most);
}

/// Through a facet of normal h, on the side of wo; none where the reflection is total.
std::optional<glm::dvec3> Bsdf::refract(const glm::dvec3& wo, const glm::dvec3& h) const {
    if (refraction_ior == 1.0) return -wo;
    const double ratio = front ? 1.0 / refraction_ior : refraction_ior;  // eta_o / eta_i
    const double c = glm::dot(wo, h);
    const double squared = 1.0 - ratio * ratio * std::max(0.0, 1.0 - c * c);
    if (squared <= 0.0) return std::nullopt;
    return glm::normalize(ratio * (c * h - wo) - std::sqrt(squared) * h);
}

/// Of reflection, of reflection mirrored at the plane (thin transmission), or of refraction (Walter et al. 2007).
glm::dvec3 Bsdf::half_vector(Lobe lobe, const glm::dvec3& wo, const glm::dvec3& wi) const {
    if (lobe != Lobe::transmission) return glm::normalize(wo + wi);
    if (thin) return glm::normalize(wo + mirrored(wi, normal));
    const double eta_o = front ? 1.0 : refraction_ior, eta_i = front ? refraction_ior : 1.0;
    const glm::dvec3 h = glm::normalize(eta_o * wo + eta_i * wi);
    return glm::dot(h, normal) < 0.0 ? -h : h;
}

/// Solid angle of half vectors a solid angle of wi.
double Bsdf::half_vector_jacobian(Lobe lobe, const glm::dvec3& wo, const glm::dvec3& wi, const glm::dvec3& h) const {
    const double oh = glm::dot(wo, h);
    if (lobe != Lobe::transmission || thin) {
        return 1.0 / (4.0 * oh);
    }
    const double eta_o = front ? 1.0 : refraction_ior, eta_i = front ? refraction_ior : 1.0;
    const double ih = glm::dot(wi, h), sum = eta_o * oh + eta_i * ih;
    return eta_i * eta_i * std::abs(ih) / (sum * sum);
}

/// Where a facet of normal h sends what comes from wo; none where it does not face wo or total reflection stops it.
std::optional<glm::dvec3> Bsdf::scatter(Lobe lobe, const glm::dvec3& wo, const glm::dvec3& h) const {
    if (glm::dot(wo, h) <= 0.0) return std::nullopt;
    if (lobe != Lobe::transmission) return reflected(wo, h);
    return thin ? mirrored(reflected(wo, h), normal) : refract(wo, h);
}

glm::dvec3 Bsdf::evaluate(Lobe lobe, const glm::dvec3& wo, const glm::dvec3& wi) const {
    const glm::dvec3 black(0.0);
    const bool through = lobe == Lobe::transmission;
    const double co = glm::dot(wo, normal_of(lobe)), ci = glm::dot(wi, normal_of(lobe)) * (through ? -1.0 : 1.0);
    if (is_delta(lobe) || !has(lobe) || ci <= 0.0 || (glm::dot(wi, geometric_normal) < 0.0) != through) return black;
    if (lobe == Lobe::diffuse) {
        const double share = (1.0 - metallic) * (1.0 - transmission);
        const glm::dvec3 sum = wo + wi;
        const double length = glm::length(sum);
        const double oh = length > 0.0 ? std::min(std::abs(glm::dot(wo, sum)) / length, 1.0) : 0.0;
        return share * base_color / pi * (1.0 - largest(fresnel_coat(oh))) * below_coat(oh) * below_sheen(wo, wi);
    }
    if (co <= 0.0) return black;
    if (lobe == Lobe::sheen) {
        const glm::dvec3 h = half_vector(lobe, wo, wi);
        return sheen_color *
               (sheen_value(co, ci, glm::dot(h, normal), sheen_alpha) * below_coat(absolute_cosine(wo, h)));
    }
    const Facets facets = facets_of(lobe);
    if (lobe == Lobe::coat) {
        const glm::dvec3 h = half_vector(lobe, wo, wi);
        return glm::dvec3((1.0 - below_coat(absolute_cosine(wo, h))) * facets.ggx(h) * facets.visibility(wo, wi));
    }
    if (lobe == Lobe::reflection) {
        const glm::dvec3 h = half_vector(lobe, wo, wi);
        const double oh = absolute_cosine(wo, h);
        return reflectance(oh) * (below_coat(oh) * below_sheen(wo, wi) * facets.ggx(h) * facets.visibility(wo, wi));
    }
    const glm::dvec3 h = half_vector(lobe, wo, wi);
    const double oh = glm::dot(wo, h);
    if (oh <= 0.0 || (!thin && glm::dot(wi, h) >= 0.0)) return black;
    // Walter et al. 2007, equation 21, with the squared index of the side of wi: of radiance over squared index. Thin
    // and mirrored, the Jacobian turns it into F D V of reflection.
    return (1.0 - metallic) * transmission * base_color *
           (below_coat(absolute_cosine(wo, normal)) * below_sheen(wo, wi) * through_glass(std::min(oh, 1.0)) *
            facets.ggx(h) * facets.visibility(wo, wi) * 4.0 * oh * half_vector_jacobian(lobe, wo, wi, h));
}

glm::dvec3 Bsdf::evaluate(const glm::dvec3& wo, const glm::dvec3& wi) const {
    glm::dvec3 sum(0.0);
    for (const Lobe lobe : all_lobes) sum += evaluate(lobe, wo, wi);
    return sum;
}

glm::dvec3 Bsdf::evaluate_cosine(const glm::dvec3& wo, const glm::dvec3& wi) const {
    glm::dvec3 sum(0.0);
    for (const Lobe lobe : all_lobes) sum += evaluate(lobe, wo, wi) * std::abs(glm::dot(wi, normal_of(lobe)));
    return sum;
}

Bsdf::Deltas Bsdf::delta_lobes(const glm::dvec3& wo) const {
    Deltas deltas;
    const auto add = [&](Lobe lobe, const glm::dvec3& direction, const glm::dvec3& weight) {
        const bool lost = lobe != Lobe::transmission && !transmits() && glm::dot(direction, geometric_normal) <= 0.0;
        if (!lost && largest(weight) > 0.0) {
            deltas.push_back({lobe, direction, weight});
        }
    };
    // A shading normal may face away from a grazing wo: the cosine is then that of grazing.
    const double co = cosine(wo, normal);
    if (is_delta(Lobe::coat) && has(Lobe::coat)) {
        add(Lobe::coat, reflected(wo, coat_normal), glm::dvec3(1.0 - below_coat(cosine(wo, coat_normal))));
    }
    if (is_delta(Lobe::reflection) && has(Lobe::reflection)) {
        const glm::dvec3 direction = reflected(wo, normal);
        add(Lobe::reflection, direction, reflectance(co) * (below_coat(co) * below_sheen(wo, direction)));
    }
    if (is_delta(Lobe::transmission) && has(Lobe::transmission)) {
        if (const auto direction = thin ? std::optional(-wo) : refract(wo, normal)) {
            add(Lobe::transmission, *direction,
                (1.0 - metallic) * transmission * base_color *
                    (through_glass(co) * below_coat(co) * below_sheen(wo, *direction)));
        }
    }
    return deltas;
}

Bsdf::Choice Bsdf::choice(const glm::dvec3& wo) const {
    Choice albedo{};
    const auto at = [&](Lobe lobe) -> double& { return albedo[std::size_t(lobe)]; };
    for (const Delta& delta : delta_lobes(wo)) at(delta.lobe) = mean(delta.weight);
    const double co = cosine(wo, normal), below = below_coat(co);
    const auto rough = [&](Lobe lobe) {
        return has(lobe) && !is_delta(lobe) && (lobe == Lobe::diffuse || glm::dot(wo, normal_of(lobe)) > 0.0);
    };
    if (rough(Lobe::diffuse)) {
        at(Lobe::diffuse) = least_albedo + below * (1.0 - metallic) * (1.0 - transmission) * mean(base_color) *
                                               (1.0 - largest(fresnel_coat(co)));
    }
    if (rough(Lobe::reflection)) at(Lobe::reflection) = least_albedo + below * mean(reflectance(co));
    if (rough(Lobe::transmission)) {
        at(Lobe::transmission) =
            least_albedo + below * (1.0 - metallic) * transmission * mean(base_color) * (1.0 - fresnel_exact(co));
    }
    if (rough(Lobe::coat)) at(Lobe::coat) = least_albedo + 1.0 - below_coat(cosine(wo, coat_normal));
    if (rough(Lobe::sheen)) {
        at(Lobe::sheen) = least_albedo + below * mean(sheen_color) * std::min(1.0, sheen_albedo(co, sheen_alpha));
    }
    double total = 0.0;
    for (const double probability : albedo) total += probability;
    for (double& probability : albedo) {
        probability = total > 0.0 ? probability / total : 0.0;
    }
    return albedo;
}

double Bsdf::lobe_pdf(Lobe lobe, const glm::dvec3& wo, const glm::dvec3& wi) const {
    const bool through = lobe == Lobe::transmission;
    const double ci = glm::dot(wi, normal_of(lobe)) * (through ? -1.0 : 1.0);
    if (ci <= 0.0 || (glm::dot(wi, geometric_normal) < 0.0) != through) return 0.0;
    if (lobe == Lobe::diffuse || lobe == Lobe::sheen) return ci / pi;
    const glm::dvec3 h = half_vector(lobe, wo, wi);
    if (glm::dot(wo, h) <= 0.0 || (through && !thin && glm::dot(wi, h) >= 0.0)) return 0.0;
    return facets_of(lobe).visible_normal_pdf(wo, h) * half_vector_jacobian(lobe, wo, wi, h);
}

double Bsdf::pdf(const Choice& choice, const glm::dvec3& wo, const glm::dvec3& wi) const {
    double sum = 0.0;
    for (const Lobe lobe : all_lobes) {
        if (!is_delta(lobe) && choice[std::size_t(lobe)] > 0.0) {
            sum += choice[std::size_t(lobe)] * lobe_pdf(lobe, wo, wi);
        }
    }
    return sum;
}

double Bsdf::pdf(const glm::dvec3& wo, const glm::dvec3& wi) const { return pdf(choice(wo), wo, wi); }

std::optional<Bsdf::Sample> Bsdf::sample(const glm::dvec3& wo, std::mt19937_64& random) const {
    const Choice choices = choice(wo);
    double left = uniform(random);
    std::optional<Lobe> chosen;
    for (const Lobe lobe : all_lobes) {
        if (const double probability = choices[std::size_t(lobe)]; probability > 0.0) {
            chosen = lobe;  // the last one also takes what rounding leaves
            if ((left -= probability) < 0.0) break;
        }
    }
    if (!chosen) return std::nullopt;
    const Lobe lobe = *chosen;
    if (is_delta(lobe)) {
        for (const Delta& delta : delta_lobes(wo)) {
            if (delta.lobe == lobe) {
                return Sample{delta.direction, delta.weight / choices[std::size_t(lobe)], 0.0, lobe};
            }
        }
        return std::nullopt;
    }
    std::optional<glm::dvec3> wi;
    if (lobe == Lobe::diffuse || lobe == Lobe::sheen) {
        wi = sample_cosine(normal, random);
    } else {
        wi = scatter(lobe, wo, facets_of(lobe).sample_visible_normal(wo, random));
    }
    if (!wi || lobe_pdf(lobe, wo, *wi) == 0.0) {
        return std::nullopt;  // on the wrong side for this lobe: another's density does not account for it
    }
    const double density = pdf(choices, wo, *wi);
    const glm::dvec3 value = evaluate_cosine(wo, *wi);
    if (value == glm::dvec3(0.0)) return std::nullopt;
    return Sample{*wi, value / density, density, lobe};
}

glm::dvec3 Bsdf::lobe_albedo(Lobe lobe, const glm::dvec3& wo, int steps) const {
    const glm::dvec3& n = normal_of(lobe);
    const Facets facets = facets_of(lobe);
    glm::dvec3 sum(0.0);
    for (int i = 0; i < steps; ++i) {
        // cos^2 = t for diffuse. Of the half vectors of D (n.h), the slopes are alpha_x r cos and alpha_y r sin with
        // r^2 = (1 - t^2) / t^2, so that the density of t is 2 t: it takes away the pole of 1 / (n.h) at grazing half
        // vectors.
        const double t = (i + 0.5) / steps;
        for (int j = 0; j < steps; ++j) {
            const double angle = 2.0 * pi * (j + 0.5) / steps;
            if (lobe == Lobe::diffuse) {
                const double sine = std::sqrt(1.0 - t);
                sum += pi *
                       evaluate(lobe, wo, facets.world({sine * std::cos(angle), sine * std::sin(angle), std::sqrt(t)}));
                continue;
            }
            const double r = std::sqrt(1.0 - t * t);
            if (lobe == Lobe::sheen) {
                // A density of 1 / (4 pi sqrt(cos)) of the directions, cos = t^2: what it reflects to grazing ones.
                const double sine = std::sqrt(1.0 - t * t * t * t);
                sum += 4.0 * pi * t * t * t *
                       evaluate(lobe, wo, facets.world({sine * std::cos(angle), sine * std::sin(angle), t * t}));
                continue;
            }
            const glm::dvec3 local = glm::normalize(
                glm::dvec3(facets.alpha_x * r * std::cos(angle), facets.alpha_y * r * std::sin(angle), t));
            const glm::dvec3 h = facets.world(local);
            if (const auto wi = scatter(lobe, wo, h)) {
                sum += evaluate(lobe, wo, *wi) * (2.0 * t * std::abs(glm::dot(*wi, n))) /
                       (facets.ggx(h) * local.z * half_vector_jacobian(lobe, wo, *wi, h));
            }
        }
    }
    return sum / (double(steps) * steps);
}

glm::dvec3 Bsdf::directional_albedo(const glm::dvec3& wo, int steps) const {
    glm::dvec3 sum(0.0);
    for (const Delta& delta : delta_lobes(wo)) sum += delta.weight;
    for (const Lobe lobe : all_lobes) {
        if (!is_delta(lobe)) sum += lobe_albedo(lobe, wo, steps);
    }
    return sum;
}

}  // namespace vkcppm::oracle
