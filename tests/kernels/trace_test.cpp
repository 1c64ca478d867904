// Nearest hits against all triangles in double precision and against Embree.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <ranges>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "flat/flatten.h"
#include "kernels/probe.h"
#include "oracle/embree.h"
#include "oracle/intersect.h"
#include "support/device/gpu.h"
#include "support/device/trace_kernel.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

constexpr std::uint32_t occlusion_words[] = {
#include "occlusion.spv.inc"
};

// A ray passes an edge undecidably close within this distance, frame units: rounding of the intersection.
constexpr double edge_distance = 1e-6;

/// The triangles that the kernels see, in leaf order, as a scene for the oracle.
Scene as_uploaded(const FlatScene& flat) {
    Scene scene;
    scene.materials.emplace_back();
    for (const auto& t : flat.triangles) {
        const glm::dvec3 v0(t.v0);
        add_triangle(scene, v0, v0 + glm::dvec3(t.e1), v0 + glm::dvec3(t.e2), 0);
    }
    return scene;
}

/// Distance of the line of the ray to the nearest edge of a triangle, times how much of that edge's length is seen
/// along the ray: u and v are rounded relative to the determinant, so that edges seen end-on are the least certain.
double distance_to_edges(const Scene& scene, std::uint32_t triangle, const gpu::RayInput& ray) {
    const glm::dvec3 d = glm::normalize(glm::dvec3(ray.direction));
    double nearest = std::numeric_limits<double>::infinity();
    for (int c = 0; c < 3; ++c) {
        const auto across = [&](int corner) {
            const glm::dvec3 p = scene.positions[scene.triangles[triangle].vertex[corner]] - glm::dvec3(ray.origin);
            return p - glm::dot(p, d) * d;
        };
        const glm::dvec3 a = across(c), side = across((c + 1) % 3) - a;
        const double length2 = glm::dot(side, side);
        const double along = length2 > 0.0 ? std::clamp(-glm::dot(a, side) / length2, 0.0, 1.0) : 0.0;
        const auto& vertex = scene.triangles[triangle].vertex;
        const double length = glm::distance(scene.positions[vertex[c]], scene.positions[vertex[(c + 1) % 3]]);
        const double seen = length > 0.0 ? std::sqrt(length2) / length : 1.0;
        nearest = std::min(nearest, seen * glm::length(a + along * side));
    }
    return nearest;
}

/// Forward error of t in the Moeller-Trumbore form: roundings of products of size |s| |e1| |e2| over the determinant,
/// which is small for slivers and for grazing rays.
double t_bound(const FlatScene& flat, std::uint32_t triangle, const gpu::RayInput& ray, double t) {
    const gpu::TriangleGeometry& g = flat.triangles[triangle];
    const glm::dvec3 d(ray.direction), e1(g.e1), e2(g.e2), s = glm::dvec3(ray.origin) - glm::dvec3(g.v0);
    const double determinant = std::abs(glm::dot(d, glm::cross(e1, e2)));
    const double size = glm::length(e1) * glm::length(e2) * (glm::length(s) + t * glm::length(d));
    return 1e-9 + 5e-7 * size / determinant;
}

struct Answer {
    bool hit = false;
    double t = 0.0;
    std::uint32_t triangle = 0;
};

std::string text(const Answer& a) { return a.hit ? fmt::format("t {:.9g} in triangle {}", a.t, a.triangle) : "a miss"; }

/// True where the answers say the same, or where the ray passes so close to an edge of one of their triangles that
/// rounding decides; counts the latter in `undecided`.
bool agree(const FlatScene& flat, const Scene& scene, const gpu::RayInput& ray, const Answer& a, const Answer& b,
           std::size_t& undecided) {
    if (!a.hit && !b.hit) return true;
    if (a.hit && b.hit) {
        const double bound = t_bound(flat, a.triangle, ray, a.t) + t_bound(flat, b.triangle, ray, b.t);
        if (std::abs(a.t - b.t) <= bound) return true;
    }
    // Only the nearer answer can be at fault: the other one missed it.
    const Answer& nearer = !b.hit || (a.hit && a.t < b.t) ? a : b;
    if (distance_to_edges(scene, nearer.triangle, ray) > edge_distance) return false;
    ++undecided;
    return true;
}

