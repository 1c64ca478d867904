// Photons of the tracing kernel: where they lie, what they carry, and that they depend on nothing but their path.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "oracle/octahedral.h"
#include "support/device/gpu.h"
#include "support/device/rig.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

using std::numbers::pi;

struct Stored {
    gpu::Photon photon;
    gpu::PhotonFlux flux;
};

/// Photons by path.
std::vector<std::vector<Stored>> stored_photons(Rig& rig) {
    const auto photons = rig.all<gpu::Photon>(Binding::photons);
    const auto fluxes = rig.all<gpu::PhotonFlux>(Binding::photon_flux);
    std::vector<std::vector<Stored>> paths;
    for (const StoredPath& path : rig.stored_paths()) {
        paths.emplace_back();
        for (std::size_t slot = path.slot; slot < path.slot + path.count; ++slot) {
            paths.back().push_back({photons[slot], fluxes[slot]});
        }
    }
    return paths;
}

Settings with_photons(std::uint32_t photons, std::uint32_t max_depth, std::uint32_t seed = 1) {
    Settings settings;
    settings.size = Extent{16, 16};
    settings.photons = photons;
    settings.direct = direct_gathered;  // else photons begin at the second surface: see direct_test.cpp
    settings.max_depth = max_depth;
    settings.seed = seed;
    return settings;
}

/// Power in W that the photons of a path carry, first channel.
double path_power(const Rig& rig, const std::vector<Stored>& path) {
    double sum = 0.0;
    for (const Stored& stored : path) sum += double(stored.flux.power.x);
    return sum / (rig.flat.frame.scale * rig.flat.frame.scale);
}

class Photons : public GpuTest {};

TEST_F(Photons, LieOnDiffuseSurfacesOnTheSideTheyCameFrom) {
    Rig rig(room(), with_photons(2048, 64));
    rig.integrator.run(1);
    std::size_t count = 0;
    for (const auto& path : stored_photons(rig)) {
        for (const Stored& stored : path) {
            ++count;
            const glm::dvec3 p(stored.photon.position);
            const glm::dvec3 normal = oracle::unpack_direction(stored.photon.normal);
            const glm::dvec3 towards = oracle::unpack_direction(stored.flux.direction);
            double nearest = 1e9;
            bool diffuse = false;
            glm::dvec3 facing(0.0);
            for (std::size_t i = 0; i < rig.flat.triangles.size(); ++i) {
                const gpu::TriangleGeometry& t = rig.flat.triangles[i];
                const glm::dvec3 e1(t.e1), e2(t.e2), n = glm::cross(e1, e2), offset = p - glm::dvec3(t.v0);
                const double u = glm::dot(glm::cross(offset, e2), n) / glm::dot(n, n);
                const double v = glm::dot(glm::cross(e1, offset), n) / glm::dot(n, n);
                const double height = std::abs(glm::dot(offset, glm::normalize(n)));
                if (u < -1e-5 || v < -1e-5 || u + v > 1.0 + 1e-5 || height > nearest) continue;
                nearest = height;
                const gpu::SurfaceMaterial& material = rig.flat.materials[rig.flat.shading[i].material & ~SHADING_FLAT];
                diffuse =
                    material.metallic == 0.0f && material.transmission == 0.0f && material.color != glm::vec3(0.0f);
                facing = glm::normalize(n);
            }
            ASSERT_LT(nearest, 5e-7) << fmt::format("photon at ({}, {}, {}) is {} off any triangle", p.x, p.y, p.z,
                                                    nearest);
            ASSERT_TRUE(diffuse) << fmt::format("photon at ({}, {}, {}) on a surface that is not diffuse", p.x, p.y,
                                                p.z);
            ASSERT_GT(glm::dot(towards, normal), -1e-4) << "arrived from behind its normal";
            ASSERT_GT(std::abs(glm::dot(facing, normal)), 1.0 - 1e-7) << "its normal is not the triangle's";
            ASSERT_TRUE(stored.flux.power.x > 0.0f && stored.flux.power.y > 0.0f && stored.flux.power.z > 0.0f);
        }
    }
    EXPECT_GT(count, 2048u);
    const Report report = rig.report();
    EXPECT_EQ(count, report.stored_photons);
}

TEST_F(Photons, AllCarryWhatTheirPathStartedWithInAGreyRoom) {
    // Roulette lets as many paths go on as the surface reflects of their power: in a closed room of albedo rho a path
    // stores b photons or more with probability rho^(b - 1), and each carries the same.
    const double albedo = 0.6;
    const double flux = pi * 0.25 * 5.0;  // the lamp's: pi times area times radiance
    for (const std::uint32_t depth : {1u, 2u, 4u}) {
        Rig rig(bare_room(float(albedo)), with_photons(4096, depth));
        rig.integrator.run(1);
        double count = 0.0;
        for (const auto& path : stored_photons(rig)) {
            count += double(path.size());
            EXPECT_NEAR(path_power(rig, path), flux * double(path.size()), 1e-5 * flux * double(path.size()));
        }
        double expected = 0.0, square = 0.0;  // of the photons of a path
        for (std::uint32_t b = 1; b <= depth; ++b) {
            expected += std::pow(albedo, b - 1.0);
            square += (2.0 * b - 1.0) * std::pow(albedo, b - 1.0);
        }
        const double error = std::sqrt(4096.0 * (square - expected * expected));
        EXPECT_NEAR(count, 4096.0 * expected, 4.0 * error) << "photons of 4096 paths of " << depth << " bounces";
    }
}

