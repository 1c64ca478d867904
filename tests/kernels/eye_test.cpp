// The eye pass, path by path, against rays of the oracle's camera through the double-precision scene.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "kernels/probe.h"
#include "oracle/bvh.h"
#include "oracle/fresnel.h"
#include "oracle/octahedral.h"
#include "oracle/path_tracer.h"
#include "oracle/surface.h"
#include "support/device/gpu.h"
#include "support/device/rig.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

constexpr std::uint32_t rng_words[] = {
#include "rng.spv.inc"
};

constexpr std::uint32_t dimensions = 12;  // numbers of an eye path that are looked at: two of the film, one a bounce

/// The triangles and shading normals that the kernels see; materials of the scene.
Scene as_uploaded(const Rig& rig) {
    Scene scene;
    scene.materials = rig.scene.materials;
    for (std::size_t i = 0; i < rig.flat.triangles.size(); ++i) {
        const auto& t = rig.flat.triangles[i];
        const auto& shading = rig.flat.shading[i];
        const glm::dvec3 v0(t.v0);
        add_triangle(scene, v0, v0 + glm::dvec3(t.e1), v0 + glm::dvec3(t.e2), shading.material & ~SHADING_FLAT);
        if (shading.material & SHADING_FLAT) continue;
        for (int c = 0; c < 3; ++c)
            scene.normals[scene.normals.size() - 3 + c] = glm::vec3(oracle::unpack_direction(shading.normal[c]));
    }
    return scene;
}

/// numbers[pixel][dimension] of the eye paths of an iteration.
std::vector<std::vector<double>> numbers_of(const Rig& rig, std::uint32_t iteration) {
    std::vector<gpu::RngKey> keys;
    for (std::uint32_t pixel = 0; pixel < rig.pixels(); ++pixel) {
        for (std::uint32_t d = 0; d < dimensions; ++d) keys.push_back({rig.settings.seed, iteration, 0, pixel, d});
    }
    Probe probe("rng", rng_words);
    probe.input(PROBE_INPUT, keys);
    probe.output<gpu::RngSample>(PROBE_OUTPUT, keys.size());
    probe.run(keys.size(), {.iteration = 0, .last_round = 0, .argument = 0, .items = std::uint32_t(keys.size())});
    const auto samples = probe.result<gpu::RngSample>(PROBE_OUTPUT, keys.size());
    std::vector<std::vector<double>> numbers(rig.pixels());
    for (std::size_t i = 0; i < samples.size(); ++i) numbers[i / dimensions].push_back(samples[i].stratified);
    return numbers;
}

struct Path {
    bool diffuse = false;
    glm::dvec3 position{0.0}, normal{0.0}, weight{0.0}, emission{0.0};
    double length = 0.0;  // frame units
    std::uint32_t bounces = 0;
    bool delicate = false;  // a choice or a silhouette that rounding may decide otherwise
};

