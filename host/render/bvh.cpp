#include "render/bvh.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include <glm/common.hpp>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

namespace vkcppm {
namespace {

constexpr int bins = 16;
constexpr float node_cost = 1.0f;      // of visiting an inner node, in triangle tests
constexpr int max_sah_depth = 48;      // deeper, halves by count bound the depth
constexpr std::uint32_t task_size = 4096;
// Boxes grow by the rounding error of the slab test: a few ulp of coordinates within [-1, 1].
constexpr float padding = 1e-6f;

struct Bounds {
    glm::vec3 low{std::numeric_limits<float>::infinity()};
    glm::vec3 high{-std::numeric_limits<float>::infinity()};

    void grow(const glm::vec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    void grow(const Bounds& other) {
        low = glm::min(low, other.low);
        high = glm::max(high, other.high);
    }
    float half_area() const {
        const glm::vec3 d = glm::max(high - low, glm::vec3(0.0f));
        return d.x * d.y + d.y * d.z + d.z * d.x;
    }
};

struct Primitive {
    Bounds bounds;
    glm::vec3 centre{0.0f};
};

/// A node of the binary tree: a leaf has count > 0.
struct BinaryNode {
    Bounds bounds;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    std::uint32_t left = 0;
    std::uint32_t right = 0;
};

class Builder {
public:
    explicit Builder(std::span<const std::array<glm::vec3, 3>> triangles)
        : primitives_(triangles.size()), order_(triangles.size()), nodes_(2 * triangles.size()) {
        std::iota(order_.begin(), order_.end(), 0u);
        tbb::parallel_for(std::size_t(0), triangles.size(), [&](std::size_t i) {
            for (const auto& corner : triangles[i]) primitives_[i].bounds.grow(corner);
            primitives_[i].centre = 0.5f * (primitives_[i].bounds.low + primitives_[i].bounds.high);
        });
        if (!triangles.empty()) build(allocate(), 0, std::uint32_t(triangles.size()), 0);
    }

    const std::vector<BinaryNode>& nodes() const { return nodes_; }
    std::vector<std::uint32_t> take_order() { return std::move(order_); }

private:
    struct Split {
        int axis = -1;
        int bin = 0;
        float cost = std::numeric_limits<float>::infinity();
    };

    std::uint32_t allocate() { return next_.fetch_add(1, std::memory_order_relaxed); }

    void build(std::uint32_t index, std::uint32_t first, std::uint32_t last, int depth) {
        BinaryNode& node = nodes_[index];
        Bounds centres;
        for (std::uint32_t i = first; i < last; ++i) {
            node.bounds.grow(primitives_[order_[i]].bounds);
            centres.grow(primitives_[order_[i]].centre);
        }
        const std::uint32_t count = last - first;
        const Split split = depth < max_sah_depth && count > 1 ? best_split(first, last, centres) : Split();
        const float area = node.bounds.half_area();
        if (count == 1 || (count <= BVH_MAX_LEAF && float(count) * area <= split.cost + node_cost * area)) {
            node.first = first;
            node.count = count;
            return;
        }
        const std::uint32_t middle = partition(first, last, centres, split);
        node.left = allocate();
        node.right = allocate();
        const auto left = [&, l = node.left] { build(l, first, middle, depth + 1); };
        const auto right = [&, r = node.right] { build(r, middle, last, depth + 1); };
        if (count > task_size) {
            tbb::parallel_invoke(left, right);
        } else {
            left();
            right();
        }
    }

    static int bin_of(const glm::vec3& centre, const Bounds& centres, int axis) {
        const float extent = centres.high[axis] - centres.low[axis];
        return std::min(bins - 1, int(float(bins) * ((centre[axis] - centres.low[axis]) / extent)));
    }

    Split best_split(std::uint32_t first, std::uint32_t last, const Bounds& centres) const {
        struct Bin {
            Bounds bounds;
            std::uint32_t count = 0;
        };
        std::array<std::array<Bin, bins>, 3> table;
        for (int axis = 0; axis < 3; ++axis) {
            if (!(centres.high[axis] > centres.low[axis])) continue;
            for (std::uint32_t i = first; i < last; ++i) {
                const Primitive& primitive = primitives_[order_[i]];
                Bin& bin = table[axis][bin_of(primitive.centre, centres, axis)];
                bin.bounds.grow(primitive.bounds);
                ++bin.count;
            }
        }
        Split best;
        for (int axis = 0; axis < 3; ++axis) {
            if (!(centres.high[axis] > centres.low[axis])) continue;
            std::array<float, bins> right_cost{};
            Bounds bounds;
            std::uint32_t count = 0;
            for (int b = bins - 1; b > 0; --b) {
                bounds.grow(table[axis][b].bounds);
                count += table[axis][b].count;
                right_cost[b] = count > 0 ? float(count) * bounds.half_area() : 0.0f;
            }
            bounds = Bounds();
            count = 0;
            for (int b = 1; b < bins; ++b) {
                bounds.grow(table[axis][b - 1].bounds);
                count += table[axis][b - 1].count;
                if (count == 0 || count == last - first) continue;
                const float cost = float(count) * bounds.half_area() + right_cost[b];
                if (cost < best.cost) best = {axis, b, cost};
            }
        }
        return best;
    }

    std::uint32_t partition(std::uint32_t first, std::uint32_t last, const Bounds& centres, const Split& split) {
        const auto begin = order_.begin() + first, end = order_.begin() + last;
        if (split.axis >= 0) {
            const auto middle = std::stable_partition(begin, end, [&](std::uint32_t i) {
                return bin_of(primitives_[i].centre, centres, split.axis) < split.bin;
            });
            return std::uint32_t(middle - order_.begin());
        }
        // No plane separates the centres (or the tree is too deep): halves by count along the longest axis.
        const glm::vec3 extent = centres.high - centres.low;
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        const auto middle = begin + (last - first) / 2;
        std::nth_element(begin, middle, end, [&](std::uint32_t a, std::uint32_t b) {
            return std::pair(primitives_[a].centre[axis], a) < std::pair(primitives_[b].centre[axis], b);
        });
        return std::uint32_t(middle - order_.begin());
    }

