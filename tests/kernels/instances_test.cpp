// Rays through the tree of instances over the trees of meshes, against copies of the instances, all triangles one by
// one in double precision.

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "flat/flatten.h"
#include "kernels/probe.h"
#include "oracle/intersect.h"
#include "scene/instances.h"
#include "support/device/gpu.h"
#include "support/device/trace_kernel.h"
#include "support/scenes/instanced.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

constexpr std::uint32_t occlusion_words[] = {
#include "occlusion.spv.inc"
};
constexpr std::uint32_t surface_words[] = {
#include "surface.spv.inc"
};

using Random = std::mt19937;

double uniform(Random& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}
glm::dvec3 in_box(Random& random, double half) {
    return {uniform(random, -half, half), uniform(random, -half, half), uniform(random, -half, half)};
}
glm::dvec3 direction(Random& random) {
    glm::dvec3 d(0.0);
    while (glm::length(d) < 0.1 || glm::length(d) > 1.0) d = in_box(random, 1.0);
    return glm::normalize(d);
}

/// Turned, of `size` along one axis and less along the others, every other one mirrored, some sheared.
glm::dmat4 placement(Random& random, const glm::dvec3& at, double size) {
    for (;;) {
        glm::dmat4 m =
            glm::translate(glm::dmat4(1.0), at) *
            glm::rotate(glm::dmat4(1.0), uniform(random, 0.0, 6.0), direction(random)) *
            glm::scale(glm::dmat4(1.0), size * glm::dvec3(random() % 2 == 0 ? 1.0 : -1.0, uniform(random, 0.1, 1.0),
                                                          uniform(random, 0.1, 1.0)));
        if (random() % 3 == 0) {
            glm::dmat4 shear(1.0);
            shear[1][0] = uniform(random, -1.5, 1.5);
            shear[2][1] = uniform(random, -1.5, 1.5);
            m *= shear;
        }
        if (is_shareable(m)) return m;
    }
}

void begin_mesh(Scene& scene) { scene.meshes.push_back({std::uint32_t(scene.triangles.size()), 0}); }

/// Some triangles of the world, and instances of a closed mesh, of one that is flat and of loose triangles, each in a
/// space of its own. scale: of all of it.
Scene made_scene(Random& random, double scale, int instances) {
    Scene scene;
    scene.mesh_nodes.emplace_back();
    const auto material = add_material(scene, lambert(glm::vec3(0.5f)));
    for (int i = 0; i < 20; ++i) {
        const glm::dvec3 at = in_box(random, 1.0);
        add_triangle(scene, scale * (at + in_box(random, 0.3)), scale * (at + in_box(random, 0.3)),
                     scale * (at + in_box(random, 0.3)), material);
    }
    begin_mesh(scene);
    add_sphere(scene, {3.0, -2.0, 5.0}, 0.7, 2, material, true);
    begin_mesh(scene);
    for (int i = 0; i < 36; ++i) {
        add_quad(scene, {100.0 * (i % 6), 2000.0, 100.0 * (i / 6)}, {0.0, 0.0, 100.0}, {100.0, 0.0, 0.0}, material);
    }
    begin_mesh(scene);
    for (int i = 0; i < 60; ++i) {
        const glm::dvec3 at = in_box(random, 1e-3);
        add_triangle(scene, at + in_box(random, 4e-4), at + in_box(random, 4e-4), at + in_box(random, 4e-4), material);
    }
    const std::array<glm::dvec3, 3> centres = {glm::dvec3(3.0, -2.0, 5.0), {300.0, 2000.0, 300.0}, {0.0, 0.0, 0.0}};
    const std::array<double, 3> radii = {0.7, 424.0, 2e-3};
    for (int i = 0; i < instances; ++i) {
        const auto mesh = std::uint32_t(i % 3);
        const double size = scale * std::pow(10.0, uniform(random, -4.0, -0.3));
        const glm::dmat4 to_world = placement(random, scale * in_box(random, 1.0), size / radii[mesh]) *
                                    glm::translate(glm::dmat4(1.0), -centres[mesh]);
        scene.instances.push_back({glm::dmat4x3(to_world), mesh, 0});
    }
    return scene;
}

