#include "flat/bvh.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <memory>
#include <utility>

#include <glm/common.hpp>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

namespace vkcppm {
namespace {

constexpr int bins = 16;
constexpr std::uint32_t width = 4;  // children of a node
// In triangle tests, the best on software Vulkan of those tried, from 1 and 0 on.
constexpr float node_cost = 5.0f;          // of visiting a four-wide node
constexpr float leaf_cost = 2.0f;          // of beginning a leaf
constexpr int max_sah_depth = 48;          // deeper, halves by count bound the depth
constexpr std::uint32_t task_size = 4096;  // triangles of a subtree that is worth a task of its own

// x, y, z and 0 in one SIMD register, of g++ and clang alike.
using Float4 = float __attribute__((vector_size(16)));
using Int4 = int __attribute__((vector_size(16)));

Float4 all(float x) { return Float4{x, x, x, x}; }
Float4 least(Float4 a, Float4 b) { return b < a ? b : a; }
Float4 largest(Float4 a, Float4 b) { return a < b ? b : a; }

struct Bounds {
    Float4 low;
    Float4 high;

    static Bounds nothing() {
        const float infinity = std::numeric_limits<float>::infinity();
        return {all(infinity), all(-infinity)};
    }

    void grow(Float4 p) {
        low = least(low, p);
        high = largest(high, p);
    }
    void grow(const Bounds& other) {
        low = least(low, other.low);
        high = largest(high, other.high);
    }
    float half_area() const {
        const Float4 d = largest(high - low, all(0.0f));
        return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
    }
};

/// A triangle or an instance as the builder moves it about: the box and the index, close together, for there may be
/// very many.
struct Primitive {
    std::array<float, 3> low;
    std::array<float, 3> high;
    std::uint32_t index;  // instances come after the triangles

    static Primitive of(const std::array<glm::vec3, 3>& triangle, std::uint32_t index) {
        return of(BvhBox{glm::min(triangle[0], glm::min(triangle[1], triangle[2])),
                         glm::max(triangle[0], glm::max(triangle[1], triangle[2]))},
                  index);
    }
    static Primitive of(const BvhBox& box, std::uint32_t index) {
        return {{box.low.x, box.low.y, box.low.z}, {box.high.x, box.high.y, box.high.z}, index};
    }
    Bounds bounds() const { return {xyz(offsetof(Primitive, low)), xyz(offsetof(Primitive, high))}; }
    Float4 centre() const { return all(0.5f) * (xyz(offsetof(Primitive, low)) + xyz(offsetof(Primitive, high))); }

private:
    /// The three floats at that byte, in one load: there is a word behind either.
    Float4 xyz(std::size_t at) const {
        Int4 words;
        std::memcpy(&words, reinterpret_cast<const char*>(this) + at, sizeof words);
        return std::bit_cast<Float4>(words & Int4{-1, -1, -1, 0});
    }
};
static_assert(sizeof(Primitive) == 28);

/// An inner node of the binary tree, whose leaves hold one primitive each. The surface area heuristic tells how it is
/// best cut into four-wide nodes and leaves (Ylitie, Karras and Laine 2017, section 3). Primitives of a subtree stand
/// side by side, so that the node is known by the place where its right half begins, and its children by theirs.
struct BinaryNode {
    std::array<float, 3> low;
    std::array<float, 3> high;
    /// Least cost of the subtree, in areas times triangle tests, as at most i + 1 children of a four-wide node.
    std::array<float, width - 1> cost;
    std::uint32_t left : 31;      // of its left child, where that is no leaf
    std::uint32_t leaf : 1;       // as one child it is best a leaf
    std::uint32_t right : 31;     // of its right child
    std::uint32_t instances : 1;  // there are some below it
};
static_assert(sizeof(BinaryNode) == 44);

/// The binary tree: the primitives in the order of its leaves, the nodes by the place where their right half begins.
struct BinaryTree {
    std::unique_ptr<Primitive[]> primitives;
    std::unique_ptr<BinaryNode[]> nodes;
    std::uint32_t triangles = 0;  // how many
    std::uint32_t root = 0;
};

/// A subtree of it, with what follows from its primitives or is kept by its node.
struct Subtree {
    std::uint32_t first;  // primitive
    std::uint32_t count;
    std::uint32_t node;  // where there are several

