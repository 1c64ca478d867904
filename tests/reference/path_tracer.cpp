#include "reference/path_tracer.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <thread>
#include <vector>

#include <glm/geometric.hpp>

#include "reference/bvh.h"
#include "reference/surface.h"

namespace vkcppm::reference {
namespace {

constexpr std::uint32_t roulette_depth = 5;

double brightest(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

/// Emissive triangles, chosen in proportion to area and brightest channel.
class AreaLights {
public:
    explicit AreaLights(const Scene& scene) : scene_(scene) {
        for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
            const double weight = area(i) * brightest(scene.materials[scene.triangles[i].material].emission);
            if (weight > 0.0) {
                triangles_.push_back(i);
                cumulative_.push_back(total_ += weight);
            }
        }
    }

    bool empty() const { return triangles_.empty(); }

    struct Point {
        std::uint32_t triangle;
        glm::dvec3 barycentric;
    };
    Point sample(std::mt19937_64& random) const {
        const double position = uniform(random) * total_;
        const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), position);
        const std::size_t i = std::min<std::size_t>(found - cumulative_.begin(), triangles_.size() - 1);
        const double u = uniform(random), v = uniform(random);
        const double root = std::sqrt(u);
        return {triangles_[i], {1.0 - root, root * (1.0 - v), root * v}};
    }

    /// Probability density of sample(), 1/m^2, on a triangle.
    double density(std::uint32_t triangle) const {
        const double emission = brightest(scene_.materials[scene_.triangles[triangle].material].emission);
        return emission > 0.0 ? emission / total_ : 0.0;
    }

private:
    double area(std::uint32_t triangle) const {
        const auto& v = scene_.triangles[triangle].vertex;
        const glm::dvec3& p = scene_.positions[v[0]];
        return glm::length(glm::cross(scene_.positions[v[1]] - p, scene_.positions[v[2]] - p)) / 2.0;
    }

    const Scene& scene_;
    std::vector<std::uint32_t> triangles_;
    std::vector<double> cumulative_;
    double total_ = 0.0;
};

struct Tracer {
    const Scene& scene;
    const Bvh& bvh;
    const AreaLights& area_lights;
    std::uint32_t max_depth;

    /// Density, 1/sr, with which AreaLights::sample() chooses the direction to a point of an emitter.
    double light_density(const Surface& light, const glm::dvec3& direction, double distance,
                         std::uint32_t triangle) const {
        return area_lights.density(triangle) * distance * distance / -glm::dot(direction, light.geometric_normal);
    }

    /// Radiance that a diffuse surface scatters from one sampled point on the emitters, weighted by light sampling's
    /// share of the two densities.
    glm::dvec3 from_area_lights(const Surface& surface, std::mt19937_64& random) const {
        if (area_lights.empty()) {
            return glm::dvec3(0.0);
        }
        const auto point = area_lights.sample(random);
        const auto& v = scene.triangles[point.triangle].vertex;
        const glm::dvec3 position = point.barycentric.x * scene.positions[v[0]] +
                                    point.barycentric.y * scene.positions[v[1]] +
                                    point.barycentric.z * scene.positions[v[2]];
        const glm::dvec3 to_light = position - surface.position;
        const double distance = glm::length(to_light);
        if (distance == 0.0) {
            return glm::dvec3(0.0);
        }
        const glm::dvec3 direction = to_light / distance;
        const double cosine = glm::dot(direction, surface.shading_normal);
        if (cosine <= 0.0 || glm::dot(direction, surface.geometric_normal) <= 0.0) {
            return glm::dvec3(0.0);
        }
        const Surface light = surface_at(scene, {distance, point.barycentric, point.triangle}, direction);
        Ray shadow = leave(surface, direction);
        shadow.t_max = distance * (1.0 - 1e-7);
        if (light.emission == glm::dvec3(0.0) || bvh.occluded(shadow)) {
            return glm::dvec3(0.0);
        }
        const double light_pdf = light_density(light, direction, distance, point.triangle);
        const double surface_pdf = cosine / std::numbers::pi;
        return surface.base_color / std::numbers::pi * light.emission * cosine / (light_pdf + surface_pdf);
    }