/// Embree's, of a robust scene of these triangles.
class Embree {
public:
    explicit Embree(const Scene& scene) : embree_(corners_of(scene), true) {}
    Answer nearest(const gpu::RayInput& ray) const {
        const auto hit = embree_.nearest(ray.origin, ray.direction);
        return hit ? Answer{true, hit->t, hit->triangle} : Answer{};
    }

private:
    static std::vector<std::array<glm::vec3, 3>> corners_of(const Scene& scene) {
        std::vector<std::array<glm::vec3, 3>> corners;
        for (const Triangle& triangle : scene.triangles) {
            const auto corner = [&](int c) { return glm::vec3(scene.positions[triangle.vertex[c]]); };
            corners.push_back({corner(0), corner(1), corner(2)});
        }
        return corners;
    }

    oracle::Embree embree_;
};

class Trace : public GpuTest {
protected:
    std::vector<gpu::RayOutput> trace(const FlatScene& flat, const std::vector<gpu::RayInput>& rays,
                                      std::uint32_t node_bits = 20) {
        Probe probe("trace", trace_words, flat.bvh.stack, ~0u, node_bits);
        probe.input(Binding::nodes, flat.bvh.nodes);
        probe.input(Binding::triangles, flat.triangles);
        probe.input(PROBE_INPUT, rays);
        probe.output<gpu::RayOutput>(PROBE_OUTPUT, rays.size());
        probe.run(rays.size(),
                  {.iteration = 0, .last_round = 0, .argument = step_budget, .items = std::uint32_t(rays.size())});
        return probe.result<gpu::RayOutput>(PROBE_OUTPUT, rays.size());
    }

    std::vector<std::uint32_t> occlusion(const FlatScene& flat, const std::vector<gpu::OcclusionInput>& rays) {
        Probe probe("occlusion", occlusion_words, flat.bvh.stack);
        probe.input(Binding::nodes, flat.bvh.nodes);
        probe.input(Binding::triangles, flat.triangles);
        probe.input(PROBE_INPUT, rays);
        probe.output<std::uint32_t>(PROBE_OUTPUT, rays.size());
        probe.run(rays.size(), {.argument = step_budget, .items = std::uint32_t(rays.size())});
        return probe.result<std::uint32_t>(PROBE_OUTPUT, rays.size());
    }
};

using Random = std::mt19937;

double uniform(Random& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}
glm::dvec3 in_box(Random& random, double half) {
    return {uniform(random, -half, half), uniform(random, -half, half), uniform(random, -half, half)};
}

struct Soup {
    std::string name;
    int triangles;
    std::function<void(Scene&, int, Random&)> add;  // triangle number i
};

void add_random(Scene& scene, Random& random, double size) {
    const glm::dvec3 centre = in_box(random, 1.0);
    add_triangle(scene, centre + in_box(random, size), centre + in_box(random, size), centre + in_box(random, size), 0);
}

std::vector<Soup> soups() {
    const auto random_triangles = [](double size) {
        return [=](Scene& scene, int, Random& random) { add_random(scene, random, size); };
    };
    const auto slivers = [](Scene& scene, int i, Random& random) {
        const glm::dvec3 a = in_box(random, 1.0), b = in_box(random, 1.0);
        add_triangle(scene, a, b, 0.5 * (a + b) + in_box(random, 1.0) * std::pow(10.0, -(i % 5)), 0);
    };
    const auto degenerate = [](Scene& scene, int i, Random& random) {
        const glm::dvec3 a = in_box(random, 1.0), b = in_box(random, 1.0);
        if (i % 3 == 0) add_random(scene, random, 0.4);
        if (i % 3 == 1) add_triangle(scene, a, b, 0.5 * (a + b), 0);
        if (i % 3 == 2) add_triangle(scene, a, a, a, 0);
    };
    const auto flat = [](Scene& scene, int i, Random& random) {
        // Axis-aligned, on a lattice: boxes without thickness, shared planes, rays in planes.
        const auto lattice = [&] { return std::round(uniform(random, -8.0, 8.0)) / 8.0; };
        glm::dvec3 corner(lattice(), lattice(), lattice()), u(0.0), v(0.0);
        u[(i + 1) % 3] = 0.25;
        v[(i + 2) % 3] = 0.25;
        add_triangle(scene, corner, corner + u, corner + v, 0);
    };
    const auto coincident = [](Scene& scene, int i, Random& random) {
        if (i % 4 == 0) return add_random(scene, random, 0.5);
        const auto& v = scene.triangles.back().vertex;
        add_triangle(scene, scene.positions[v[1]], scene.positions[v[2]], scene.positions[v[0]], 0);
    };
    const auto huge_and_tiny = [](Scene& scene, int i, Random& random) {
        add_random(scene, random, i % 10 == 0 ? 1.0 : 1e-3);
    };
    const auto one_place = [](Scene& scene, int, Random&) {
        add_triangle(scene, {-0.5, -0.5, 0.1}, {0.5, -0.5, 0.0}, {0.0, 0.5, -0.1}, 0);
    };
    return {{"one", 1, random_triangles(0.8)},
            {"two", 2, random_triangles(0.8)},
            {"five", 5, random_triangles(0.8)},
            {"few", 60, random_triangles(0.5)},
            {"many", 2000, random_triangles(0.1)},
            {"overlapping", 500, random_triangles(0.8)},
            {"slivers", 300, slivers},
            {"degenerate", 300, degenerate},
            {"flat", 400, flat},
            {"coincident", 400, coincident},
            {"huge and tiny", 1000, huge_and_tiny},
            {"all in one place", 50, one_place}};
}