    Bounds bounds(const BinaryTree& tree) const {
        if (count == 1) return tree.primitives[first].bounds();
        const BinaryNode& n = tree.nodes[node];
        return {Float4{n.low[0], n.low[1], n.low[2], 0.0f}, Float4{n.high[0], n.high[1], n.high[2], 0.0f}};
    }
    std::array<float, width - 1> cost(const BinaryTree& tree) const {
        if (count > 1) return tree.nodes[node].cost;
        const float cost = tree.primitives[first].bounds().half_area() * (leaf_cost + 1.0f);
        return {cost, cost, cost};
    }
    bool leaf(const BinaryTree& tree) const { return count == 1 || tree.nodes[node].leaf != 0; }
    bool is_instance(const BinaryTree& tree) const {
        return count == 1 && tree.primitives[first].index >= tree.triangles;
    }
    bool has_instances(const BinaryTree& tree) const {
        return count == 1 ? is_instance(tree) : tree.nodes[node].instances != 0;
    }
    /// As a child of a four-wide node it is a node: one stands also in the place of an instance.
    bool is_inner(const BinaryTree& tree) const { return !leaf(tree) || is_instance(tree); }
    Subtree left(const BinaryTree& tree) const { return {first, node - first, tree.nodes[node].left}; }
    Subtree right(const BinaryTree& tree) const { return {node, first + count - node, tree.nodes[node].right}; }
};

/// How many of `slots` children the left half takes, at least one a half, and what both cost.
struct Share {
    std::uint32_t left;
    float cost;

    using Costs = std::array<float, width - 1>;
    Share(const Costs& a, const Costs& b, std::uint32_t slots) : left(1), cost(a[0] + b[slots - 2]) {
        for (std::uint32_t k = 2; k < slots; ++k) {
            const float other = a[k - 1] + b[slots - k - 1];
            if (other < cost) {
                left = k;
                cost = other;
            }
        }
    }
};

/// Slabs of equal thickness along each axis, in which the centres of a node lie.
class Slabs {
public:
    explicit Slabs(const Bounds& centres) : low_(centres.low), extent_(centres.high - centres.low) {
        for (int axis = 0; axis < 4; ++axis) {
            if (!(extent_[axis] > 0.0f)) extent_[axis] = 1.0f;  // all in the first one
        }
    }
    /// The slab along each axis.
    Int4 of(Float4 centre) const {
        const Int4 slab = __builtin_convertvector(all(float(bins)) * ((centre - low_) / extent_), Int4);
        const Int4 last = Int4{bins, bins, bins, bins} - 1;
        return slab < last ? slab : last;
    }

private:
    Float4 low_;
    Float4 extent_;
};

/// The plane in front of slab `slab` along `axis`; axis -1: none, all centres lie in one slab along every axis.
struct Split {
    int axis = -1;
    int slab = 0;
    float cost = std::numeric_limits<float>::infinity();
};

/// What lies in each slab along each axis. Slabs in which nothing lies are neither set nor looked at: most nodes have
/// few triangles.
class Bins {
public:
    Bins(const Slabs& slabs, std::span<const Primitive> primitives) {
        for (const Primitive& primitive : primitives) {
            const Bounds bounds = primitive.bounds();
            const Int4 slab = slabs.of(primitive.centre());
            for (int axis = 0; axis < 3; ++axis) {
                Axis& along = axes_[axis];
                const int b = slab[axis];
                if (along.used & 1u << b) {
                    along.bounds[b].grow(bounds);
                    ++along.count[b];
                } else {
                    along.bounds[b] = bounds;
                    along.count[b] = 1;
                    along.used |= 1u << b;
                }
            }
        }
    }