    std::vector<Primitive> primitives_;
    std::vector<std::uint32_t> order_;
    std::vector<BinaryNode> nodes_;
    std::atomic<std::uint32_t> next_ = 0;
};

/// Largest q with origin + q * cell <= value, and smallest with >=, in the kernels' own float arithmetic.
std::uint32_t quantise_down(float value, float origin, float cell) {
    auto q = std::int32_t(std::clamp(std::floor((value - origin) / cell), 0.0f, 255.0f));
    while (q > 0 && origin + float(q) * cell > value) --q;
    return std::uint32_t(q);
}
std::uint32_t quantise_up(float value, float origin, float cell) {
    auto q = std::int32_t(std::clamp(std::ceil((value - origin) / cell), 0.0f, 255.0f));
    while (q < 255 && origin + float(q) * cell < value) ++q;
    return std::uint32_t(q);
}

class Collapser {
public:
    explicit Collapser(const std::vector<BinaryNode>& binary) : binary_(binary) {}

    /// Emits the four-wide node of the binary node and all below; returns the groups of children that can wait.
    std::uint32_t emit(std::uint32_t root) {
        const std::uint32_t index = std::uint32_t(nodes.size());
        nodes.emplace_back();
        std::array<std::uint32_t, 4> children{};
        int count = 0;
        if (binary_[root].count > 0) {
            children[count++] = root;
        } else {
            children = {binary_[root].left, binary_[root].right};
            count = 2;
            // The child with the largest area is opened first: it is the one most often entered.
            while (count < 4) {
                int widest = -1;
                for (int c = 0; c < count; ++c) {
                    if (binary_[children[c]].count > 0) continue;
                    if (widest < 0 ||
                        binary_[children[c]].bounds.half_area() > binary_[children[widest]].bounds.half_area()) {
                        widest = c;
                    }
                }
                if (widest < 0) break;
                const BinaryNode& opened = binary_[children[widest]];
                children[widest] = opened.left;
                children[count++] = opened.right;
            }
        }
        quantise(index, std::span(children.data(), count));
        std::uint32_t need = 0;
        for (int c = 0; c < count; ++c) {
            const BinaryNode& child = binary_[children[c]];
            nodes[index].exponents |= 1u << (24 + c);
            if (child.count > 0) {
                nodes[index].exponents |= 1u << (28 + c);
                nodes[index].child[c] = BVH_LEAF | child.first << 3 | child.count;
            } else {
                const auto child_index = std::uint32_t(nodes.size());
                need = std::max(need, emit(children[c]));
                nodes[index].child[c] = child_index;
            }
        }
        return need + (count > 1 ? 1 : 0);
    }

    std::vector<gpu::BvhNode> nodes;

private:
    void quantise(std::uint32_t index, std::span<const std::uint32_t> children) {
        gpu::BvhNode& node = nodes[index];
        Bounds all;
        for (const std::uint32_t c : children) all.grow(binary_[c].bounds);
        node.origin = all.low - padding;
        const glm::vec3 high = all.high + padding;
        std::array<std::uint32_t*, 3> low_words = {&node.low_x, &node.low_y, &node.low_z};
        std::array<std::uint32_t*, 3> high_words = {&node.high_x, &node.high_y, &node.high_z};
        for (int axis = 0; axis < 3; ++axis) {
            int exponent = std::max(-100, std::ilogb((high[axis] - node.origin[axis]) / 255.0f));
            while (node.origin[axis] + 255.0f * std::ldexp(1.0f, exponent) < high[axis]) ++exponent;
            const float cell = std::ldexp(1.0f, exponent);
            node.exponents |= std::uint32_t(exponent + 127) << (8 * axis);
            for (std::size_t c = 0; c < children.size(); ++c) {
                const Bounds& bounds = binary_[children[c]].bounds;
                *low_words[axis] |= quantise_down(bounds.low[axis] - padding, node.origin[axis], cell) << (8 * c);
                *high_words[axis] |= quantise_up(bounds.high[axis] + padding, node.origin[axis], cell) << (8 * c);
            }
        }
    }

    const std::vector<BinaryNode>& binary_;
};

}  // namespace

Bvh build_bvh(std::span<const std::array<glm::vec3, 3>> triangles) {
    assert(triangles.size() < (std::size_t(1) << 28));
    Bvh bvh;
    if (triangles.empty()) {
        bvh.nodes.emplace_back();
        return bvh;
    }
    Builder builder(triangles);
    Collapser collapser(builder.nodes());
    bvh.stack = std::max(1u, collapser.emit(0));
    bvh.nodes = std::move(collapser.nodes);
    bvh.order = builder.take_order();
    return bvh;
}

Box child_box(const gpu::BvhNode& node, int c) {
    const std::array<std::uint32_t, 3> low = {node.low_x, node.low_y, node.low_z};
    const std::array<std::uint32_t, 3> high = {node.high_x, node.high_y, node.high_z};
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
        const float cell = std::bit_cast<float>((node.exponents >> (8 * axis) & 255u) << 23);
        box.low[axis] = node.origin[axis] + float(low[axis] >> (8 * c) & 255u) * cell;
        box.high[axis] = node.origin[axis] + float(high[axis] >> (8 * c) & 255u) * cell;
    }
    return box;
}

}  // namespace vkcppm