/// Follows the path of one pixel. Lengths in the frame.
Path follow(const Rig& rig, const Scene& scene, const oracle::Bvh& bvh, std::uint32_t pixel,
            const std::vector<double>& numbers) {
    const Extent size = *rig.settings.size;
    const double x = pixel % size.width + numbers[0], y = pixel / size.width + numbers[1];
    oracle::Ray ray = oracle::camera_ray(rig.scene.cameras[0], size, x, y);
    ray.origin = rig.flat.frame.point(ray.origin);
    Path path;
    glm::dvec3 throughput(1.0);
    for (std::uint32_t depth = 0; depth < rig.settings.max_depth && depth + 2 < dimensions; ++depth) {
        const auto hit = bvh.nearest(ray);
        if (!hit) break;
        path.length += hit->t;
        ++path.bounces;
        const oracle::Surface surface = oracle::surface_at(scene, *hit, ray.direction);
        const double slope = glm::dot(surface.shading_normal, ray.direction);
        // Grazing curved glass, a path crosses a facet by a chord that is nearly nothing.
        const bool grazing = slope > (surface.scattering == oracle::Scattering::glass ? -0.15 : -0.02);
        path.delicate =
            path.delicate || grazing || std::min({hit->barycentric.x, hit->barycentric.y, hit->barycentric.z}) < 1e-4;
        path.emission += throughput * surface.emission;
        if (surface.scattering == oracle::Scattering::lambert) {
            path.diffuse = surface.base_color != glm::dvec3(0.0);
            path.position = surface.position;
            path.normal = surface.shading_normal;
            path.weight = throughput * surface.base_color / std::numbers::pi;
            break;
        }
        const glm::dvec3 n = surface.shading_normal, reflected = glm::reflect(ray.direction, n);
        const double cosine = std::min(1.0, -slope);
        glm::dvec3 next = reflected;
        bool reflects = true;
        if (surface.scattering == oracle::Scattering::mirror) {
            throughput *= oracle::fresnel_metal(surface.base_color, cosine);
        } else {
            const double ratio = surface.front ? surface.ior : 1.0 / surface.ior;
            const double reflectance = oracle::fresnel_dielectric(cosine, ratio), u = numbers[depth + 2];
            path.delicate = path.delicate || std::abs(u - reflectance) < 1e-3;
            if (u >= reflectance) {
                reflects = false;
                const double cosine_t = std::sqrt(std::max(0.0, 1.0 - (1.0 - cosine * cosine) / (ratio * ratio)));
                next = glm::normalize((ray.direction + cosine * n) / ratio - cosine_t * n);
                throughput *= surface.base_color / (ratio * ratio);  // radiance: Veach 1997, section 5.2
            }
        }
        const double side = glm::dot(next, surface.geometric_normal);
        // Shading normals that bend a ray to the wrong side: Specular.BentShadingNormals... has the rule.
        path.delicate = path.delicate || (reflects ? side < 1e-2 : side > -1e-2);
        ray = {surface.position + std::copysign(1e-7, side) * surface.geometric_normal, next};
    }
    return path;
}

class Eye : public GpuTest {};

TEST_F(Eye, PathsEndWhereTheOracleEndsThem) {
    Settings settings;
    settings.size = Extent{96, 64};
    settings.photons = 64;
    settings.direct = direct_gathered;  // emission is then what the path meets, and nothing that it asks for
    Scene scene = room();
    add_sphere(scene, {0.55, 0.45, 0.8}, 0.15, 1, add_material(scene, lambert({0.2f, 0.4f, 0.8f})),
               false);  // inside the glass
    add_quad(scene, {0.2, 1.0, 0.02}, {0.4, 0.0, 0.0}, {0.0, 0.4, 0.0},
             add_material(scene, emitter({3.0f, 2.0f, 1.0f})));
    Rig rig(scene, settings);
    const Scene uploaded = as_uploaded(rig);
    const oracle::Bvh bvh(uploaded);
    std::size_t bounced = 0, emitting = 0, delicate = 0;
    for (std::uint32_t iteration = 0; iteration < 3; ++iteration) {
        rig.integrator.run(1);
        const auto numbers = numbers_of(rig, iteration);
        const auto positions = rig.all<gpu::HitPosition>(Binding::hit_position);
        const auto weights = rig.all<gpu::HitWeight>(Binding::hit_weight);
        const auto emissions = rig.all<gpu::HitEmission>(Binding::hit_emission);
        for (std::uint32_t i = 0; i < rig.pixels(); ++i) {
            const Path path = follow(rig, uploaded, bvh, i, numbers[i]);
            if (path.delicate) {
                ++delicate;
                continue;
            }
            const std::string line =
                fmt::format("iteration {}, pixel ({}, {}), {} bounces, ends at ({:.6f}, {:.6f}, {:.6f})", iteration,
                            i % 96, i / 96, path.bounces, path.position.x, path.position.y, path.position.z);
            // Curved glass magnifies rounding: a factor of about ten an interface.
            const double tolerance = path.bounces > 1 ? 3e-5 * std::pow(4.0, std::min(path.bounces, 6u) - 1.0) : 2e-6;
            ASSERT_EQ((positions[i].state & HIT_MASK) == HIT_DIFFUSE, path.diffuse) << line;
            ASSERT_LT(glm::distance(glm::dvec3(emissions[i].emission), path.emission),
                      1e-4 * (1e-3 + glm::length(path.emission)))
                << line;
            emitting += path.emission != glm::dvec3(0.0) ? 1 : 0;
            if (!path.diffuse) continue;
            bounced += path.bounces > 1 ? 1 : 0;
            ASSERT_LT(glm::distance(glm::dvec3(positions[i].position), path.position), tolerance) << line;
            ASSERT_LT(glm::distance(glm::dvec3(weights[i].weight), path.weight), 1e-4 * glm::length(path.weight))
                << line;
            ASSERT_LT(glm::distance(oracle::unpack_direction(weights[i].normal), path.normal), 7e-5 + 10.0 * tolerance)
                << line;
            // A disc of the pixel's area at the length of the path, for a view without a bend.
            const double half = std::tan(0.5 * rig.scene.cameras[0].yfov), pixel_side = 2.0 * half / 64.0;
            const double footprint = path.length * pixel_side / std::sqrt(std::numbers::pi);
            ASSERT_NEAR(emissions[i].footprint, footprint, (1e-5 + tolerance) * footprint) << line;
        }
    }
    EXPECT_GT(bounced, 1000u) << "paths by mirror and glass";
    EXPECT_GT(emitting, 100u) << "paths that met an emitter";
    EXPECT_LT(delicate, 3 * rig.pixels() / 10) << "paths that rounding may decide";
}

