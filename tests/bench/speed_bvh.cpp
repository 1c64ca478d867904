// The BVH's build on the host, and how good the tree is.

#include <algorithm>
#include <numeric>

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include "bench/speed.h"
#include "flat/bvh.h"

namespace vkcppm::bench {
namespace {

double area(const BvhBox& box) {
    const glm::dvec3 d = glm::dvec3(box.high) - glm::dvec3(box.low);
    return 2.0 * (d.x * d.y + d.y * d.z + d.z * d.x);
}

/// What a random line that meets the root's box meets in the mean: nodes and triangles (surface area heuristic), by the
/// boxes as kernels see them.
struct Cost {
    double nodes = 1.0;
    double triangles = 0.0;
};
Cost cost_of(const Bvh& bvh) {
    Cost cost;
    BvhBox root;
    for (int c = 0; c < 4; ++c) {
        const BvhChild child = child_of(bvh, 0, c);
        if (child.node == 0 && child.count == 0) continue;
        const BvhBox box = child_box(bvh.nodes[0], c);
        root.low = c == 0 ? box.low : glm::min(root.low, box.low);
        root.high = c == 0 ? box.high : glm::max(root.high, box.high);
    }
    for (std::uint32_t index = 0; index < bvh.nodes.size(); ++index) {
        for (int c = 0; c < 4; ++c) {
            const BvhChild child = child_of(bvh, index, c);
            if (child.node == 0 && child.count == 0) continue;
            const double probability = area(child_box(bvh.nodes[index], c)) / area(root);
            cost.nodes += child.node != 0 ? probability : 0.0;
            cost.triangles += probability * child.count;
        }
    }
    return cost;
}

/// The corners of the triangles in the order of the scene, in which flatten() hands them to the builder.
std::vector<std::array<glm::vec3, 3>> in_order(const FlatScene& flat) {
    const auto of_leaves = corners_of(flat);
    std::vector<std::uint32_t> places(of_leaves.size());
    std::iota(places.begin(), places.end(), 0u);
    std::ranges::sort(places, {}, [&](std::uint32_t place) { return flat.bvh.order[place]; });
    std::vector<std::array<glm::vec3, 3>> corners;
    for (const std::uint32_t place : places) corners.push_back(of_leaves[place]);
    return corners;
}

}  // namespace

Table bench_bvh(const Bench& bench) {
    Table table{
        "bvh",
        "Building the BVH, and what the scene takes in all until it can be uploaded, seconds by the clock; nodes and "
        "triangles that a random line meets by the surface area heuristic.",
        {"scene", "triangles", "threads", "build s", "build, CPU s", "flatten s", "nodes", "line: nodes",
         "line: triangles"},
        {}};
    for (const std::uint32_t triangles : {1000u, 50000u, 500000u}) {
        for (const auto& [name, scene] :
             {std::pair("bumpy spheres", bumpy_room(triangles)), std::pair("soup", soup(triangles))}) {
            const FlatScene flat = flatten(scene);
            const Cost cost = cost_of(flat.bvh);
            const std::vector<std::array<glm::vec3, 3>> corners = in_order(flat);
            std::vector<Seconds> build(bench.workers.size()), whole(bench.workers.size());
            for (int run = 0; run < bench.runs; ++run) {
                for (std::size_t w = 0; w < bench.workers.size(); ++w) {
                    tbb::task_arena(int(bench.workers[w].threads)).execute([&] {
                        build[w].keep(time_of([&] { build_bvh(corners); }));
                        whole[w].keep(time_of([&] { flatten(scene); }));
                    });
                }
            }
            for (std::size_t w = 0; w < bench.workers.size(); ++w) {
                table.rows.push_back({name, corners.size(), bench.workers[w].threads, build[w].device, build[w].cpu,
                                      whole[w].device, flat.bvh.nodes.size(), cost.nodes, cost.triangles});
            }
        }
    }
    return table;
}

}  // namespace vkcppm::bench
