#include "flat/light_tree.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/parallel_invoke.h>

#include "flat/direction.h"

namespace vkcppm {
namespace {

using std::numbers::pi;

constexpr int buckets = 12;                   // an axis
constexpr std::uint32_t deepest_choice = 64;  // below it lamps are split in halves
constexpr std::size_t least_parallel = 4096;  // lamps of a branch whose halves are built side by side
constexpr double widening = 3e-4;             // of cones, radians: more than packing turns an axis
constexpr double widest_ratio = 1e12;         // of the intensities of two children: the weaker is found, too

/// What the cost of a split is computed from.
struct Cluster {
    glm::vec3 low{std::numeric_limits<float>::infinity()};
    glm::vec3 high{-std::numeric_limits<float>::infinity()};
    glm::dvec3 axes{0.0};  // sum, those of lamps that shine on both sides turned to one
    double spread = 0.0;   // largest
    double falloff = 0.0;
    double intensity = 0.0;
    double count = 0.0;

    void add(const Cluster& c) {
        low = glm::min(low, c.low);
        high = glm::max(high, c.high);
        axes += c.axes;
        spread = std::max(spread, c.spread);
        falloff = std::max(falloff, c.falloff);
        intensity += c.intensity;
        count += c.count;
    }

    double diagonal2() const {
        const glm::dvec3 extent = glm::dvec3(high) - glm::dvec3(low);
        return glm::dot(extent, extent);
    }

    /// Solid angle into which it shines, weighed by the cosine beyond the cone of normals; that cone is the one whose
    /// normals, spread evenly, have this mean: a bounding cone would hang on the worst of thousands.
    double orientation() const {
        const double mean = std::min(1.0, glm::length(axes) / count);
        const double cone = std::min(pi, std::acos(std::clamp(2.0 * mean - 1.0, -1.0, 1.0)) + spread);
        const double whole = std::min(pi, cone + falloff);
        return 2.0 * pi * (1.0 - std::cos(cone)) + 0.5 * pi *
                                                       (2.0 * whole * std::sin(cone) - std::cos(cone - 2.0 * whole) -
                                                        2.0 * cone * std::sin(cone) + std::cos(cone));
    }

    double cost() const { return intensity * orientation() * diagonal2(); }
};

class LightTreeBuilder {
public:
    LightTreeBuilder(std::span<const Lamp> lamps, LightTree& tree) : lamps_(lamps), tree_(tree), order_(lamps.size()) {
        std::iota(order_.begin(), order_.end(), 0u);
    }

    void build() { tree_.depth = build_branch(order_, 0, NO_LAMP, 0); }

private:
    using Lamps = std::span<std::uint32_t>;

    glm::vec3 centre_of(std::uint32_t lamp) const { return 0.5f * (lamps_[lamp].low + lamps_[lamp].high); }

    /// towards: to which axes of both sides are turned.
    Cluster cluster_of(std::uint32_t lamp, const glm::vec3& towards) const {
        const Lamp& l = lamps_[lamp];
        const bool turns = l.both_sides && glm::dot(l.axis, towards) < 0.0f;
        return {l.low, l.high, glm::dvec3(turns ? -l.axis : l.axis), l.spread, l.falloff, l.intensity, 1.0};
    }

    /// The lamps of a branch, at most 2^31, into two; returns how many are of the first.
    std::size_t split(Lamps lamps, std::uint32_t depth) const {
        if (lamps.size() == 2) return 1;
        glm::vec3 low(std::numeric_limits<float>::infinity()), high(-low);
        for (const std::uint32_t lamp : lamps) {
            low = glm::min(low, centre_of(lamp));
            high = glm::max(high, centre_of(lamp));
        }
        const glm::vec3 extent = high - low;
        const float longest = std::max({extent.x, extent.y, extent.z});
        if (!(longest > 0.0f) || depth >= deepest_choice) return lamps.size() / 2;
        const auto bucket_of = [&](std::uint32_t lamp, int axis) {
            const float place = (centre_of(lamp)[axis] - low[axis]) / extent[axis];
            return std::clamp(int(place * float(buckets)), 0, buckets - 1);
        };
        const glm::vec3 towards = lamps_[lamps.front()].axis;
        std::array<std::array<Cluster, buckets>, 3> clusters{};
        for (const std::uint32_t lamp : lamps) {
            const Cluster cluster = cluster_of(lamp, towards);
            for (int axis = 0; axis < 3; ++axis) {
                if (extent[axis] > 0.0f) clusters[axis][bucket_of(lamp, axis)].add(cluster);
            }
        }
        double least = std::numeric_limits<double>::infinity();
        int best_axis = -1, best_bucket = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const std::array<Cluster, buckets>& of = clusters[axis];
            std::array<Cluster, buckets> after{};
            after[buckets - 1] = of[buckets - 1];
            for (int b = buckets - 2; b > 0; --b) {
                after[b] = of[b];
                after[b].add(after[b + 1]);
            }
            Cluster before;
            for (int b = 1; b < buckets; ++b) {
                if (of[b - 1].count == 0.0) continue;  // as the one before
                before.add(of[b - 1]);
                if (after[b].count == 0.0) break;
                // Rather across the long side.
                const double cost = (before.cost() + after[b].cost()) * double(longest / extent[axis]);
                if (cost < least) {
                    least = cost;
                    best_axis = axis;
                    best_bucket = b;
                }
            }
        }
        if (best_axis < 0) return lamps.size() / 2;
        const auto second = std::stable_partition(
            lamps.begin(), lamps.end(), [&](std::uint32_t lamp) { return bucket_of(lamp, best_axis) < best_bucket; });
        return std::size_t(second - lamps.begin());
    }