Scene made(const Soup& soup, Random& random) {
    Scene scene;
    add_material(scene, lambert(glm::vec3(0.5f)));
    for (int i = 0; i < soup.triangles; ++i) soup.add(scene, i, random);
    return scene;
}

/// Rays of every sort at the triangles: random, along axes with components of either zero, from a triangle's own
/// plane, grazing, parallel, at vertices and at edges.
std::vector<gpu::RayInput> rays_at(const Scene& scene, Random& random, std::size_t count) {
    std::vector<gpu::RayInput> rays;
    const auto pick = [&] { return std::uniform_int_distribution<std::size_t>(0, scene.triangles.size() - 1)(random); };
    const auto corner = [&](std::size_t triangle, int c) {
        return scene.positions[scene.triangles[triangle].vertex[c]];
    };
    while (rays.size() < count) {
        const std::size_t triangle = pick();
        const glm::dvec3 a = corner(triangle, 0), b = corner(triangle, 1), c = corner(triangle, 2);
        const double u = uniform(random, 0.0, 1.0), v = uniform(random, 0.0, 1.0 - u);
        const glm::dvec3 inside = a + u * (b - a) + v * (c - a);
        glm::dvec3 origin = in_box(random, 1.5), target = inside;
        glm::dvec3 direction(0.0);
        switch (rays.size() % 8) {
            case 0: target = in_box(random, 1.0); break;
            case 1: break;  // at a random point of a triangle
            case 2: {       // along an axis, with zeros of either sign
                const int axis = int(rays.size() / 8 % 3);
                const double sign = rays.size() / 24 % 2 == 0 ? 1.0 : -1.0;
                direction = glm::dvec3(rays.size() / 48 % 2 == 0 ? 0.0 : -0.0);
                direction[axis] = sign;
                origin = inside - 2.0 * direction;
                break;
            }
            case 3: {  // one zero component
                direction = in_box(random, 1.0);
                direction[int(rays.size() / 8 % 3)] = 0.0;
                origin = inside - direction;
                break;
            }
            case 4: {  // grazing: a little off the plane
                const glm::dvec3 across = glm::cross(b - a, c - a);
                const double area = glm::length(across);
                const glm::dvec3 along = (b - a) + uniform(random, -1.0, 1.0) * (c - a);
                direction = along + (area > 0.0 ? 1e-3 * glm::length(along) / area : 0.0) * across;
                origin = inside - direction;
                break;
            }
            case 5: direction = (b - a) + uniform(random, -1.0, 1.0) * (c - a); break;  // parallel, from elsewhere
            case 6: target = corner(triangle, int(rays.size() / 8 % 3)); break;         // at a vertex
            case 7: target = a + u * (b - a); break;                                    // at an edge
        }
        if (direction == glm::dvec3(0.0)) direction = target - origin;
        if (!(glm::length(direction) > 1e-9)) direction = {0.0, 0.0, 1.0};
        rays.push_back({glm::vec3(origin), glm::vec3(glm::normalize(direction))});
    }
    return rays;
}