/// Copies of all instances, in the frame, and which triangle of them is which of a mesh.
struct Copies {
    Scene scene;
    std::vector<std::uint32_t> first;  // [instances] triangle
    const Scene& source;
    const FlatScene& flat;

    Copies(const Scene& made, const FlatScene& flattened) : scene(copied(made)), source(made), flat(flattened) {
        for (glm::dvec3& p : scene.positions) p = flat.frame.point(p);
        std::size_t next = world_triangles(made).count();
        for (const Instance& instance : made.instances) {
            first.push_back(std::uint32_t(next));
            next += triangles_of_mesh(made, instance.mesh).count();
        }
    }
    /// The copy of a triangle that kernels have hit.
    std::uint32_t triangle(std::uint32_t instance, std::uint32_t hit) const {
        const std::uint32_t triangle = flat.bvh.order[hit];
        if (instance == NO_INSTANCE) return triangle;
        return first[instance] + triangle - triangles_of_mesh(source, source.instances[instance].mesh).first;
    }
    std::array<glm::dvec3, 3> corners(std::uint32_t triangle) const {
        const auto& v = scene.triangles[triangle].vertex;
        return {scene.positions[v[0]], scene.positions[v[1]], scene.positions[v[2]]};
    }
    glm::dvec3 normal(std::uint32_t triangle) const {
        const auto [a, b, c] = corners(triangle);
        return glm::normalize(glm::cross(b - a, c - a));
    }
};

/// At points, edges and corners of the triangles, and anywhere.
std::vector<gpu::RayInput> rays_at(const Copies& copies, Random& random, std::size_t count) {
    std::vector<gpu::RayInput> rays;
    while (rays.size() < count) {
        const auto [a, b, c] = copies.corners(std::uint32_t(random() % copies.scene.triangles.size()));
        const double u = uniform(random, 0.0, 1.0), v = uniform(random, 0.0, 1.0 - u);
        const glm::vec3 origin(in_box(random, 0.5));
        glm::dvec3 target = a + u * (b - a) + v * (c - a);
        if (rays.size() % 8 == 0) target = in_box(random, 0.5);
        if (rays.size() % 8 == 1) target = a;
        if (rays.size() % 8 == 2) target = a + u * (b - a);
        const glm::dvec3 d = target - glm::dvec3(origin);
        if (glm::length(d) > 1e-6) rays.push_back({origin, glm::vec3(glm::normalize(d))});
    }
    return rays;
}

/// How close the ray comes to an edge of the triangle.
double distance_to_edges(const Copies& copies, std::uint32_t triangle, const gpu::RayInput& ray) {
    const glm::dvec3 d = glm::normalize(glm::dvec3(ray.direction));
    auto corners = copies.corners(triangle);
    for (glm::dvec3& p : corners) {
        p -= glm::dvec3(ray.origin);
        p -= glm::dot(p, d) * d;
    }
    double nearest = 1e30;
    for (int c = 0; c < 3; ++c) {
        const glm::dvec3 a = corners[c], side = corners[(c + 1) % 3] - a;
        const double length2 = glm::dot(side, side);
        const double along = length2 > 0.0 ? std::clamp(-glm::dot(a, side) / length2, 0.0, 1.0) : 0.0;
        nearest = std::min(nearest, glm::length(a + along * side));
    }
    return nearest;
}

constexpr double rounding = 1.5e-6;  // of a place in the frame

/// By how much rounding moves where the ray meets the triangle.
double t_bound(const Copies& copies, std::uint32_t triangle, const gpu::RayInput& ray) {
    return rounding / std::abs(glm::dot(copies.normal(triangle), glm::dvec3(ray.direction)));
}

