#include "flat/flatten.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <tuple>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/packing.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include "core/error.h"
#include "flat/bounds.h"
#include "flat/coincidence.h"
#include "flat/direction.h"
#include "flat/features.h"
#include "flat/lights.h"
#include "flat/material.h"
#include "flat/textures.h"
#include "scene/diagnosis/shell.h"
#include "scene/instances.h"

namespace vkcppm {
namespace {

SceneFrame make_frame(const SceneBox& box) {
    SceneFrame frame;
    if (box.is_empty()) return frame;
    frame.centre = 0.5 * (box.low + box.high);
    const double radius = 0.5 * glm::length(box.high - box.low);
    if (radius > 0.0) frame.scale = std::exp2(-std::ceil(std::log2(radius)));
    return frame;
}

/// Triangles of one space that kernels see, and their corners there.
struct Placed {
    std::vector<std::uint32_t> source;  // into the triangles of the scene
    std::vector<Corners> corners;
    bool solids_touch = false;
};

/// Which corner should come first. Barycentrics are well conditioned where the edges at the first corner are not nearly
/// parallel; in a needle, with two long edges and a short one, that is a corner of the short one.
int first_corner(const Corners& c) {
    constexpr float nearly_parallel = 0.02f;
    const glm::vec3 e1 = c[1] - c[0], e2 = c[2] - c[0];
    if (glm::length(glm::cross(e1, e2)) >= nearly_parallel * glm::length(e1) * glm::length(e2)) return 0;
    const std::array<float, 3> opposite = {glm::distance(c[1], c[2]), glm::distance(c[2], c[0]),
                                           glm::distance(c[0], c[1])};
    return int(std::max_element(opposite.begin(), opposite.end()) - opposite.begin());
}

/// least_error: as of part_touching_faces().
Placed place_triangles(const Scene& scene, const TriangleRange& range, const SceneFrame& frame,
                       const std::vector<MaterialTraits>& traits, float least_error = 0.0f) {
    Placed placed;
    std::vector<Corners>& corners = placed.corners;
    corners.resize(range.count());
    std::vector<FaceTraits> faces(corners.size());
    tbb::parallel_for(std::size_t(0), corners.size(), [&](std::size_t i) {
        const Triangle& triangle = scene.triangles[range.first + i];
        for (int c = 0; c < 3; ++c) corners[i][c] = glm::vec3(frame.point(scene.positions[triangle.vertex[c]]));
        const MaterialTraits& t = traits[triangle.material];
        faces[i] = {triangle.material, t.emits, is_solid(t)};
    });
    placed.source = distinct_triangles(corners, faces);
    const std::size_t kept = placed.source.size();
    for (std::size_t i = 0; i < kept; ++i) {
        corners[i] = corners[placed.source[i]];
        faces[i] = faces[placed.source[i]];
    }
    corners.resize(kept);
    faces.resize(kept);
    placed.solids_touch = part_touching_faces(corners, faces, least_error);
    for (std::uint32_t& source : placed.source) source += range.first;
    return placed;
}

gpu::TriangleGeometry geometry_of(const Corners& placed) {
    gpu::TriangleGeometry geometry{};
    geometry.v0 = placed[0];
    geometry.e1 = placed[1] - placed[0];
    geometry.e2 = placed[2] - placed[0];
    geometry.error = position_error(placed);
    // Rounding of s . (d x e2) and d . (s x e1) for |s| = |d| = 1: 12 half-ulps of the edge.
    constexpr float half_ulps_12 = 7.2e-7f;  // 12 x 2^-24, rounded up
    geometry.slack_u = half_ulps_12 * glm::length(geometry.e2);
    geometry.slack_v = half_ulps_12 * glm::length(geometry.e1);
    return geometry;
}

/// Twice the area times the normal.
glm::dvec3 face_normal(const gpu::TriangleGeometry& triangle) {
    return glm::cross(glm::dvec3(triangle.e1), glm::dvec3(triangle.e2));
}

gpu::TriangleShading shading_of(const Scene& scene, const Triangle& triangle, const glm::dvec3& normal) {
    const double twice_area = glm::length(normal);
    gpu::TriangleShading shading{};
    bool is_flat = true;
    for (int c = 0; c < 3; ++c) {
        const glm::vec3& n = scene.normals[triangle.vertex[c]];
        shading.normal[c] = pack_direction(n);
        is_flat = is_flat && (twice_area == 0.0 || glm::length(glm::dvec3(n) - normal / twice_area) < 1e-4);
    }
    shading.material = triangle.material | (is_flat ? SHADING_FLAT : 0u);
    return shading;
}

/// What holds points.
struct Extents {
    glm::vec3 low{std::numeric_limits<float>::infinity()};
    glm::vec3 high{-std::numeric_limits<float>::infinity()};
    double radius = 0.0;

