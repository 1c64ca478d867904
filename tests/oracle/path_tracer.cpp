#include "oracle/path_tracer.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include "oracle/area_lights.h"
#include "oracle/bvh.h"
#include "oracle/channels.h"
#include "oracle/dispersion.h"
#include "oracle/environment_light.h"
#include "oracle/surface.h"

namespace vkcppm::oracle {
namespace {

constexpr std::uint32_t roulette_depth = 5;

struct Tracer {
    const Scene& scene;
    std::uint32_t max_depth;
    Bvh bvh;
    AreaLights area_lights;
    EnvironmentLight environment;
    std::vector<glm::dvec3> absorptions;  // [materials] 1/m
    bool has_alpha;                       // of any material

    Tracer(const Scene& scene, std::uint32_t max_depth)
        : scene(scene),
          max_depth(max_depth),
          bvh(scene),
          area_lights(scene),
          environment(scene.environment),
          has_alpha(std::any_of(scene.materials.begin(), scene.materials.end(),
                                [](const Material& material) { return material.alpha != Material::Alpha::opaque; })) {
        for (const Material& material : scene.materials) absorptions.push_back(absorption(material));
    }

    const Material& material_of(const Hit& hit) const {
        return scene.materials[scene.triangles[hit.triangle].material];
    }

    /// Of a medium over a distance in m: exp(-sigma d), 1 outside all volumes.
    glm::dvec3 transmittance(const std::optional<std::uint32_t>& medium, double distance) const {
        glm::dvec3 result(1.0);
        for (int channel = 0; medium && channel < 3; ++channel) {
            if (const double sigma = absorptions[*medium][channel]; sigma > 0.0) {
                result[channel] = std::exp(-sigma * distance);
            }
        }
        return result;
    }

    /// An opaque surface of one side, whose back the camera does not see.
    bool is_back(const Ray& ray, const Hit& hit) const {
        const Material& material = material_of(hit);
        return !material.double_sided && material.transmission == 0.0f && !surface_at(scene, hit, ray.direction).front;
    }

    /// What the ray meets of surfaces that are there. culls: backs are not, either.
    std::optional<Hit> meet(Ray ray, std::mt19937_64& random, bool culls) const {
        for (;;) {
            const auto hit = bvh.nearest(ray);
            if (!hit || (!has_alpha && !culls)) return hit;
            const double solid = culls && is_back(ray, *hit) ? 0.0 : coverage(scene, *hit);
            if (solid >= 1.0 || (solid > 0.0 && uniform(random) < solid)) return hit;
            ray.t_min = hit->t;
        }
    }

    /// Share of light that passes along the ray by surfaces that are not all there.
    double passes(Ray ray) const {
        if (!has_alpha) return bvh.occluded(ray) ? 0.0 : 1.0;
        double share = 1.0;
        while (const auto hit = bvh.nearest(ray)) {
            share *= 1.0 - coverage(scene, *hit);
            if (share <= 0.0) return 0.0;
            ray.t_min = hit->t;
        }
        return share;
    }

    /// Density, 1/sr, with which AreaLights::sample() chooses the direction to a point of an emitter.
    double area_light_pdf(const Surface& light, const glm::dvec3& direction, const Hit& hit) const {
        return area_lights.density(hit.triangle) * hit.t * hit.t / -glm::dot(direction, light.geometric_normal);
    }

    /// A vertex of a path that connects to lights.
    struct Vertex {
        const Surface& surface;
        glm::dvec3 wo;                                           // unit
        std::optional<std::uint32_t> front_medium, back_medium;  // the materials on the side of wo and behind
        glm::dvec3 through_color;  // factor on what is transmitted: of a wavelength drawn here
    };

    /// Factor f |n.wi| on the light from `direction` that starts at `distance`, with all that stands between.
    glm::dvec3 connect(const Vertex& vertex, const glm::dvec3& direction, double distance, double t_max) const {
        const bool through = glm::dot(direction, vertex.surface.geometric_normal) < 0.0;
        glm::dvec3 factor = vertex.surface.bsdf.evaluate_cosine(vertex.wo, direction);
        if (factor == glm::dvec3(0.0)) return factor;
        Ray shadow = leave(vertex.surface, direction);
        shadow.t_max = t_max;
        factor *= passes(shadow);
        if (through) factor *= vertex.through_color;
        return factor * transmittance(through ? vertex.back_medium : vertex.front_medium, distance);
    }

    /// Radiance from one sampled point on the emitters, weighted by light sampling's share of the two densities.
    glm::dvec3 from_area_lights(const Vertex& vertex, std::mt19937_64& random) const {
        if (area_lights.empty()) return glm::dvec3(0.0);
        const auto point = area_lights.sample(random);
        const glm::dvec3 to_light = point.position - vertex.surface.position;
        const double distance = glm::length(to_light);
        if (distance == 0.0) return glm::dvec3(0.0);
        const glm::dvec3 direction = to_light / distance;
        const Hit hit{distance, point.barycentric, point.triangle};
        const Surface light = surface_at(scene, hit, direction);
        const glm::dvec3 emission = light.emission * coverage(scene, hit);
        if (emission == glm::dvec3(0.0) || glm::dot(direction, light.geometric_normal) == 0.0) return glm::dvec3(0.0);
        const glm::dvec3 factor = connect(vertex, direction, distance, distance * (1.0 - 1e-7));
        if (factor == glm::dvec3(0.0)) return factor;
        return factor * emission /
               (area_light_pdf(light, direction, hit) + vertex.surface.bsdf.pdf(vertex.wo, direction));
    }