class Instances : public GpuTest {
protected:
    template <typename Output, typename Input>
    std::vector<Output> run(const char* name, std::span<const std::uint32_t> words, const FlatScene& flat,
                            const std::vector<Input>& rays) {
        Probe probe(name, words, flat.bvh.stack, FEATURE_INSTANCES);
        probe.input(Binding::nodes, flat.bvh.nodes);
        probe.input(Binding::triangles, flat.triangles);
        probe.input(Binding::shading, flat.shading);
        probe.input(Binding::instances, flat.instances);
        probe.input(PROBE_INPUT, rays);
        probe.output<Output>(PROBE_OUTPUT, rays.size());
        probe.run(rays.size(), {.argument = step_budget, .items = std::uint32_t(rays.size())});
        return probe.result<Output>(PROBE_OUTPUT, rays.size());
    }
    std::vector<gpu::RayOutput> trace(const FlatScene& flat, const std::vector<gpu::RayInput>& rays) {
        return run<gpu::RayOutput>("trace", trace_words, flat, rays);
    }
};

TEST_F(Instances, AreMetWhereTheirCopiesAre) {
    Random random(31);
    for (const double scale : {1e-4, 1.0, 1e6}) {
        for (const int count : {3, 60}) {
            SCOPED_TRACE(fmt::format("scale {:g}, {} instances", scale, count));
            const Scene made = made_scene(random, scale, count);
            const FlatScene flat = flatten(made);
            ASSERT_EQ(flat.instances.size(), made.instances.size());
            const Copies copies(made, flat);
            const auto rays = rays_at(copies, random, 3000);
            const auto outputs = trace(flat, rays);
            std::size_t in_instances = 0, undecided = 0;
            for (std::size_t i = 0; i < rays.size(); ++i) {
                ASSERT_LE(outputs[i].found, found_hit) << "ray " << i << " is unfinished";
                const bool got = outputs[i].found == found_hit;
                const auto want =
                    oracle::nearest_hit(copies.scene, {glm::dvec3(rays[i].origin), glm::dvec3(rays[i].direction)});
                const std::uint32_t triangle = got ? copies.triangle(outputs[i].instance, outputs[i].triangle) : 0;
                in_instances += got && outputs[i].instance != NO_INSTANCE;
                if (!got && !want) continue;
                if (got && want &&
                    std::abs(outputs[i].t - want->t) <=
                        t_bound(copies, triangle, rays[i]) + t_bound(copies, want->triangle, rays[i])) {
                    continue;
                }
                const std::uint32_t nearer = !want || (got && outputs[i].t < want->t) ? triangle : want->triangle;
                ASSERT_LE(distance_to_edges(copies, nearer, rays[i]), rounding)
                    << "ray " << i << ": got " << (got ? fmt::format("{} in {}", outputs[i].t, triangle) : "a miss")
                    << ", want " << (want ? fmt::format("{} in {}", want->t, want->triangle) : "a miss");
                ++undecided;
            }
            EXPECT_GT(in_instances, rays.size() / 4);
            EXPECT_LT(undecided, rays.size() / 4);
        }
    }
}

TEST_F(Instances, AreInTheWayWhereTheyAreMet) {
    Random random(34);
    for (const double scale : {1e-4, 1.0, 1e6}) {
        SCOPED_TRACE(fmt::format("scale {:g}", scale));
        const Scene made = made_scene(random, scale, 60);
        const FlatScene flat = flatten(made);
        const Copies copies(made, flat);
        const auto rays = rays_at(copies, random, 3000);
        const auto nearest = trace(flat, rays);
        std::vector<gpu::OcclusionInput> inputs;
        std::vector<std::uint32_t> want;
        std::size_t in_instances = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const bool met = nearest[i].found == found_hit;
            const double within = met ? nearest[i].t * (i % 2 == 0 ? 1.5 : 0.5) : FAR;
            in_instances += met && i % 2 == 0 && nearest[i].instance != NO_INSTANCE;
            inputs.push_back({rays[i].origin, rays[i].direction, float(within), NO_TRIANGLE});
            want.push_back(met && i % 2 == 0 ? found_hit : found_miss);
        }
        EXPECT_GT(in_instances, rays.size() / 8);
        EXPECT_EQ(run<std::uint32_t>("occlusion", occlusion_words, flat, inputs), want);
    }
}