    void hold(const glm::vec3& p) { hold(Extents{p, p, double(glm::length(p))}); }
    void hold(const Extents& other) {
        low = glm::min(low, other.low);
        high = glm::max(high, other.high);
        radius = std::max(radius, other.radius);
    }
};

/// Adds triangles in the leaf order of their tree, with which flat.bvh.order ends; their places in the scene are put
/// there.
Extents add_placed(const Scene& scene, const Placed& placed, FlatScene& flat) {
    const std::size_t first = flat.triangles.size(), last = flat.bvh.order.size();
    flat.triangles.resize(last);
    flat.shading.resize(last);
    flat.first_corner.resize(last);
    const auto add = [&](std::size_t i) {
        std::uint32_t& source = flat.bvh.order[i];
        Corners corners = placed.corners[source];
        const int first_seen = first_corner(corners);
        std::rotate(corners.begin(), corners.begin() + first_seen, corners.end());
        source = placed.source[source];
        flat.first_corner[i] = std::uint8_t(first_seen);
        flat.triangles[i] = geometry_of(corners);
        flat.shading[i] = shading_of(scene, source_of(scene, flat, i), face_normal(flat.triangles[i]));
        return corners;
    };
    return tbb::parallel_deterministic_reduce(
        tbb::blocked_range<std::size_t>(first, last), Extents(),
        [&](const tbb::blocked_range<std::size_t>& range, Extents some) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                for (const glm::vec3& p : add(i)) some.hold(p);
            }
            return some;
        },
        [](Extents a, const Extents& b) {
            a.hold(b);
            return a;
        });
}

/// In order: the sum does not hang on the threads.
double area_of(std::span<const gpu::TriangleGeometry> triangles) {
    double area = 0.0;
    for (const gpu::TriangleGeometry& triangle : triangles) area += 0.5 * glm::length(face_normal(triangle));
    return area;
}

// ---- instances ----

/// The largest sum of a row's absolute values.
double norm(const glm::dmat3& m) {
    const glm::dmat3 rows = glm::transpose(m);
    double largest = 0.0;
    for (int i = 0; i < 3; ++i) largest = std::max(largest, glm::dot(glm::abs(rows[i]), glm::dvec3(1.0)));
    return largest;
}

glm::dmat3 absolute(const glm::dmat3& m) { return {glm::abs(m[0]), glm::abs(m[1]), glm::abs(m[2])}; }

constexpr double half_ulp = 0x1p-24;  // of 1, in floats

/// From a mesh's space to the scene's frame, and back. The frame's origin is where a ray's distances are exact.
struct MeshToScene {
    glm::mat3 linear;
    glm::vec3 centre;
    glm::dmat3 back;  // of `linear` as floats have it

    MeshToScene(const Instance& instance, const SceneFrame& mesh, const SceneFrame& scene)
        : linear(glm::dmat3(instance.to_world) * (scene.scale / mesh.scale)),
          centre(scene.point(instance.to_world * glm::dvec4(mesh.centre, 1.0))),
          back(glm::inverse(glm::dmat3(linear))) {}

    /// What an error of a point in the scene's frame can be in the mesh's space, at most, times it.
    double magnified() const { return norm(back); }
    /// The rounding of a point of the mesh, there and back, in the scene's frame.
    double error() const {
        const glm::vec3 c = glm::abs(centre);
        return 4.0 * half_ulp * double(std::max({c.x, c.y, c.z}));
    }

