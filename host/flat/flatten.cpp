#include "flat/flatten.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/packing.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include "core/error.h"
#include "flat/bounds.h"
#include "flat/coincidence.h"
#include "flat/features.h"
#include "flat/lights.h"
#include "flat/surface.h"
#include "flat/textures.h"

namespace vkcppm {
namespace {

/// Octahedral snorm16x2, as pack_direction of shaders/include/frame.glsl.
std::uint32_t pack_direction(const glm::vec3& n) {
    const float sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    glm::vec2 p(n.x / sum, n.y / sum);
    if (n.z < 0.0f) {
        p = glm::vec2((1.0f - std::abs(p.y)) * (p.x >= 0.0f ? 1.0f : -1.0f),
                      (1.0f - std::abs(p.x)) * (p.y >= 0.0f ? 1.0f : -1.0f));
    }
    const auto snorm = [](float x) {
        return std::uint32_t(std::int32_t(std::floor(std::clamp(x, -1.0f, 1.0f) * 32767.0f + 0.5f))) & 0xffffu;
    };
    return snorm(p.x) | snorm(p.y) << 16;
}

SceneFrame make_frame(const Scene& scene) {
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    using Box = std::pair<glm::dvec3, glm::dvec3>;
    const auto joined = [](const Box& a, const Box& b) {
        return Box(glm::min(a.first, b.first), glm::max(a.second, b.second));
    };
    std::tie(low, high) = tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, scene.triangles.size()), Box(low, high),
        [&](const tbb::blocked_range<std::size_t>& range, Box box) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                for (const std::uint32_t v : scene.triangles[i].vertex) {
                    box = joined(box, {scene.positions[v], scene.positions[v]});
                }
            }
            return box;
        },
        joined);
    SceneFrame frame;
    if (scene.triangles.empty()) return frame;
    frame.centre = 0.5 * (low + high);
    const double radius = 0.5 * glm::length(high - low);
    if (radius > 0.0) frame.scale = std::exp2(-std::ceil(std::log2(radius)));
    return frame;
}

/// The triangles of the scene that kernels see, and their corners there.
struct Placed {
    std::vector<std::uint32_t> source;  // into the triangles of the scene
    std::vector<Corners> corners;
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

Placed place_triangles(const Scene& scene, const SceneFrame& frame, const std::vector<SurfaceTraits>& traits) {
    Placed placed;
    std::vector<Corners>& corners = placed.corners;
    corners.resize(scene.triangles.size());
    std::vector<FaceTraits> faces(corners.size());
    tbb::parallel_for(std::size_t(0), corners.size(), [&](std::size_t i) {
        const Triangle& triangle = scene.triangles[i];
        for (int c = 0; c < 3; ++c) corners[i][c] = glm::vec3(frame.point(scene.positions[triangle.vertex[c]]));
        const SurfaceTraits& t = traits[triangle.material];
        faces[i] = {triangle.material, t.emits, t.has(Lobe::transmission) && !t.thin};
    });
    placed.source = distinct_triangles(corners, faces);
    const std::size_t kept = placed.source.size();
    for (std::size_t i = 0; i < kept; ++i) {
        corners[i] = corners[placed.source[i]];
        faces[i] = faces[placed.source[i]];
    }
    corners.resize(kept);
    faces.resize(kept);
    part_touching_faces(corners, faces);
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

/// What is told of all triangles, of one or of several.
struct Extents {
    glm::vec3 low{std::numeric_limits<float>::infinity()};
    glm::vec3 high{-std::numeric_limits<float>::infinity()};
    double radius = 0.0;
};

void add_triangles(const Scene& scene, const std::vector<SurfaceTraits>& traits, FlatScene& flat) {
    Placed placed = place_triangles(scene, flat.frame, traits);
    flat.bvh = build_bvh(placed.corners);
    const std::size_t count = flat.bvh.order.size();
    flat.triangles.resize(count);
    flat.shading.resize(count);
    flat.first_corner.resize(count);
    const auto add = [&](std::size_t i) {
        std::uint32_t& source = flat.bvh.order[i];
        Corners corners = placed.corners[source];
        const int first = first_corner(corners);
        std::rotate(corners.begin(), corners.begin() + first, corners.end());
        source = placed.source[source];
        flat.first_corner[i] = std::uint8_t(first);
        flat.triangles[i] = geometry_of(corners);
        flat.shading[i] = shading_of(scene, source_of(scene, flat, i), face_normal(flat.triangles[i]));
        return corners;
    };
    const auto joined = [](Extents a, const Extents& b) {
        a.low = glm::min(a.low, b.low);
        a.high = glm::max(a.high, b.high);
        a.radius = std::max(a.radius, b.radius);
        return a;
    };
    const Extents extents = tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, count), Extents(),
        [&](const tbb::blocked_range<std::size_t>& range, Extents some) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                for (const glm::vec3& p : add(i)) some = joined(some, {p, p, double(glm::length(p))});
            }
            return some;
        },
        joined);
    // In order: the sum does not hang on the threads.
    for (const gpu::TriangleGeometry& triangle : flat.triangles) flat.area += 0.5 * glm::length(face_normal(triangle));
    flat.radius = extents.radius;
    flat.low = (count == 0 ? glm::vec3(0.0f) : extents.low) - float(bounds_padding);
    flat.high = (count == 0 ? glm::vec3(0.0f) : extents.high) + float(bounds_padding);
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
    if (features & FEATURE_TEXTURES) flat.texcoords.resize(3 * count);
    if (features & FEATURE_VERTEX_COLORS) flat.vertex_colors.resize(2 * count);
    if (features & FEATURE_TANGENTS) flat.tangents.resize(count);
    tbb::parallel_for(std::size_t(0), count, [&](std::size_t i) {
        const auto vertex = source_of(scene, flat, i).vertex;
        if (features & FEATURE_TEXTURES) {
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
        throw Error(ExitCode::bad_scene, fmt::format("{}: {} materials, the limit is {}", scene.file.string(),
                                                     scene.materials.size(), PATH_NO_MEDIUM - 1));
    }
    flat.frame = make_frame(scene);
    TextureTable textures(scene);
    const std::vector<SurfaceTraits> traits = traits_of(scene);
    for (std::size_t i = 0; i < traits.size(); ++i) {
        flat.materials.push_back(surface_of(scene.materials[i], traits[i], flat.frame.scale, textures));
    }
    flat.textures = textures.lookups();
    flat.images = textures.take_texels();
    add_triangles(scene, traits, flat);
    add_lights(scene, flat);
    flat.features = features_of(scene, traits, flat);
    add_attributes(scene, flat);
    return flat;
}

}  // namespace vkcppm
