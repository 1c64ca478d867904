// The tree on the host: it holds every triangle once, its boxes hold what is below them, its stack bound is enough.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "flat/bvh.h"

namespace vkcppm {
namespace {

using TriangleList = std::vector<std::array<glm::vec3, 3>>;

TriangleList random_triangles(std::size_t count, float size, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> place(-0.8f, 0.8f), offset(-size, size);
    TriangleList triangles(count);
    for (auto& triangle : triangles) {
        const glm::vec3 centre(place(random), place(random), place(random));
        for (auto& corner : triangle) corner = centre + glm::vec3(offset(random), offset(random), offset(random));
    }
    return triangles;
}

/// What a walk over the whole tree meets.
struct Walk {
    std::vector<int> times;   // [triangles] leaves that hold it
    int depth = 0;            // four-wide nodes on the longest path
    std::uint32_t stack = 0;  // nodes of which children wait in the worst case, while the nearest child is entered
    std::size_t leaves = 0;
};

/// Checks the subtree of a node; returns the entries that a traversal of it can need.
std::uint32_t walk_node(const Bvh& bvh, const TriangleList& triangles, std::uint32_t index, int depth, Walk& walk,
                        std::vector<std::uint32_t>& below) {
    EXPECT_LT(index, bvh.nodes.size());
    EXPECT_LE(depth, 64) << "the tree does not end";
    if (depth > 64 || testing::Test::HasFatalFailure()) return 0;
    walk.depth = std::max(walk.depth, depth);
    const gpu::BvhNode& node = bvh.nodes[index];
    std::uint32_t children = 0, deepest = 0;
    for (int c = 0; c < 4; ++c) {
        const BvhChild child = child_of(bvh, index, c);
        if (child.node == 0 && child.count == 0) continue;
        ++children;
        std::vector<std::uint32_t> inside;
        if (child.node == 0) {
            ++walk.leaves;
            const std::uint32_t end = child.first + child.count;
            EXPECT_LE(child.count, std::uint32_t(BVH_MAX_LEAF)) << "triangles in a leaf";
            EXPECT_LE(end, bvh.order.size());
            for (std::uint32_t i = child.first; i < std::min<std::uint32_t>(end, bvh.order.size()); ++i) {
                inside.push_back(bvh.order[i]);
                ++walk.times[bvh.order[i]];
            }
        } else {
            EXPECT_GT(child.node, index) << "a node before those below it";
            deepest = std::max(deepest, walk_node(bvh, triangles, child.node, depth + 1, walk, inside));
        }
        const BvhBox box = child_box(node, c);
        for (const std::uint32_t triangle : inside) {
            for (const glm::vec3& corner : triangles[triangle]) {
                for (int axis = 0; axis < 3; ++axis) {
                    if (corner[axis] >= box.low[axis] && corner[axis] <= box.high[axis]) continue;
                    ADD_FAILURE() << "triangle " << triangle << " reaches " << corner[axis] << " on axis " << axis
                                  << ", child " << c << " of node " << index << " ends at " << box.low[axis] << " and "
                                  << box.high[axis];
                }
            }
        }
        below.insert(below.end(), inside.begin(), inside.end());
    }
    return deepest + (children > 1 ? 1 : 0);
}

Walk check(const TriangleList& triangles) {
    const Bvh bvh = build_bvh(triangles);
    Walk walk;
    walk.times.resize(triangles.size());
    EXPECT_EQ(bvh.order.size(), triangles.size());
    EXPECT_GE(bvh.nodes.size(), 1u);
    std::vector<std::uint32_t> all;
    walk.stack = walk_node(bvh, triangles, 0, 1, walk, all);
    EXPECT_GE(bvh.stack, walk.stack) << "entries that the worst ray needs";
    EXPECT_LE(bvh.stack, std::max(1u, walk.stack)) << "the bound is to be exact: it costs registers";
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        EXPECT_EQ(walk.times[i], 1) << "leaves with triangle " << i << " of " << triangles.size();
        if (walk.times[i] != 1) break;
    }
    return walk;
}

TEST(Bvh, HoldsEveryTriangleOnceInsideItsBoxes) {
    for (const std::size_t count : {0, 1, 2, 3, 4, 5, 8, 9, 100, 3000}) {
        SCOPED_TRACE(count);
        check(random_triangles(count, 0.1f, std::uint32_t(count) + 1));
    }
    check(random_triangles(20000, 0.005f, 1));
    check(random_triangles(500, 0.19f, 2));
}

TEST(Bvh, HoldsFlatThinAndFarTriangles) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> place(-1.0f, 1.0f);
    TriangleList flat = random_triangles(1000, 0.05f, 4);
    for (std::size_t i = 0; i < flat.size(); ++i) {
        for (auto& corner : flat[i]) corner[int(i % 3)] = i % 2 == 0 ? 0.25f : 1.0f;  // planes, one at the very end
    }
    check(flat);
    TriangleList points(300), mixed = random_triangles(1000, 1e-6f, 5);
    for (auto& triangle : points) triangle.fill(glm::vec3(place(random), place(random), place(random)));
    check(points);
    for (std::size_t i = 0; i < mixed.size(); i += 50) {
        for (auto& corner : mixed[i]) corner = glm::vec3(place(random), place(random), place(random));
    }
    check(mixed);
}

TEST(Bvh, IdenticalTrianglesEndInABoundedDepth) {
    const std::size_t count = 100000;
    const Walk walk = check(
        TriangleList(count, {glm::vec3(0.1f, 0.2f, 0.3f), glm::vec3(0.2f, 0.2f, 0.3f), glm::vec3(0.1f, 0.4f, 0.3f)}));
    // Halves by count: 2^17 > 10^5, so the binary tree has at most 17 levels, and a node waits with three children.
    EXPECT_LE(walk.depth, 17);
    EXPECT_LE(walk.stack, 3u * 17u);
}

TEST(Bvh, AGeometricRowDoesNotBecomeAList) {
    // Centres at 2^-i: each split by area cuts off one triangle, until halves by count take over.
    TriangleList row;
    for (int i = 0; i < 3000; ++i) {
        const float x = std::ldexp(1.0f, -(i % 100)), size = 0.1f * x;
        row.push_back({glm::vec3(x, 0, 0), glm::vec3(x + size, size, 0), glm::vec3(x, 0, size)});
    }
    const Walk walk = check(row);
    EXPECT_LE(walk.depth, 40);
}

TEST(Bvh, BuildsTheSameTreeOnAnyNumberOfThreads) {
    const TriangleList triangles = random_triangles(30000, 0.02f, 6);
    const Bvh first = build_bvh(triangles);
    for (const int threads : {1, 2, 3, 8, 8, 8}) {
        Bvh again;
        tbb::task_arena(threads).execute([&] { again = build_bvh(triangles); });
        ASSERT_EQ(again.order, first.order) << threads << " threads";
        ASSERT_EQ(again.stack, first.stack) << threads << " threads";
        ASSERT_EQ(again.nodes.size(), first.nodes.size()) << threads << " threads";
        ASSERT_EQ(std::memcmp(again.nodes.data(), first.nodes.data(), first.nodes.size() * sizeof(gpu::BvhNode)), 0)
            << threads << " threads";
    }
}

}  // namespace
}  // namespace vkcppm