    gpu::Instance to_scene() const {
        gpu::Instance record{};
        const glm::mat3 rows = glm::transpose(linear);
        record.row_x = glm::vec4(rows[0], centre.x);
        record.row_y = glm::vec4(rows[1], centre.y);
        record.row_z = glm::vec4(rows[2], centre.z);
        record.error = float(error());
        record.stretch = float(norm(linear) * (1.0 + norm(absolute(linear) * absolute(back))));
        record.hand = glm::determinant(back) < 0.0 ? -1.0f : 1.0f;
        record.size = std::max({glm::length(rows[0]), glm::length(rows[1]), glm::length(rows[2])});
        return record;
    }
    void enter_by(gpu::InstanceNode& node, std::uint32_t root) const {
        const glm::dmat3 rows = glm::transpose(back);
        node.centre = centre;
        for (int i = 0; i < 3; ++i) node.to_mesh[i] = glm::vec3(rows[i]);
        node.root = root;
    }
    /// Of areas of a mesh that is scaled alike along its axes; else of one that faces all ways.
    double area() const {
        const glm::dmat3 m(linear);
        const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
        return std::sqrt((glm::dot(cofactors[0], cofactors[0]) + glm::dot(cofactors[1], cofactors[1]) +
                          glm::dot(cofactors[2], cofactors[2])) /
                         3.0);
    }
};

/// An instance so small that its way in has no floats is not there, nor is one whose way out has none, as it shows a
/// line or a point (is_shareable keeps its axes alike), nor a second one in the same place.
std::vector<std::uint32_t> distinct_instances(const Scene& scene, const std::vector<MeshToScene>& placed) {
    const auto key = [&](std::uint32_t i) {
        const MeshToScene& p = placed[i];
        return std::tie(scene.instances[i].mesh, p.centre.x, p.centre.y, p.centre.z, p.linear[0].x, p.linear[0].y,
                        p.linear[0].z, p.linear[1].x, p.linear[1].y, p.linear[1].z, p.linear[2].x, p.linear[2].y,
                        p.linear[2].z);
    };
    std::vector<std::uint32_t> kept;
    for (std::uint32_t i = 0; i < placed.size(); ++i) {
        constexpr double most = 1e15;
        if (placed[i].magnified() < most && norm(glm::dmat3(placed[i].linear)) < most) kept.push_back(i);
    }
    std::vector<std::uint32_t> sorted = kept;
    std::ranges::sort(sorted,
                      [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b) || (key(a) == key(b) && a < b); });
    std::vector<bool> twice(placed.size());
    for (std::size_t i = 1; i < sorted.size(); ++i) twice[sorted[i]] = key(sorted[i]) == key(sorted[i - 1]);
    std::erase_if(kept, [&](std::uint32_t i) { return twice[i]; });
    return kept;
}

/// The boxes of instances in the scene's frame.
std::vector<BvhBox> boxes_in_frame(const std::vector<SceneBox>& boxes, const std::vector<std::uint32_t>& kept,
                                   const SceneFrame& frame) {
    std::vector<BvhBox> in_frame;
    in_frame.reserve(kept.size());
    for (const std::uint32_t i : kept) {
        // A ray in the mesh's space is off the one in the scene by rounding.
        const float rounding = 2.0f * bvh_padding;
        in_frame.push_back(
            {glm::vec3(frame.point(boxes[i].low)) - rounding, glm::vec3(frame.point(boxes[i].high)) + rounding});
    }
    return in_frame;
}