TEST_F(Photons, CarryTheSameFluxOnAverageUnderRoulette) {
    for (const float albedo : {0.3f, 0.9f}) {
        const std::uint32_t depth = 40;
        Rig rig(bare_room(albedo), with_photons(65536, depth));
        rig.integrator.run(1);
        const auto paths = stored_photons(rig);
        double sum = 0.0, squares = 0.0;
        for (const auto& path : paths) {
            const double power = path_power(rig, path);
            sum += power;
            squares += power * power;
        }
        const double n = double(paths.size()), mean = sum / n;
        const double error = std::sqrt((squares / n - mean * mean) / n);
        const double rho = albedo, expected = pi * 0.25 * 5.0 * (1.0 - std::pow(rho, depth)) / (1.0 - rho);
        EXPECT_NEAR(mean, expected, 4.0 * error) << "albedo " << albedo << ", standard error " << error << ", "
                                                 << (mean - expected) / error << " of them off";
        EXPECT_LT(error, 0.01 * expected);
    }
}

TEST_F(Photons, OfPunctualLightsCarryWhatMeetsASquare) {
    // Square of half side a: a point light h above its centre sees it under the solid angle 4 asin(a^2 / (a^2 + h^2)),
    // a spot within it loses nothing, a directional light sends it E times its area times the cosine.
    Scene scene;
    const double a = 1.0, h = 0.7;
    add_quad(scene, {-a, 0, -a}, {0, 0, 2 * a}, {2 * a, 0, 0}, add_material(scene, lambert(glm::vec3(0.5f))));
    add_camera(scene, {0, 2, 2}, {0, 0, 0}, 0.8);
    PunctualLight point;
    point.intensity = {1.0f, 0.0f, 0.0f};
    point.position = {0, h, 0};
    PunctualLight spot;
    spot.kind = PunctualLight::Kind::spot;
    spot.intensity = {0.0f, 8.0f, 0.0f};
    spot.position = {0, h, 0};
    spot.direction = {0, -1, 0};
    spot.inner_cone = 0.3;
    spot.outer_cone = 0.6;
    PunctualLight sun;
    sun.kind = PunctualLight::Kind::directional;
    sun.intensity = {0.0f, 0.0f, 2.0f};
    sun.direction = glm::normalize(glm::dvec3(1, -2, 0.5));
    scene.lights = {point, spot, sun};
    const double inner = std::cos(0.3), outer = std::cos(0.6);
    const glm::dvec3 expected(4.0 * std::asin(a * a / (a * a + h * h)),
                              8.0 * 2.0 * pi * ((1.0 - inner) + (inner - outer) / 3.0),
                              2.0 * 4.0 * a * a * -sun.direction.y);
    Rig rig(scene, with_photons(65536, 1));
    rig.integrator.run(1);
    const double scale2 = rig.flat.frame.scale * rig.flat.frame.scale;
    glm::dvec3 sum(0.0), squares(0.0);
    for (const auto& path : stored_photons(rig)) {
        for (const Stored& stored : path) {
            const glm::dvec3 power = glm::dvec3(stored.flux.power) / scale2;
            sum += power;
            squares += power * power;
        }
    }
    for (int c = 0; c < 3; ++c) {
        const double mean = sum[c] / 65536.0, error = std::sqrt((squares[c] / 65536.0 - mean * mean) / 65536.0);
        EXPECT_NEAR(mean, expected[c], 4.0 * error) << "light " << c << ", standard error " << error;
        EXPECT_LT(error, 0.02 * expected[c]);
    }
}

TEST_F(Photons, DoNotDependOnTheLaneThatTracesThem) {
    // 256 paths by lanes that have 16 each, and by lanes that have one: the same photons in the same order, bit by bit.
    Rig by_sixteen(room(), with_photons(4096, 64)), one_by_one(room(), with_photons(4096, 64));
    gpu::Params params = one_by_one.integrator.params();
    params.photons = 256;
    params.inverse_paths = 1.0f / 256.0f;
    params.photons_per_lane = 1;
    params.photon_lanes = 256;
    one_by_one.integrator.set_params(params);
    params.photons_per_lane = 16;
    params.photon_lanes = 64;
    params.photon_capacity *= 4;
    by_sixteen.integrator.set_params(params);
    by_sixteen.integrator.run(1);
    one_by_one.integrator.run(1);
    std::vector<Stored> a, b;
    for (const auto& path : stored_photons(by_sixteen)) a.insert(a.end(), path.begin(), path.end());
    for (const auto& path : stored_photons(one_by_one)) b.insert(b.end(), path.begin(), path.end());
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_TRUE(a[i].photon.position == b[i].photon.position && a[i].photon.normal == b[i].photon.normal &&
                    a[i].flux.power == b[i].flux.power && a[i].flux.direction == b[i].flux.direction)
            << "photon " << i << " of " << a.size();
    }
}

}  // namespace
}  // namespace vkcppm::test