    /// The same from one sampled direction to the environment.
    glm::dvec3 from_environment(const Vertex& vertex, std::mt19937_64& random) const {
        if (environment.empty()) return glm::dvec3(0.0);
        const glm::dvec3 direction = environment.sample(random);
        const double infinity = std::numeric_limits<double>::infinity();
        const glm::dvec3 factor = connect(vertex, direction, infinity, infinity);
        if (factor == glm::dvec3(0.0)) return factor;
        return factor * environment.radiance(direction) /
               (environment.density(direction) + vertex.surface.bsdf.pdf(vertex.wo, direction));
    }

    /// Radiance from one punctual light.
    glm::dvec3 from_punctual(const Vertex& vertex, const PunctualLight& light) const {
        glm::dvec3 direction = -light.direction;
        glm::dvec3 irradiance = light.intensity;  // across the light's direction
        double distance = std::numeric_limits<double>::infinity();
        if (light.kind != PunctualLight::Kind::directional) {
            const glm::dvec3 to_light = light.position - vertex.surface.position;
            distance = glm::length(to_light);
            direction = to_light / distance;
            irradiance /= distance * distance;
            if (light.range > 0.0) irradiance *= std::max(0.0, 1.0 - std::pow(distance / light.range, 4.0));
        }
        if (light.kind == PunctualLight::Kind::spot) {
            // KHR_lights_punctual's recommended falloff.
            const double outer = std::cos(light.outer_cone);
            const double width = std::max(std::cos(light.inner_cone) - outer, 1e-3);
            const double t = std::clamp((-glm::dot(direction, light.direction) - outer) / width, 0.0, 1.0);
            irradiance *= t * t;
        }
        if (irradiance == glm::dvec3(0.0)) return irradiance;
        return connect(vertex, direction, distance, distance * (1.0 - 1e-9)) * irradiance;
    }

    /// What has happened to a path on its way from the camera.
    struct Path {
        Ray ray;
        glm::dvec3 throughput{1.0};
        std::optional<double> pdf{};         // 1/sr of the last bounce; none after the camera and delta lobes
        bool seen_directly = true;           // so far
        bool culls = true;                   // nothing has sent it elsewhere yet
        std::vector<std::uint32_t> media{};  // materials of the volumes it is in, innermost last
        std::optional<double> wavelength{};  // nm

        std::optional<std::uint32_t> medium() const {
            return media.empty() ? std::nullopt : std::optional(media.back());
        }
    };

    /// The path enters or leaves the volume of a material.
    static void cross(std::vector<std::uint32_t>& media, std::uint32_t material, bool enters) {
        if (enters) {
            media.push_back(material);
        } else if (const auto last = std::find(media.rbegin(), media.rend(), material); last != media.rend()) {
            media.erase(std::next(last).base());
        }
    }

    glm::dvec3 escaped(const Path& path) const {
        double share = 1.0;
        if (path.pdf) {
            share = *path.pdf / (*path.pdf + environment.density(path.ray.direction));
        }
        return share * environment.radiance(path.ray.direction) *
               transmittance(path.medium(), std::numeric_limits<double>::infinity());
    }