/// Everything that has a place: triangles, instances and the trees over them. Returns whether solids touch.
bool add_geometry(const Scene& scene, const std::vector<MaterialTraits>& traits, FlatScene& flat) {
    const TriangleRange world = world_triangles(scene);
    const std::vector<SceneBox> boxes = instance_boxes(scene);
    SceneBox whole = box_of(scene, world);
    for (const SceneBox& box : boxes) whole.grow(box);
    flat.frame = make_frame(whole);

    std::vector<SceneFrame> spaces;
    for (std::uint32_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        spaces.push_back(make_frame(box_of(scene, triangles_of_mesh(scene, mesh))));
    }
    std::vector<MeshToScene> placements;
    placements.reserve(scene.instances.size());
    for (const Instance& instance : scene.instances) {
        placements.emplace_back(instance, spaces[instance.mesh], flat.frame);
    }
    const std::vector<std::uint32_t> kept = distinct_instances(scene, placements);

    bool touch = false;
    Extents extents;
    {
        const std::vector<BvhBox> in_frame = boxes_in_frame(boxes, kept, flat.frame);
        for (const BvhBox& box : in_frame) {
            for (int corner = 0; corner < 8; ++corner) {
                extents.hold(glm::vec3((corner & 1 ? box.high : box.low).x, (corner & 2 ? box.high : box.low).y,
                                       (corner & 4 ? box.high : box.low).z));
            }
        }
        const Placed placed = place_triangles(scene, world, flat.frame, traits);
        touch = placed.solids_touch;
        flat.bvh = build_bvh(placed.corners, in_frame);
        extents.hold(add_placed(scene, placed, flat));
        flat.area = area_of(flat.triangles);
    }
    if (extents.low.x > extents.high.x) extents.hold(glm::vec3(0.0f));
    flat.low = extents.low - float(bounds_padding);
    flat.high = extents.high + float(bounds_padding);
    flat.radius = extents.radius;

    // Per mesh: how much of the scene's rounding is seen in it, and the area that it has in all.
    std::vector<double> least_error(scene.meshes.size()), magnified(scene.meshes.size()), areas(scene.meshes.size());
    for (const std::uint32_t i : kept) {
        const std::uint32_t mesh = scene.instances[i].mesh;
        magnified[mesh] = std::max(magnified[mesh], placements[i].magnified());
        const gpu::Instance record = placements[i].to_scene();
        const double off = double(record.error) + double(record.stretch) * 8.0 * half_ulp;  // of a point on it
        least_error[mesh] = std::max(least_error[mesh], placements[i].magnified() * off);
        areas[mesh] += placements[i].area();
    }
    std::vector<std::uint32_t> roots;
    std::uint32_t stack = 0;
    for (std::uint32_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        const Placed placed = place_triangles(scene, triangles_of_mesh(scene, mesh), spaces[mesh], traits,
                                              float(std::min(1e-2, least_error[mesh])));
        touch = touch || placed.solids_touch;
        const std::size_t first = flat.triangles.size();
        // Where rays begin that enter the mesh (enter_instance) is rounded as much.
        const double padding = bvh_padding * (1.0 + 2e-6 * magnified[mesh]);
        const Bvh tree = build_bvh(placed.corners, {}, float(std::min(1e-2, padding)));
        roots.push_back(append_tree(flat.bvh, tree, std::uint32_t(first)));
        stack = std::max(stack, tree.stack);
        flat.bvh.order.insert(flat.bvh.order.end(), tree.order.begin(), tree.order.end());
        add_placed(scene, placed, flat);
        flat.area += areas[mesh] * area_of(std::span(flat.triangles).subspan(first));
    }
    flat.bvh.stack += stack;
    for (std::size_t k = 0; k < kept.size(); ++k) {
        const MeshToScene& placement = placements[kept[k]];
        flat.instances.push_back(placement.to_scene());
        gpu::BvhNode& node = flat.bvh.nodes[flat.bvh.instance_nodes[k]];
        auto entry = std::bit_cast<gpu::InstanceNode>(node);
        placement.enter_by(entry, roots[scene.instances[kept[k]].mesh]);
        entry.index = node.exponents;
        node = std::bit_cast<gpu::BvhNode>(entry);
    }
    return touch;
}

/// Whether a camera stands within closed surfaces that face away from it, as in a box of which it is to see the inside:
/// it would see nothing of it if it did not see backs. O(triangles); instances are left out.
bool is_enclosed(const Scene& scene, const std::vector<MaterialTraits>& traits) {
    if (std::ranges::none_of(traits, &MaterialTraits::culled)) return false;
    return std::ranges::any_of(scene.cameras, [&](const Camera& camera) {
        const glm::dvec3 eye(camera.to_world[3]);
        const double turns = tbb::parallel_deterministic_reduce(
            tbb::blocked_range<std::uint32_t>(0, world_triangles(scene).last, 1u << 14), 0.0,
            [&](const tbb::blocked_range<std::uint32_t>& range, double sum) {
                for (std::uint32_t i = range.begin(); i < range.end(); ++i) {
                    if (!traits[scene.triangles[i].material].culled) continue;
                    sum += share_of_directions(corners_of(scene, i), eye);
                }
                return sum;
            },
            std::plus<>());
        return turns > 0.99;
    });
}