    /// Bounds of a child; returns its intensity.
    double bound(Lamps lamps, gpu::LightBranch& branch, int child) const {
        const glm::vec3 towards = lamps_[lamps.front()].axis;
        Cluster whole;
        bool both_sides = false;
        float reach = 0.0f;
        for (const std::uint32_t lamp : lamps) {
            whole.add(cluster_of(lamp, towards));
            both_sides = both_sides || lamps_[lamp].both_sides;
            reach = std::max(reach, lamps_[lamp].reach);
        }
        const glm::vec3 centre = 0.5f * (whole.low + whole.high);
        const double length = glm::length(whole.axes);
        const glm::dvec3 axis = length > 0.0 ? whole.axes / length : glm::dvec3(0.0, 0.0, 1.0);
        double radius2 = 0.0, cone = 0.0, least_cosine = 1.0;
        for (const std::uint32_t lamp : lamps) {
            const Lamp& l = lamps_[lamp];
            const glm::dvec3 farthest(glm::max(glm::abs(centre - l.low), glm::abs(l.high - centre)));
            radius2 = std::max(radius2, glm::dot(farthest, farthest));
            double cosine = std::clamp(glm::dot(axis, glm::dvec3(l.axis)), -1.0, 1.0);
            if (both_sides) cosine = std::abs(cosine);
            least_cosine = std::min(least_cosine, cosine);
            if (l.spread > 0.0f) cone = std::max(cone, std::acos(cosine) + l.spread);
        }
        cone = std::min(pi, std::max(cone, std::acos(least_cosine)) + widening);
        const double falloff = std::min(0.5 * pi, whole.falloff + widening);
        branch.sphere[child] = glm::vec4(centre, float(std::sqrt(radius2) * (1.0 + 1e-6)));
        branch.axis[child] = pack_direction(glm::vec3(axis));
        branch.cones[child] = std::uint32_t(std::int32_t(std::floor(std::cos(cone) * 32767.0))) & 0xffffu;
        branch.cones[child] |= std::uint32_t(std::floor(std::max(0.0, std::cos(falloff)) * 32767.0)) << 16;
        if (both_sides) branch.cones[child] |= LIGHT_BOTH_SIDES;
        branch.reach[child] = reach;
        return whole.intensity;
    }

    /// Branches stand before those of their first child, and these before those of the second, so that each knows its
    /// place. Returns the depth below.
    std::uint32_t build_branch(Lamps lamps, std::uint32_t at, std::uint32_t parent, std::uint32_t depth) {
        const std::size_t first = split(lamps, depth);
        const std::array<Lamps, 2> of{lamps.first(first), lamps.subspan(first)};
        gpu::LightBranch& branch = tree_.branches[at];
        branch.parent = parent;
        std::array<double, 2> intensity{};
        std::array<std::uint32_t, 2> below{};
        const auto build_child = [&](int child) {
            intensity[child] = bound(of[child], branch, child);
            const std::uint32_t here = at << 1 | std::uint32_t(child);
            if (of[child].size() == 1) {
                const std::uint32_t lamp = of[child].front();
                branch.first[child] = lamps_[lamp].first;
                branch.count[child] = lamps_[lamp].count;
                tree_.lamps[lamp] = here;
            } else {
                branch.first[child] = at + 1 + (child == 1 ? std::uint32_t(of[0].size()) - 1 : 0);
                branch.count[child] = 0;
                below[child] = build_branch(of[child], branch.first[child], here, depth + 1);
            }
        };
        if (lamps.size() >= least_parallel) {
            tbb::parallel_invoke([&] { build_child(0); }, [&] { build_child(1); });
        } else {
            build_child(0);
            build_child(1);
        }
        branch.ratio = float(std::clamp(intensity[1] / intensity[0], 1.0 / widest_ratio, widest_ratio));
        return 1 + std::max(below[0], below[1]);
    }

    std::span<const Lamp> lamps_;
    LightTree& tree_;
    std::vector<std::uint32_t> order_;
};

}  // namespace

LightTree build_light_tree(std::span<const Lamp> lamps) {
    assert(lamps.size() >= 2);
    LightTree tree;
    tree.branches.resize(lamps.size() - 1);
    tree.lamps.resize(lamps.size());
    LightTreeBuilder(lamps, tree).build();
    return tree;
}

}  // namespace vkcppm