TEST_F(Trace, FindsTheNearestHitThatAllTrianglesHave) {
    Random random(10);
    for (const Soup& soup : soups()) {
        SCOPED_TRACE(soup.name);
        const FlatScene flat = flatten(made(soup, random));
        const Scene scene = as_uploaded(flat);
        const Embree embree(scene);
        const auto rays = rays_at(scene, random, 4000);
        const auto outputs = trace(flat, rays);
        std::size_t hits = 0, undecided = 0, undecided_by_embree = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ASSERT_NE(outputs[i].found, found_unfinished) << "ray " << i;
            const Answer got{outputs[i].found == found_hit, outputs[i].t, outputs[i].triangle};
            const auto exact = oracle::nearest_hit(scene, {glm::dvec3(rays[i].origin), glm::dvec3(rays[i].direction)});
            const Answer want = exact ? Answer{true, exact->t, exact->triangle} : Answer{};
            const Answer other = embree.nearest(rays[i]);
            const auto ray_text = [&] {
                return fmt::format("ray {} from ({:.9g}, {:.9g}, {:.9g}) along ({:.9g}, {:.9g}, {:.9g})", i,
                                   rays[i].origin.x, rays[i].origin.y, rays[i].origin.z, rays[i].direction.x,
                                   rays[i].direction.y, rays[i].direction.z);
            };
            ASSERT_TRUE(agree(flat, scene, rays[i], got, want, undecided))
                << ray_text() << ": got " << text(got) << ", exact " << text(want) << ", Embree " << text(other)
                << "; distance to edges "
                << distance_to_edges(scene, (got.hit && (!want.hit || got.t < want.t) ? got : want).triangle, rays[i]);
            ASSERT_TRUE(agree(flat, scene, rays[i], got, other, undecided_by_embree))
                << ray_text() << ": got " << text(got) << ", Embree " << text(other) << ", exact " << text(want);
            if (!got.hit) continue;
            ++hits;
            // Barycentrics: the point that they give is the ray's, within the bound of t and of rounding.
            const gpu::TriangleGeometry& g = flat.triangles[got.triangle];
            const glm::dvec3 point = glm::dvec3(g.v0) + double(outputs[i].barycentric.x) * glm::dvec3(g.e1) +
                                     double(outputs[i].barycentric.y) * glm::dvec3(g.e2);
            const double off =
                glm::length(glm::cross(point - glm::dvec3(rays[i].origin), glm::dvec3(rays[i].direction)));
            ASSERT_LT(off, 2.0 * t_bound(flat, got.triangle, rays[i], got.t) + 1e-6) << ray_text() << ": " << text(got);
        }
        EXPECT_GT(hits, rays.size() / 20) << "too few hits to mean anything";
        // Half of the rays aim at vertices and edges or lie in planes; of the others few come near one.
        EXPECT_LT(undecided, rays.size() / 3);
        RecordProperty(soup.name + " undecided", int(undecided));
    }
}

TEST_F(Trace, AnEmptySceneIsMissed) {
    Scene scene;
    add_material(scene, lambert(glm::vec3(0.5f)));
    for (const auto& output : trace(flatten(scene), {{{0, 0, 0}, {0, 0, 1}}, {{1, 2, 3}, {0, -1, 0}}})) {
        EXPECT_EQ(output.found, 0u);
    }
}