/// Whether solids are nested and, where they are, which of them counts, and what is needed to tell in which the eye is.
void add_solids(const Scene& scene, const std::vector<MaterialTraits>& traits, bool touch, FlatScene& flat) {
    const std::vector<Shell> shells = solid_shells(scene, traits);
    flat.nested = touch ? "solids that touch" : nested_solids(scene, shells);
    if (flat.nested.empty()) return;
    const std::vector<std::uint32_t> priorities = priorities_of(scene, traits, shells);
    for (std::size_t i = 0; i < priorities.size(); ++i) flat.materials[i].priority = priorities[i];
    for (std::uint32_t i = 0; i < world_triangles(scene).last; ++i) {
        const Triangle& triangle = scene.triangles[i];
        if (!is_solid(traits[triangle.material])) continue;
        SolidFace& face = flat.solids.emplace_back(SolidFace{{}, triangle.material, priorities[triangle.material]});
        for (int c = 0; c < 3; ++c) face.corners[c] = flat.frame.point(scene.positions[triangle.vertex[c]]);
    }
}

glm::vec4 texcoords_of(const Scene& scene, std::uint32_t vertex) {
    glm::vec4 both(0.0f);
    for (int set = 0; set < 2; ++set) {
        if (scene.uv[set].empty()) continue;
        both[2 * set] = scene.uv[set][vertex].x;
        both[2 * set + 1] = scene.uv[set][vertex].y;
    }
    return both;
}

/// What the features of the scene read of the vertices, triangle by triangle.
void add_attributes(const Scene& scene, FlatScene& flat) {
    const std::uint32_t features = bits_of(flat.features);
    const std::size_t count = flat.triangles.size();
    const bool textured = (features & (FEATURE_TEXTURES | FEATURE_ANISOTROPY)) != 0;
    if (textured) flat.texcoords.resize(3 * count);
    if (features & FEATURE_VERTEX_COLORS) flat.vertex_colors.resize(2 * count);
    if (features & FEATURE_TANGENTS) flat.tangents.resize(count);
    tbb::parallel_for(std::size_t(0), count, [&](std::size_t i) {
        const auto vertex = source_of(scene, flat, i).vertex;
        if (textured) {
            for (int c = 0; c < 3; ++c) flat.texcoords[3 * i + c] = texcoords_of(scene, vertex[c]);
        }
        if (features & FEATURE_VERTEX_COLORS) {
            std::array<std::uint32_t, 8> words{};
            for (int c = 0; c < 3; ++c) {
                const glm::vec4& color = scene.colors[vertex[c]];
                words[2 * c] = glm::packHalf2x16(glm::vec2(color.r, color.g));
                words[2 * c + 1] = glm::packHalf2x16(glm::vec2(color.b, color.a));
            }
            flat.vertex_colors[2 * i] = {words[0], words[1], words[2], words[3]};
            flat.vertex_colors[2 * i + 1] = {words[4], words[5], words[6], words[7]};
        }
        if (features & FEATURE_TANGENTS) {
            glm::uvec4 packed(0);
            for (int c = 0; c < 3; ++c) {
                const glm::vec4& tangent = scene.tangents[vertex[c]];
                if (tangent.w == 0.0f) continue;
                packed[c] = pack_direction(glm::vec3(tangent));
                packed.w |= 1u << c | (tangent.w < 0.0f ? TANGENTS_TURNED << c : 0u);
            }
            flat.tangents[i] = packed;
        }
    });
}

}  // namespace

Triangle source_of(const Scene& scene, const FlatScene& flat, std::size_t triangle) {
    Triangle source = scene.triangles[flat.bvh.order[triangle]];
    std::rotate(source.vertex.begin(), source.vertex.begin() + flat.first_corner[triangle], source.vertex.end());
    return source;
}

FlatScene flatten(const Scene& scene) {
    FlatScene flat;
    if (scene.materials.size() >= PATH_NO_MEDIUM) {
        throw Error(ExitCode::bad_input, fmt::format("{}: {} materials, the limit is {}", scene.file.string(),
                                                     scene.materials.size(), PATH_NO_MEDIUM - 1));
    }
    TextureTable textures(scene);
    std::vector<MaterialTraits> traits = traits_of(scene);
    if (is_enclosed(scene, traits)) {
        for (MaterialTraits& of_material : traits) of_material.culled = false;
    }
    const bool touch = add_geometry(scene, traits, flat);
    for (std::size_t i = 0; i < traits.size(); ++i) {
        flat.materials.push_back(gpu_material(scene.materials[i], traits[i], flat.frame.scale, textures));
    }
    add_solids(scene, traits, touch, flat);
    flat.textures = textures.lookups();
    flat.images = textures.take_texels();
    add_lights(scene, flat);
    flat.features = features_of(scene, traits, flat);
    add_attributes(scene, flat);
    return flat;
}

}  // namespace vkcppm