    /// The box of all.
    Bounds whole() const {
        Bounds sum = Bounds::nothing();
        for (std::uint32_t rest = axes_[0].used; rest != 0; rest &= rest - 1) {
            sum.grow(axes_[0].bounds[std::countr_zero(rest)]);
        }
        return sum;
    }

    /// Triangles before a slab.
    std::uint32_t before(int axis, int slab) const {
        std::uint32_t sum = 0;
        for (std::uint32_t rest = axes_[axis].used & ((1u << slab) - 1); rest != 0; rest &= rest - 1) {
            sum += axes_[axis].count[std::countr_zero(rest)];
        }
        return sum;
    }

    /// The plane of the least cost.
    Split best_split() const {
        Split best;
        for (int axis = 0; axis < 3; ++axis) {
            const Axis& along = axes_[axis];
            std::array<float, bins> right_cost;
            Bounds sum = Bounds::nothing();
            std::uint32_t count = 0;
            for (std::uint32_t rest = along.used; rest != 0; rest &= std::bit_floor(rest) - 1) {
                const int b = std::bit_width(rest) - 1;
                sum.grow(along.bounds[b]);
                count += along.count[b];
                right_cost[b] = float(count) * sum.half_area();
            }
            sum = Bounds::nothing();
            count = 0;
            for (std::uint32_t rest = along.used; (rest & (rest - 1)) != 0;) {
                const int b = std::countr_zero(rest);
                rest &= rest - 1;
                const int next = std::countr_zero(rest);
                sum.grow(along.bounds[b]);
                count += along.count[b];
                const float cost = float(count) * sum.half_area() + right_cost[next];
                if (cost < best.cost) best = {axis, next, cost};
            }
        }
        return best;
    }

private:
    struct Axis {
        std::uint32_t used = 0;  // a bit a slab
        std::array<std::uint32_t, bins> count;
        std::array<Bounds, bins> bounds;
    };
    std::array<Axis, 3> axes_;
};

/// Builds the binary tree, subtrees in parallel. A node's triangles lie side by side, in the same order on either side
/// of the plane as before: the smaller side waits in a second buffer while the other closes ranks.
class Builder {
public:
    Builder(std::span<const std::array<glm::vec3, 3>> triangles, std::span<const BvhBox> instances) {
        const auto first_instance = std::uint32_t(triangles.size());
        Range all(0, first_instance + std::uint32_t(instances.size()));
        tree_.primitives = std::make_unique_for_overwrite<Primitive[]>(all.count());
        tree_.nodes = std::make_unique_for_overwrite<BinaryNode[]>(all.count());
        tree_.triangles = first_instance;
        waiting_ = std::make_unique_for_overwrite<Primitive[]>(all.count() / 2 + 1);
        tbb::parallel_for(0u, first_instance,
                          [&](std::uint32_t i) { tree_.primitives[i] = Primitive::of(triangles[i], i); });
        for (std::uint32_t i = first_instance; i < all.last; ++i) {
            tree_.primitives[i] = Primitive::of(instances[i - first_instance], i);
        }
        for (const Primitive& primitive : primitives(all)) all.centres.grow(primitive.centre());
        tree_.root = build(all, 0);
    }

    BinaryTree take_tree() { return std::move(tree_); }

private:
    /// Triangles of a node.
    struct Range {
        std::uint32_t first;
        std::uint32_t last;
        Bounds centres = Bounds::nothing();

        Range(std::uint32_t first_, std::uint32_t last_) : first(first_), last(last_) {}
        std::uint32_t count() const { return last - first; }
    };

    std::span<Primitive> primitives(const Range& range) { return {&tree_.primitives[range.first], range.count()}; }

    /// Room for half of the triangles of a node, which no other node has that does not share some with it.
    Primitive* waiting(const Range& range) { return &waiting_[(range.first + 1) / 2]; }