TEST_F(Instances, ClosedMeshesLetNothingOut) {
    Random random(32);
    for (const double size : {1.0, 1e-2, 1e-4}) {
        Scene scene;
        scene.mesh_nodes.emplace_back();
        const auto material = add_material(scene, lambert(glm::vec3(0.5f)));
        add_box(scene, {-1, -1, -1}, {1, 1, 1}, material, true);
        begin_mesh(scene);
        add_sphere(scene, {0.3, -0.2, 0.1}, 1.0, 3, material, false);
        begin_mesh(scene);
        add_box(scene, {-1, -0.5, -0.7}, {1, 0.8, 0.9}, material, false);
        for (int i = 0; i < 40; ++i) {
            const glm::dvec3 at = in_box(random, size < 0.5 ? 0.9 : 0.1);
            scene.instances.push_back(
                {glm::dmat4x3(placement(random, at, size < 0.5 ? size : 0.3)), std::uint32_t(i % 2), 0});
        }
        const FlatScene flat = flatten(scene);
        for (std::uint32_t chosen = 0; chosen < 8; ++chosen) {
            // One at a time, so that no other one stands in the way.
            Scene alone = scene;
            alone.instances = {scene.instances[chosen]};
            const FlatScene one = flatten(alone);
            const Copies copies(alone, one);
            std::vector<gpu::RayInput> rays;
            const glm::dmat4 to_world(alone.instances[0].to_world);
            while (rays.size() < 20000) {
                const auto first = copies.first[0];
                const auto [a, b, c] =
                    copies.corners(first + std::uint32_t(random() % (copies.scene.triangles.size() - first)));
                const glm::dvec3 inside = to_world * glm::dvec4(in_box(random, 0.2), 1.0);
                const glm::vec3 origin(one.frame.point(inside));
                glm::dvec3 target = glm::dvec3(origin) + direction(random);
                if (rays.size() % 4 == 1) target = a;
                if (rays.size() % 4 == 2) target = 0.5 * (a + b);
                if (rays.size() % 4 == 3) target = glm::mix(a, b, uniform(random, 0.0, 1.0));
                rays.push_back({origin, glm::vec3(glm::normalize(target - glm::dvec3(origin)))});
            }
            const auto outputs = trace(one, rays);
            const auto escaped = std::ranges::count_if(outputs, [](const gpu::RayOutput& output) {
                return output.found != found_hit || output.instance == NO_INSTANCE;
            });
            EXPECT_LE(escaped, 1) << "size " << size << ", instance " << chosen << ", of " << rays.size() << " rays";
        }
    }
}