TEST_F(Eye, TheEnvironmentIsSeenWhereThereIsNoTriangle) {
    Scene scene;
    scene.environment = Environment{{1, 2}, {{1.0f, 2.0f, 3.0f}, {4.0f, 5.0f, 6.0f}}};
    add_camera(scene, {0, 0, 0}, {0, 0, -1}, 1.0);
    Settings settings;
    settings.size = Extent{4, 4};
    settings.photons = 16;
    Rig rig(scene, settings);
    rig.integrator.run(2);
    const Image image = rig.integrator.resolve();
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        EXPECT_LT(glm::distance(image.rgb[i], scene.environment->radiance[i < 8 ? 0 : 1]), 1e-5f)
            << "pixel " << i << ": " << image.rgb[i].x << ", " << image.rgb[i].y << ", " << image.rgb[i].z;
    }
}

TEST_F(Eye, JitterCoversThePixelOverIterations) {
    // A plane across the view: hit positions give the film positions back.
    Scene scene;
    add_quad(scene, {-5, -5, -1}, {10, 0, 0}, {0, 10, 0}, add_material(scene, lambert(glm::vec3(0.5f))));
    add_camera(scene, {0, 0, 0}, {0, 0, -1}, 1.0);
    Settings settings;
    settings.size = Extent{3, 2};
    settings.photons = 16;
    Rig rig(scene, settings);
    const double half = std::tan(0.5);
    std::vector<glm::dvec2> mean(rig.pixels(), glm::dvec2(0.0));
    const int iterations = 64;
    for (int iteration = 0; iteration < iterations; ++iteration) {
        rig.integrator.run(1);
        const auto positions = rig.all<gpu::HitPosition>(Binding::hit_position);
        for (std::uint32_t i = 0; i < rig.pixels(); ++i) {
            const glm::dvec3 p = glm::dvec3(positions[i].position) / rig.flat.frame.scale + rig.flat.frame.centre;
            const glm::dvec2 film((p.x / (half * 1.5) + 1.0) * 1.5, (1.0 - p.y / half) * 1.0);
            const glm::dvec2 inside = film - glm::dvec2(i % 3, i / 3);
            ASSERT_TRUE(inside.x > -1e-4 && inside.x < 1.0001 && inside.y > -1e-4 && inside.y < 1.0001)
                << "pixel " << i << " saw film position " << film.x << ", " << film.y;
            mean[i] += inside / double(iterations);
        }
    }
    // The mean of 64 stratified numbers is within 1/64 or so of one half; of random ones it would be 0.036 off.
    for (const glm::dvec2& m : mean) {
        EXPECT_NEAR(m.x, 0.5, 0.03);
        EXPECT_NEAR(m.y, 0.5, 0.03);
    }
}

}  // namespace
}  // namespace vkcppm::test