TEST_F(Trace, ClosedMeshesLetNothingOut) {
    const auto sphere = [](int levels) {
        Scene scene;
        add_sphere(scene, {0.3, -0.2, 0.1}, 1.0, levels, add_material(scene, lambert(glm::vec3(0.5f))), false);
        return scene;
    };
    Scene cube;
    add_box(cube, {-1, -0.5, -0.7}, {1, 0.8, 0.9}, add_material(cube, lambert(glm::vec3(0.5f))), true);
    Scene turned = cube;
    for (glm::dvec3& p : turned.positions) {
        p = glm::dvec3(0.6 * p.x - 0.8 * p.y, 0.8 * p.x + 0.6 * p.y, p.z);
        p = glm::dvec3(p.x, 0.28 * p.y - 0.96 * p.z, 0.96 * p.y + 0.28 * p.z);
    }
    for (const auto& [name, made] :
         {std::pair("icosphere of 1280 triangles", sphere(3)), std::pair("icosphere of 20480 triangles", sphere(5)),
          std::pair("cube", cube), std::pair("turned cube", turned)}) {
        const FlatScene flat = flatten(made);
        const Scene scene = as_uploaded(flat);
        Random random(11);
        std::vector<gpu::RayInput> rays;
        const glm::dvec3 centre = 0.5 * (glm::dvec3(flat.low) + glm::dvec3(flat.high));
        while (rays.size() < 100000) {
            const auto triangle = std::uniform_int_distribution<std::size_t>(0, scene.triangles.size() - 1)(random);
            const auto& v = scene.triangles[triangle].vertex;
            const glm::dvec3 a = scene.positions[v[0]], b = scene.positions[v[1]];
            const glm::vec3 origin(centre + in_box(random, 0.09));  // inside the smallest of the meshes
            glm::dvec3 target = origin + glm::vec3(in_box(random, 1.0));
            if (rays.size() % 4 == 1) target = a;
            if (rays.size() % 4 == 2) target = 0.5 * (a + b);
            if (rays.size() % 4 == 3) target = glm::mix(a, b, uniform(random, 0.0, 1.0));
            rays.push_back({origin, glm::vec3(glm::normalize(target - glm::dvec3(origin)))});
        }
        const auto outputs = trace(flat, rays);
        std::size_t escaped = 0;
        std::array<std::size_t, 4> by_sort{};
        std::string first;
        int longest = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            longest = std::max(longest, outputs[i].steps);
            if (outputs[i].found == found_hit) continue;
            ++by_sort[i % 4];
            if (escaped++ == 0) {
                first =
                    fmt::format("first: ray {} of sort {} from ({:.9g}, {:.9g}, {:.9g}) along ({:.9g}, {:.9g}, {:.9g})",
                                i, i % 4, rays[i].origin.x, rays[i].origin.y, rays[i].origin.z, rays[i].direction.x,
                                rays[i].direction.y, rays[i].direction.z);
            }
        }
        EXPECT_LE(escaped, 2u) << name << ", of " << rays.size() << " rays (" << by_sort[0] << " random, " << by_sort[1]
                               << " at vertices, " << by_sort[2] << " at middles of edges, " << by_sort[3]
                               << " at edges); " << first;
        EXPECT_LT(longest, 500) << name << ": steps of the longest ray";
    }
}

// Rays to lights: whether anything is in the way, before the light and but for the light itself.
TEST_F(Trace, FindsWhetherThereIsAnythingOnTheWay) {
    Random random(14);
    for (const Soup& soup : soups()) {
        SCOPED_TRACE(soup.name);
        const FlatScene flat = flatten(made(soup, random));
        const Scene scene = as_uploaded(flat);
        const auto rays = rays_at(scene, random, 2000);
        std::vector<gpu::OcclusionInput> inputs;
        for (const auto& ray : rays) {
            const auto nearest = oracle::nearest_hit(scene, {glm::dvec3(ray.origin), glm::dvec3(ray.direction)});
            const bool leaves_out = nearest && inputs.size() % 2 == 0;
            const double within =
                inputs.size() % 3 == 0 ? 1e30 : (nearest ? nearest->t : 1.0) * uniform(random, 0.5, 2);
            inputs.push_back({ray.origin, ray.direction, float(within), leaves_out ? nearest->triangle : NO_TRIANGLE});
        }
        const auto found = occlusion(flat, inputs);
        std::size_t blocked = 0, undecided = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ASSERT_NE(found[i], found_unfinished) << "ray " << i;
            bool certain = false, near = false;  // that something is there, or is but for rounding
            for (std::uint32_t triangle = 0; triangle < scene.triangles.size(); ++triangle) {
                if (triangle == inputs[i].but) continue;
                const auto hit =
                    oracle::intersect(scene, triangle, {glm::dvec3(rays[i].origin), glm::dvec3(rays[i].direction)});
                if (!hit) continue;
                const double bound = t_bound(flat, triangle, rays[i], hit->t);
                near = near || hit->t < inputs[i].within + bound;
                certain = certain || (hit->t < inputs[i].within - bound && hit->t > bound &&
                                      distance_to_edges(scene, triangle, rays[i]) > edge_distance);
            }
            const bool got = found[i] == found_hit;
            blocked += got;
            if (got == certain) continue;
            ++undecided;
            ASSERT_TRUE(got) << "ray " << i << " missed what is before " << inputs[i].within;
            const auto touches = [&](std::uint32_t triangle) {
                return distance_to_edges(scene, triangle, rays[i]) <= edge_distance;
            };
            ASSERT_TRUE(near ||
                        std::ranges::any_of(std::views::iota(0u, std::uint32_t(scene.triangles.size())), touches))
                << "ray " << i << " met something before " << inputs[i].within << " where nothing is";
        }
        EXPECT_GT(blocked, rays.size() / 20) << "too few to mean anything";
        EXPECT_LT(undecided, rays.size() / 3);
    }
}