    /// Radiance that a diffuse surface scatters from one punctual light.
    glm::dvec3 from_punctual(const Surface& surface, const PunctualLight& light) const {
        glm::dvec3 direction = -light.direction;
        glm::dvec3 irradiance = light.intensity;  // across the light's direction
        double distance = std::numeric_limits<double>::infinity();
        if (light.kind != PunctualLight::Kind::directional) {
            const glm::dvec3 to_light = light.position - surface.position;
            distance = glm::length(to_light);
            direction = to_light / distance;
            irradiance /= distance * distance;
        }
        if (light.kind == PunctualLight::Kind::spot) {
            // KHR_lights_punctual's recommended falloff.
            const double outer = std::cos(light.outer_cone);
            const double width = std::max(std::cos(light.inner_cone) - outer, 1e-3);
            const double t = std::clamp((-glm::dot(direction, light.direction) - outer) / width, 0.0, 1.0);
            irradiance *= t * t;
        }
        const double cosine = glm::dot(direction, surface.shading_normal);
        if (cosine <= 0.0 || glm::dot(direction, surface.geometric_normal) <= 0.0) {
            return glm::dvec3(0.0);
        }
        Ray shadow = leave(surface, direction);
        shadow.t_max = distance * (1.0 - 1e-9);
        if (irradiance == glm::dvec3(0.0) || bvh.occluded(shadow)) {
            return glm::dvec3(0.0);
        }
        return surface.base_color / std::numbers::pi * irradiance * cosine;
    }

    glm::dvec3 radiance(Ray ray, std::mt19937_64& random) const {
        glm::dvec3 sum(0.0), throughput(1.0);
        std::optional<double> surface_pdf;  // 1/sr of the last bounce; none after the camera, mirrors and glass
        for (std::uint32_t depth = 0; depth <= max_depth; ++depth) {
            const auto hit = bvh.nearest(ray);
            if (!hit) {
                break;
            }
            const Surface surface = surface_at(scene, *hit, ray.direction);
            double share = 1.0;
            if (surface_pdf) {
                const double light_pdf = light_density(surface, ray.direction, hit->t, hit->triangle);
                share = *surface_pdf / (*surface_pdf + light_pdf);
            }
            sum += throughput * surface.emission * share;
            const bool diffuse = surface.scattering == Scattering::lambert;
            if (diffuse && depth < max_depth) {
                sum += throughput * from_area_lights(surface, random);
                for (const PunctualLight& light : scene.lights) {
                    sum += throughput * from_punctual(surface, light);
                }
            }
            const Scatter scatter = sample_scatter(surface, ray.direction, random);
            surface_pdf.reset();
            if (diffuse) {
                surface_pdf = glm::dot(scatter.direction, surface.shading_normal) / std::numbers::pi;
            }
            throughput *= scatter.weight;
            if (depth >= roulette_depth) {
                const double survival = std::min(1.0, brightest(throughput));
                if (uniform(random) >= survival) {
                    break;
                }
                throughput /= survival;
            }
            if (throughput == glm::dvec3(0.0)) {
                break;
            }
            ray = leave(surface, scatter.direction);
        }
        return sum;
    }
};

}  // namespace

Ray camera_ray(const Camera& camera, const Extent& size, double x, double y) {
    const double half = std::tan(camera.yfov / 2.0);
    const double aspect = static_cast<double>(size.width) / size.height;
    const glm::dvec3 local((2.0 * x / size.width - 1.0) * half * aspect, (1.0 - 2.0 * y / size.height) * half, -1.0);
    return {glm::dvec3(camera.to_world[3]), glm::normalize(glm::dmat3(camera.to_world) * local)};
}

PathTracing path_trace(const Scene& scene, const PathTracerSettings& settings) {
    assert(settings.samples >= 2 && settings.camera < scene.cameras.size());
    for (const Triangle& triangle : scene.triangles) {
        scattering(scene.materials[triangle.material]);  // throws here rather than in a thread
    }
    const Bvh bvh(scene);
    const AreaLights area_lights(scene);
    const Tracer tracer{scene, bvh, area_lights, settings.max_depth};
    const Extent size = settings.size;
    PathTracing result{{size, std::vector<glm::vec3>(size.pixels())}, {size, std::vector<glm::vec3>(size.pixels())}};

    std::atomic<std::uint32_t> next_row{0};
    const auto trace_rows = [&] {
        for (std::uint32_t y; (y = next_row++) < size.height;) {
            for (std::uint32_t x = 0; x < size.width; ++x) {
                const std::size_t pixel = std::size_t(y) * size.width + x;
                std::seed_seq key{settings.seed, settings.seed >> 32, std::uint64_t(pixel)};  // takes 32 bits of each
                std::mt19937_64 random(key);
                glm::dvec3 mean(0.0), squares(0.0);  // Welford's running mean and sum of squared deviations
                for (std::uint32_t i = 1; i <= settings.samples; ++i) {
                    const double u = uniform(random), v = uniform(random);
                    const glm::dvec3 value =
                        tracer.radiance(camera_ray(scene.cameras[settings.camera], size, x + u, y + v), random);
                    const glm::dvec3 delta = value - mean;
                    mean += delta / double(i);
                    squares += delta * (value - mean);
                }
                const double n = settings.samples;
                result.mean.rgb[pixel] = mean;
                result.standard_error.rgb[pixel] = glm::sqrt(squares / (n * (n - 1.0)));
            }
        }
    };
    std::vector<std::jthread> threads;
    for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i) {
        threads.emplace_back(trace_rows);
    }
    threads.clear();  // joins
    return result;
}

}  // namespace vkcppm::reference
