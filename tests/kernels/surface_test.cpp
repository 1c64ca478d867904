// Surfaces at hits: positions on their planes, normals on the side of the ray, and rays that leave on the right side.

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "flat/flatten.h"
#include "kernels/probe.h"
#include "oracle/octahedral.h"
#include "support/device/gpu.h"
#include "support/device/trace_kernel.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

constexpr std::uint32_t surface_words[] = {
#include "surface.spv.inc"
};

class SurfaceAtHit : public GpuTest {};

Scene tilted_triangles(std::mt19937& random) {
    std::uniform_real_distribution<double> place(-1.0, 1.0);
    Scene scene;
    const auto material = add_material(scene, lambert(glm::vec3(0.5f)));
    for (int i = 0; i < 200; ++i) {
        const double size = std::pow(10.0, -2.0 * std::abs(place(random)));
        const auto offset = [&] { return size * glm::dvec3(place(random), place(random), place(random)); };
        const glm::dvec3 centre(place(random), place(random), place(random));
        add_triangle(scene, centre + offset(), centre + offset(), centre + offset(), material);
        if (i % 2 == 0) continue;
        for (int c = 1; c <= 3; ++c) {  // smooth, and some bent far from the triangle
            glm::vec3& n = scene.normals[scene.normals.size() - c];
            n = glm::normalize(n + glm::vec3(i % 8 == 1 ? 1.5 : 0.3) *
                                       glm::vec3(place(random), place(random), place(random)));
        }
    }
    return scene;
}

TEST_F(SurfaceAtHit, LiesOnItsPlaneAndFacesTheRay) {
    std::mt19937 random(19);
    std::uniform_real_distribution<double> place(-1.0, 1.0);
    for (const auto& [name, scene] :
         {std::pair("room", room()), std::pair("tilted triangles", tilted_triangles(random))}) {
        SCOPED_TRACE(name);
        const FlatScene flat = flatten(scene);
        std::vector<gpu::RayInput> rays;
        for (int i = 0; i < 30000; ++i) {
            const glm::vec3 origin(glm::vec3(0.45 * place(random), 0.45 * place(random), 0.45 * place(random)));
            rays.push_back({origin, glm::normalize(glm::vec3(place(random), place(random), place(random)))});
        }
        Probe probe("surface", surface_words, flat.bvh.stack);
        probe.input(Binding::nodes, flat.bvh.nodes);
        probe.input(Binding::triangles, flat.triangles);
        probe.input(Binding::shading, flat.shading);
        probe.input(Binding::instances, flat.instances);
        probe.input(PROBE_INPUT, rays);
        probe.output<gpu::SurfaceOutput>(PROBE_OUTPUT, rays.size());
        probe.run(rays.size(),
                  {.iteration = 0, .last_round = 0, .argument = 7000, .items = std::uint32_t(rays.size())});
        const auto outputs = probe.result<gpu::SurfaceOutput>(PROBE_OUTPUT, rays.size());

        std::size_t hits = 0, smooth = 0, backs = 0, turned = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const gpu::SurfaceOutput& s = outputs[i];
            if (s.found != found_hit) continue;
            ++hits;
            const gpu::TriangleGeometry& t = flat.triangles[s.triangle];
            const gpu::TriangleShading& shading = flat.shading[s.triangle];
            const glm::dvec3 d(rays[i].direction), v0(t.v0), e1(t.e1), e2(t.e2), p(s.position);
            const glm::dvec3 cross = glm::cross(e1, e2), plane = glm::normalize(cross);
            const double cosine = std::abs(glm::dot(plane, d));
            const std::string line = fmt::format(
                "ray {} at triangle {}, position ({:.9g}, {:.9g}, {:.9g}), cosine {:.3g}, error bound {:.3g}", i,
                s.triangle, p.x, p.y, p.z, cosine, s.error);
            ASSERT_EQ(s.material, shading.material & ~SHADING_FLAT) << line;
            ASSERT_LE(std::abs(glm::dot(p - v0, plane)), s.error) << line << ": off its plane";
            ASSERT_LT(s.error, 5e-6) << line;
            // Slivers and grazing rays have ill-conditioned barycentrics; the rest is rounding.
            const double condition = glm::length(e1) * glm::length(e2) / glm::length(cross) / cosine;
            ASSERT_LT(glm::length(glm::cross(p - glm::dvec3(rays[i].origin), d)), 2e-6 * condition)
                << line << ": off its ray";

            const bool front = glm::dot(plane, d) < 0.0;
            const glm::dvec3 facing = front ? plane : -plane;
            if (cosine > 1e-5) {
                ASSERT_EQ(s.front != 0, front) << line;
                ASSERT_LT(glm::distance(glm::dvec3(s.geometric), facing), 2e-6 * condition * cosine) << line;
            }
            backs += front ? 0 : 1;
            ASSERT_LT(glm::dot(glm::dvec3(s.normal), d), 0.0) << line << ": the shading normal faces away from the ray";
            ASSERT_NEAR(glm::length(glm::dvec3(s.normal)), 1.0, 1e-6) << line;
            if (shading.material & SHADING_FLAT) {
                ASSERT_EQ(s.normal, s.geometric) << line;
            } else {
                ++smooth;
                const double u = glm::dot(glm::cross(p - v0, e2), cross) / glm::dot(cross, cross);
                const double v = glm::dot(glm::cross(e1, p - v0), cross) / glm::dot(cross, cross);
                glm::dvec3 n = glm::normalize((1.0 - u - v) * oracle::unpack_direction(shading.normal[0]) +
                                              u * oracle::unpack_direction(shading.normal[1]) +
                                              v * oracle::unpack_direction(shading.normal[2]));
                if (!front) n = -n;
                if (std::abs(glm::dot(n, d)) > 1e-3) {
                    const bool away = glm::dot(n, d) > 0.0;
                    turned += away ? 1 : 0;
                    ASSERT_LT(glm::distance(glm::dvec3(s.normal), away ? facing : n), 1e-5 * condition) << line;
                }
            }
            const double outside = glm::dot(glm::dvec3(s.outside) - v0, facing),
                         inside = glm::dot(glm::dvec3(s.inside) - v0, facing);
            ASSERT_GT(outside, 0.0) << line << ": a ray that goes back starts behind the surface";
            ASSERT_LT(inside, 0.0) << line << ": a ray that goes on starts before the surface";
            ASSERT_LT(std::max(outside, -inside), 2.5 * s.error) << line;
        }
        EXPECT_GT(hits, 5000u);
        EXPECT_GT(smooth, 1000u);
        EXPECT_GT(backs, 1000u);
        RecordProperty(std::string(name) + " normals turned", int(turned));
    }
}

}  // namespace
}  // namespace vkcppm::test