// The larger the tree, the fewer bits are left for the distance of what waits: less is skipped, the answer is the same.
TEST_F(Trace, TheAnswerDoesNotDependOnTheSizeOfAReference) {
    Random random(13);
    Scene scene;
    scene.materials.emplace_back();
    for (int i = 0; i < 3000; ++i) add_random(scene, random, 0.1);
    const FlatScene flat = flatten(scene);
    std::vector<gpu::RayInput> rays(4000);
    for (auto& ray : rays) ray = {glm::vec3(in_box(random, 0.5)), glm::vec3(glm::normalize(in_box(random, 1.0)))};
    const auto bits = std::uint32_t(std::bit_width(flat.bvh.nodes.size() - 1));
    const auto fine = trace(flat, rays, bits);
    std::uint64_t fine_steps = 0, coarse_steps = 0;
    for (const std::uint32_t coarser : {bits + 4, std::uint32_t(BVH_MAX_NODE_BITS)}) {
        const auto coarse = trace(flat, rays, coarser);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ASSERT_EQ(fine[i].found, coarse[i].found) << "ray " << i << ", " << coarser << " bits";
            ASSERT_EQ(fine[i].t, coarse[i].t) << "ray " << i << ", " << coarser << " bits";
            fine_steps += std::uint64_t(fine[i].steps);
            coarse_steps += std::uint64_t(coarse[i].steps);
        }
    }
    EXPECT_LT(fine_steps, coarse_steps) << "distances spare steps";
}

TEST_F(Trace, OutOfStepsSaysSo) {
    Scene scene;
    add_sphere(scene, {0, 0, 0}, 1.0, 4, add_material(scene, lambert(glm::vec3(0.5f))), false);
    const FlatScene flat = flatten(scene);
    Probe probe("trace", trace_words, flat.bvh.stack);
    probe.input(Binding::nodes, flat.bvh.nodes);
    probe.input(Binding::triangles, flat.triangles);
    Random random(12);
    std::vector<gpu::RayInput> rays(2000);
    for (auto& ray : rays) ray = {glm::vec3(in_box(random, 0.2)), glm::vec3(glm::normalize(in_box(random, 1.0)))};
    probe.input(PROBE_INPUT, rays);
    probe.output<gpu::RayOutput>(PROBE_OUTPUT, rays.size());
    const auto run = [&](std::uint32_t steps) {
        probe.run(rays.size(),
                  {.iteration = 0, .last_round = 0, .argument = steps, .items = std::uint32_t(rays.size())});
        return probe.result<gpu::RayOutput>(PROBE_OUTPUT, rays.size());
    };
    const auto whole = run(step_budget);
    for (const std::uint32_t steps : {0u, 1u, 5u, 20u, 40u}) {
        const auto cut = run(steps);
        std::size_t unfinished = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if (cut[i].found == found_unfinished) {
                ++unfinished;
                ASSERT_GT(whole[i].steps, int(steps)) << "ray " << i << " had steps enough";
                continue;
            }
            // A finished ray has the same answer; it may overdraw its budget by the height of the stack and a leaf.
            ASSERT_EQ(cut[i].t, whole[i].t) << "ray " << i << " with " << steps << " steps";
            ASSERT_EQ(cut[i].triangle, whole[i].triangle) << "ray " << i << " with " << steps << " steps";
            ASSERT_LE(cut[i].steps, int(steps + flat.bvh.stack) + 10) << "ray " << i;
        }
        if (steps <= 1) {
            EXPECT_EQ(unfinished, rays.size()) << steps << " steps";
        }
    }
}

}  // namespace
}  // namespace vkcppm::test