    /// Returns the place of the node; of one triangle there is none.
    std::uint32_t build(const Range& range, int depth) {
        if (range.count() == 1) return 0;
        const Slabs slabs(range.centres);
        const Bins table(slabs, primitives(range));
        const Split split = depth < max_sah_depth ? table.best_split() : Split();
        const auto halves = split.axis >= 0 ? partition(range, slabs, table, split) : halve(range);
        BinaryNode& node = tree_.nodes[halves[1].first] = {};
        const Bounds whole = table.whole();
        for (int axis = 0; axis < 3; ++axis) {
            node.low[axis] = whole.low[axis];
            node.high[axis] = whole.high[axis];
        }
        const auto left = [&] { node.left = build(halves[0], depth + 1) & 0x7fffffffu; };
        std::uint32_t right_node = 0;
        const auto right = [&] { right_node = build(halves[1], depth + 1); };
        if (range.count() > task_size) {
            tbb::parallel_invoke(left, right);
        } else {
            left();
            right();
        }
        node.right = right_node & 0x7fffffffu;
        const Subtree self{range.first, range.count(), halves[1].first};
        const Subtree left_half = self.left(tree_), right_half = self.right(tree_);
        const auto a = left_half.cost(tree_), b = right_half.cost(tree_);
        const float area = whole.half_area();
        const float as_node = area * node_cost + Share(a, b, width).cost;
        const float as_leaf = area * (leaf_cost + float(range.count()));
        node.instances = left_half.has_instances(tree_) || right_half.has_instances(tree_);
        node.leaf = !node.instances && range.count() <= BVH_MAX_LEAF && as_leaf <= as_node;
        node.cost[0] = node.leaf ? as_leaf : as_node;
        for (std::uint32_t slots = 2; slots < width; ++slots) {
            node.cost[slots - 1] = std::min(node.cost[slots - 2], Share(a, b, slots).cost);
        }
        return halves[1].first;
    }

    std::array<Range, 2> partition(const Range& range, const Slabs& slabs, const Bins& table, const Split& split) {
        const std::uint32_t before = table.before(split.axis, split.slab), middle = range.first + before;
        std::array<Range, 2> halves = {Range{range.first, middle}, Range{middle, range.last}};
        const std::span<Primitive> here = primitives(range);
        Primitive* const waiting = this->waiting(range);
        const auto side_of = [&](const Primitive& primitive) {
            const Float4 centre = primitive.centre();
            const int side = slabs.of(centre)[split.axis] >= split.slab;
            halves[side].centres.grow(centre);
            return side;
        };
        std::uint32_t waits = 0;
        if (before >= range.count() - before) {
            std::uint32_t kept = 0;
            for (const Primitive& primitive : here) {
                if (side_of(primitive) == 1) {
                    waiting[waits++] = primitive;
                } else {
                    here[kept++] = primitive;
                }
            }
            std::copy(waiting, waiting + waits, here.begin() + kept);
        } else {
            std::uint32_t kept = range.count();
            for (std::uint32_t i = range.count(); i-- > 0;) {
                if (side_of(here[i]) == 0) {
                    waiting[waits++] = here[i];
                } else {
                    here[--kept] = here[i];
                }
            }
            std::reverse_copy(waiting, waiting + waits, here.begin());
        }
        return halves;
    }

    /// No plane separates the centres, or the tree is too deep: halves by count along the longest axis.
    std::array<Range, 2> halve(const Range& range) {
        const Float4 extent = range.centres.high - range.centres.low;
        const int axis = extent[0] >= extent[1] && extent[0] >= extent[2] ? 0 : extent[1] >= extent[2] ? 1 : 2;
        const std::uint32_t middle = range.first + range.count() / 2;
        std::array<Range, 2> halves = {Range{range.first, middle}, Range{middle, range.last}};
        const std::span<Primitive> both = primitives(range);
        std::nth_element(
            both.begin(), both.begin() + range.count() / 2, both.end(), [&](const Primitive& a, const Primitive& b) {
                return std::pair(float(a.centre()[axis]), a.index) < std::pair(float(b.centre()[axis]), b.index);
            });
        for (Range& half : halves) {
            for (const Primitive& primitive : primitives(half)) half.centres.grow(primitive.centre());
        }
        return halves;
    }