TEST_F(Instances, HaveTheSurfacesOfTheirCopies) {
    Random random(33);
    for (const double scale : {1e-4, 1.0, 1e6}) {
        SCOPED_TRACE(scale);
        const Scene made = made_scene(random, scale, 60);
        const FlatScene flat = flatten(made);
        const Copies copies(made, flat);
        const auto rays = rays_at(copies, random, 20000);
        const auto outputs = run<gpu::SurfaceOutput>("surface", surface_words, flat, rays);
        std::vector<gpu::RayInput> leaving;
        std::vector<std::size_t> of;
        std::size_t smooth = 0, backs = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const gpu::SurfaceOutput& s = outputs[i];
            if (s.found != found_hit || s.instance == NO_INSTANCE) continue;
            const std::uint32_t triangle = copies.triangle(s.instance, s.triangle);
            const auto [a, b, c] = copies.corners(triangle);
            const glm::dvec3 n = copies.normal(triangle), d(rays[i].direction), p(s.position);
            const double cosine = std::abs(glm::dot(n, d));
            const std::string line = fmt::format("ray {} at instance {}, cosine {:.3g}, error {:.3g}", i, s.instance,
                                                 cosine, double(s.error));
            ASSERT_LE(std::abs(glm::dot(p - a, n)), s.error) << line << ": off its plane";
            ASSERT_LT(s.error, 2e-5) << line;
            ASSERT_LT(glm::length(glm::cross(p - glm::dvec3(rays[i].origin), d)), 4e-6 / cosine) << line;
            if (cosine > 1e-2) {
                const bool front = glm::dot(n, d) < 0.0;
                backs += !front;
                ASSERT_EQ(s.front != 0, front) << line;
                ASSERT_LT(glm::distance(glm::dvec3(s.geometric), front ? n : -n), 1e-4) << line;
                const glm::dvec3 cross = glm::cross(b - a, c - a);
                const double area = glm::dot(cross, cross);
                const double u = glm::dot(glm::cross(p - a, c - a), cross) / area;
                const double v = glm::dot(glm::cross(b - a, p - a), cross) / area;
                const auto& vertex = copies.scene.triangles[triangle].vertex;
                glm::dvec3 shading = glm::normalize((1.0 - u - v) * glm::dvec3(copies.scene.normals[vertex[0]]) +
                                                    u * glm::dvec3(copies.scene.normals[vertex[1]]) +
                                                    v * glm::dvec3(copies.scene.normals[vertex[2]]));
                if (!front) shading = -shading;
                // Rounding of the place on a small triangle, and of a normal of 16 bits an axis under a shear.
                const double condition = 1.0 + 1e-2 / std::sqrt(std::sqrt(area));
                if (glm::dot(shading, d) < -1e-2) {
                    ++smooth;
                    ASSERT_LT(glm::distance(glm::dvec3(s.normal), shading), 1e-3 * condition) << line;
                }
            }
            const glm::dvec3 facing(s.geometric);
            leaving.push_back({s.outside, glm::vec3(glm::normalize(facing + 0.999 * direction(random)))});
            leaving.push_back({s.inside, glm::vec3(glm::normalize(-facing + 0.999 * direction(random)))});
            of.insert(of.end(), 2, i);
        }
        EXPECT_GT(smooth, 1000u);
        EXPECT_GT(backs, 1000u);
        const auto next = trace(flat, leaving);
        std::size_t again = 0;
        for (std::size_t i = 0; i < next.size(); ++i) {
            again += next[i].found == found_hit && next[i].instance == outputs[of[i]].instance &&
                     next[i].triangle == outputs[of[i]].triangle;
        }
        EXPECT_EQ(again, 0u) << "of " << next.size() << " rays meet the triangle that they leave";
    }
}

TEST_F(Instances, AreFoundInSceneOfNothingElse) {
    Random random(34);
    Scene scene = made_scene(random, 1.0, 12);
    const auto world = std::uint32_t(world_triangles(scene).count());
    scene.triangles.erase(scene.triangles.begin(), scene.triangles.begin() + world);
    for (SharedMesh& mesh : scene.meshes) mesh.first_triangle -= world;
    scene.instances.resize(1);
    const FlatScene flat = flatten(scene);
    const Copies copies(scene, flat);
    const auto outputs = trace(flat, rays_at(copies, random, 1000));
    EXPECT_GT(std::ranges::count(outputs, found_hit, &gpu::RayOutput::found), 500);
}

TEST_F(Instances, TwoInOnePlaceAreOne) {
    Random random(35);
    Scene scene = made_scene(random, 1.0, 6);
    scene.instances.insert(scene.instances.end(), scene.instances.begin(), scene.instances.end());
    EXPECT_EQ(flatten(scene).instances.size(), 6u);
}

}  // namespace
}  // namespace vkcppm::test