    glm::dvec3 radiance(const Ray& camera_ray, std::mt19937_64& random) const {
        glm::dvec3 sum(0.0);
        Path path{camera_ray};
        for (std::uint32_t depth = 0; depth <= max_depth; ++depth) {
            const auto hit = meet(path.ray, random, path.culls);
            if (!hit) return sum + path.throughput * escaped(path);
            const std::uint32_t material_index = scene.triangles[hit->triangle].material;
            const Material& material = scene.materials[material_index];
            Surface surface = surface_at(scene, *hit, path.ray.direction);
            Bsdf& bsdf = surface.bsdf;
            const bool volume = !bsdf.thin && bsdf.transmits();
            // A path that starts in a volume learns so where it leaves it.
            const bool inside = volume && !surface.front;
            if (inside && path.media.empty()) path.media.push_back(material_index);
            path.throughput *= transmittance(path.medium(), hit->t);
            if (material.unlit) return path.seen_directly ? sum + path.throughput * surface.base_color : sum;
            double share = 1.0;
            if (path.pdf) {
                share = *path.pdf / (*path.pdf + area_light_pdf(surface, path.ray.direction, *hit));
            }
            sum += path.throughput * surface.emission * share;

            glm::dvec3 through_color(1.0);
            std::optional<double> drawn;
            if (volume && material.dispersion > 0.0f && bsdf.ior != 0.0) {
                if (!path.wavelength) {
                    drawn = shortest_wavelength + (longest_wavelength - shortest_wavelength) * uniform(random);
                    through_color = wavelength_color(*drawn);
                }
                bsdf.refraction_ior = ior_at(bsdf.ior, material.dispersion, drawn ? *drawn : *path.wavelength);
                if (path.wavelength) bsdf.ior = bsdf.refraction_ior;
            }
            std::vector<std::uint32_t> behind = path.media;
            if (volume) cross(behind, material_index, surface.front);
            const glm::dvec3 wo = -path.ray.direction;
            if (depth < max_depth && !bsdf.only_deltas()) {
                const auto back_medium = behind.empty() ? std::nullopt : std::optional(behind.back());
                const Vertex vertex{surface, wo, path.medium(), back_medium, through_color};
                sum += path.throughput * from_area_lights(vertex, random);
                sum += path.throughput * from_environment(vertex, random);
                for (const PunctualLight& light : scene.lights) sum += path.throughput * from_punctual(vertex, light);
            }
            const auto next = bsdf.sample(wo, random);
            if (!next) break;
            path.throughput *= next->weight;
            path.pdf = next->pdf > 0.0 ? std::optional(next->pdf) : std::nullopt;
            path.seen_directly = path.seen_directly && !path.pdf;
            path.culls = path.culls && next->direction == path.ray.direction;
            if (next->lobe == Lobe::transmission) {
                path.throughput *= through_color;
                path.wavelength = drawn ? drawn : path.wavelength;
            }
            if (glm::dot(next->direction, surface.geometric_normal) < 0.0) path.media = behind;
            if (depth >= roulette_depth) {
                const double survival = std::min(1.0, largest(path.throughput));
                if (uniform(random) >= survival) break;
                path.throughput /= survival;
            }
            path.ray = leave(surface, next->direction);
        }
        return sum;
    }
};

}  // namespace

Ray camera_ray(const Camera& camera, const Extent& size, double x, double y) {
    return lens_ray(camera, size, x, y, glm::dvec2(0.0), 1.0);
}

Ray lens_ray(const Camera& camera, const Extent& size, double x, double y, const glm::dvec2& lens,
             double focus_distance) {
    const double half = camera.ymag.value_or(std::tan(camera.yfov / 2.0));
    const double aspect = static_cast<double>(size.width) / size.height;
    const glm::dvec3 film((2.0 * x / size.width - 1.0) * half * aspect, (1.0 - 2.0 * y / size.height) * half, 0.0);
    const glm::dvec3 eye = camera.ymag ? film : glm::dvec3(0.0);
    const glm::dvec3 ahead = camera.ymag ? glm::dvec3(0.0, 0.0, -1.0) : film - glm::dvec3(0.0, 0.0, 1.0);
    const glm::dvec3 sharp = eye + focus_distance * ahead;
    const glm::dvec3 start = eye + glm::dvec3(lens, 0.0);
    const glm::dmat3 rotation(camera.to_world);
    return {glm::dvec3(camera.to_world[3]) + rotation * start, glm::normalize(rotation * (sharp - start))};
}

PathTracing path_trace(const Scene& scene, const PathTracerSettings& settings) {
    assert(settings.samples >= 2 && settings.camera < scene.cameras.size());
    const Tracer tracer(scene, settings.max_depth);
    const Camera& camera = scene.cameras[settings.camera];
    const Extent size = settings.size;
    PathTracing result{{size, std::vector<glm::vec3>(size.pixels())}, {size, std::vector<glm::vec3>(size.pixels())}};
    tbb::parallel_for(std::size_t(0), size.pixels(), [&](std::size_t pixel) {
        std::seed_seq key{settings.seed, settings.seed >> 32, std::uint64_t(pixel)};  // takes 32 bits of each
        std::mt19937_64 random(key);
        glm::dvec3 mean(0.0), squares(0.0);  // Welford's running mean and sum of squared deviations
        for (std::uint32_t i = 1; i <= settings.samples; ++i) {
            const double x = double(pixel % size.width) + uniform(random);
            const double y = double(pixel / size.width) + uniform(random);
            glm::dvec2 lens(0.0);
            if (settings.aperture > 0.0) {
                const double radius = settings.aperture / 2.0 * std::sqrt(uniform(random));
                const double angle = 2.0 * std::numbers::pi * uniform(random);
                lens = {radius * std::cos(angle), radius * std::sin(angle)};
            }
            const glm::dvec3 value =
                tracer.radiance(lens_ray(camera, size, x, y, lens, settings.focus_distance), random);
            const glm::dvec3 delta = value - mean;
            mean += delta / double(i);
            squares += delta * (value - mean);
        }
        const double n = settings.samples;
        result.mean.rgb[pixel] = mean;
        result.standard_error.rgb[pixel] = glm::sqrt(squares / (n * (n - 1.0)));
    });
    return result;
}

}  // namespace vkcppm::oracle