    BinaryTree tree_;
    std::unique_ptr<Primitive[]> waiting_;
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

/// Writes the four-wide nodes: depth-first, but the nodes among a node's children side by side. The triangles of leaves
/// come in the order of their nodes.
class Collapser {
public:
    Collapser(const BinaryTree& tree, std::uint32_t instances, float padding)
        : nodes(1), instance_nodes(instances), tree_(tree), padding_(padding) {
        order.reserve(tree.triangles);
        stack = emit({0, tree.triangles + instances, tree.root}, 0);
    }

    std::vector<gpu::BvhNode> nodes;
    std::vector<std::uint32_t> order;
    std::uint32_t stack;  // nodes of which children can wait
    std::vector<std::uint32_t> instance_nodes;

private:
    /// Fills in node `index` from the binary node and adds all below; returns the nodes of which children can wait.
    std::uint32_t emit(const Subtree& root, std::uint32_t index) {
        if (root.is_instance(tree_) && index > 0) {
            const std::uint32_t instance = tree_.primitives[root.first].index - tree_.triangles;
            nodes[index].exponents = BVH_INSTANCE | instance;
            instance_nodes[instance] = index;
            return 0;
        }
        Children children;
        if (root.leaf(tree_)) {
            children.add(root);
        } else {
            cut_halves(root, width, children);
        }
        const auto list = children.list();
        // Not that of std::ranges, which clang 14 does not compile.
        const auto leaves =
            std::stable_partition(list.begin(), list.end(), [&](const Subtree& c) { return c.is_inner(tree_); });
        const auto inner = std::size_t(leaves - list.begin());
        const auto first = inner > 0 ? std::uint32_t(nodes.size()) : index;
        nodes.resize(nodes.size() + inner);
        quantise(index, list);
        nodes[index].exponents |= ((1u << list.size()) - 1) << 24;
        nodes[index].children = first << BVH_CHILDREN_SHIFT | std::uint32_t(inner);
        std::uint32_t* words = inner > 0 ? nodes[first].parent_leaves : nodes[index].leaves;
        words[0] = std::uint32_t(order.size());
        for (std::size_t c = inner; c < list.size(); ++c) {
            const Subtree& leaf = list[c];
            words[1] |= ((std::uint32_t(order.size()) - words[0]) | leaf.count << 4) << (8 * c);
            for (std::uint32_t i = 0; i < leaf.count; ++i) order.push_back(tree_.primitives[leaf.first + i].index);
        }
        std::uint32_t need = 0;
        for (std::uint32_t c = 0; c < inner; ++c) need = std::max(need, emit(list[c], first + c));
        return need + (list.size() > 1 ? 1 : 0);
    }

    struct Children {
        std::array<Subtree, width> subtree;
        int count = 0;

        void add(const Subtree& n) { subtree[count++] = n; }
        std::span<Subtree> list() { return {subtree.data(), std::size_t(count)}; }
    };

    /// Adds what the subtree becomes in at most so many slots of its parent.
    void cut(const Subtree& n, std::uint32_t slots, Children& children) const {
        const auto cost = n.cost(tree_);
        while (slots > 1 && cost[slots - 1] == cost[slots - 2]) --slots;  // fewer do as well
        if (slots == 1) {
            children.add(n);
        } else {
            cut_halves(n, slots, children);
        }
    }

    void cut_halves(const Subtree& n, std::uint32_t slots, Children& children) const {
        const Subtree left = n.left(tree_), right = n.right(tree_);
        const Share share(left.cost(tree_), right.cost(tree_), slots);
        cut(left, share.left, children);
        cut(right, slots - share.left, children);
    }

    void quantise(std::uint32_t index, std::span<const Subtree> children) {
        gpu::BvhNode& node = nodes[index];
        Bounds whole = Bounds::nothing();
        for (const Subtree& c : children) whole.grow(c.bounds(tree_));
        node.origin = glm::vec3(whole.low[0], whole.low[1], whole.low[2]) - padding_;
        const glm::vec3 high = glm::vec3(whole.high[0], whole.high[1], whole.high[2]) + padding_;
        std::array<std::uint32_t*, 3> low_words = {&node.low_x, &node.low_y, &node.low_z};
        std::array<std::uint32_t*, 3> high_words = {&node.high_x, &node.high_y, &node.high_z};
        for (int axis = 0; axis < 3; ++axis) {
            int exponent = std::max(-100, std::ilogb((high[axis] - node.origin[axis]) / 255.0f));
            while (node.origin[axis] + 255.0f * std::ldexp(1.0f, exponent) < high[axis]) ++exponent;
            const float cell = std::ldexp(1.0f, exponent);
            node.exponents |= std::uint32_t(exponent + 127) << (8 * axis);
            for (std::size_t c = 0; c < children.size(); ++c) {
                const Bounds bounds = children[c].bounds(tree_);
                *low_words[axis] |= quantise_down(bounds.low[axis] - padding_, node.origin[axis], cell) << (8 * c);
                *high_words[axis] |= quantise_up(bounds.high[axis] + padding_, node.origin[axis], cell) << (8 * c);
            }
        }
    }

    const BinaryTree& tree_;
    const float padding_;
};

}  // namespace

Bvh build_bvh(std::span<const std::array<glm::vec3, 3>> triangles, std::span<const BvhBox> instances, float padding) {
    assert(triangles.size() + instances.size() < (std::size_t(1) << 28));
    Bvh bvh;
    if (triangles.empty() && instances.empty()) {
        bvh.nodes.emplace_back();
        return bvh;
    }
    const BinaryTree tree = Builder(triangles, instances).take_tree();
    Collapser collapser(tree, std::uint32_t(instances.size()), padding);
    return {std::move(collapser.nodes), std::move(collapser.order), std::max(1u, collapser.stack),
            std::move(collapser.instance_nodes)};
}

std::uint32_t append_tree(Bvh& bvh, const Bvh& mesh, std::uint32_t first_triangle) {
    const auto root = std::uint32_t(bvh.nodes.size());
    for (gpu::BvhNode node : mesh.nodes) {
        node.children += root << BVH_CHILDREN_SHIFT;
        node.leaves[0] += first_triangle;
        node.parent_leaves[0] += first_triangle;
        bvh.nodes.push_back(node);
    }
    return root;
}

BvhChild child_of(const Bvh& bvh, std::uint32_t index, int c) {
    const gpu::BvhNode& node = bvh.nodes[index];
    if ((node.exponents >> (24 + c) & 1u) == 0) return {};
    const std::uint32_t inner = node.children & BVH_CHILDREN_MASK, first = node.children >> BVH_CHILDREN_SHIFT;
    if (std::uint32_t(c) < inner) return {.node = first + std::uint32_t(c)};
    const std::uint32_t* leaves = inner == 0 ? bvh.nodes[first].leaves : bvh.nodes[first].parent_leaves;
    const std::uint32_t place = leaves[1] >> (8 * c);
    return {.first = leaves[0] + (place & 15u), .count = place >> 4 & 15u};
}

BvhBox child_box(const gpu::BvhNode& node, int c) {
    const std::array<std::uint32_t, 3> low = {node.low_x, node.low_y, node.low_z};
    const std::array<std::uint32_t, 3> high = {node.high_x, node.high_y, node.high_z};
    BvhBox box;
    for (int axis = 0; axis < 3; ++axis) {
        const float cell = std::bit_cast<float>((node.exponents >> (8 * axis) & 255u) << 23);
        box.low[axis] = node.origin[axis] + float(low[axis] >> (8 * c) & 255u) * cell;
        box.high[axis] = node.origin[axis] + float(high[axis] >> (8 * c) & 255u) * cell;
    }
    return box;
}

}  // namespace vkcppm
