#include "flat/flatten.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/packing.hpp>

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
    for (const Triangle& triangle : scene.triangles) {
        for (const std::uint32_t v : triangle.vertex) {
            low = glm::min(low, scene.positions[v]);
            high = glm::max(high, scene.positions[v]);
        }
    }
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
    std::vector<Triangle> triangles;    // those, their corners in the order of `corners`
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
    std::vector<Corners> all(scene.triangles.size());
    std::vector<FaceTraits> faces;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Triangle& triangle = scene.triangles[i];
        for (int c = 0; c < 3; ++c) all[i][c] = glm::vec3(frame.point(scene.positions[triangle.vertex[c]]));
        const SurfaceTraits& t = traits[triangle.material];
        faces.push_back({triangle.material, t.emits, t.has(Lobe::transmission) && !t.thin});
    }
    Placed placed;
    placed.source = distinct_triangles(all, faces);
    std::vector<FaceTraits> kept;
    for (const std::uint32_t i : placed.source) {
        placed.corners.push_back(all[i]);
        kept.push_back(faces[i]);
    }
    part_touching_faces(placed.corners, kept);
    for (std::size_t i = 0; i < placed.source.size(); ++i) {
        Triangle triangle = scene.triangles[placed.source[i]];
        const int first = first_corner(placed.corners[i]);
        std::rotate(triangle.vertex.begin(), triangle.vertex.begin() + first, triangle.vertex.end());
        std::rotate(placed.corners[i].begin(), placed.corners[i].begin() + first, placed.corners[i].end());
        placed.triangles.push_back(triangle);
    }
    return placed;
}

void add_triangles(const Scene& scene, const std::vector<SurfaceTraits>& traits, FlatScene& flat) {
    const auto& [sources, triangles, corners] = place_triangles(scene, flat.frame, traits);
    flat.bvh = build_bvh(corners);
    flat.low = glm::vec3(corners.empty() ? 0.0f : std::numeric_limits<float>::infinity());
    flat.high = -flat.low;
    for (std::uint32_t& source : flat.bvh.order) {
        const Corners& placed = corners[source];
        const Triangle& triangle = flat.sources.emplace_back(triangles[source]);
        source = sources[source];
        gpu::TriangleGeometry geometry{};
        geometry.v0 = placed[0];
        geometry.e1 = placed[1] - placed[0];
        geometry.e2 = placed[2] - placed[0];
        geometry.error = position_error(placed);
        // Rounding of s . (d x e2) and d . (s x e1) for |s| = |d| = 1: 12 half-ulps of the edge.
        constexpr float half_ulps_12 = 7.2e-7f;  // 12 x 2^-24, rounded up
        geometry.slack_u = half_ulps_12 * glm::length(geometry.e2);
        geometry.slack_v = half_ulps_12 * glm::length(geometry.e1);
        flat.triangles.push_back(geometry);

        const glm::dvec3 normal = glm::cross(glm::dvec3(geometry.e1), glm::dvec3(geometry.e2));
        const double twice_area = glm::length(normal);
        flat.area += 0.5 * twice_area;
        gpu::TriangleShading shading{};
        bool is_flat = true;
        for (int c = 0; c < 3; ++c) {
            const glm::vec3& n = scene.normals[triangle.vertex[c]];
            shading.normal[c] = pack_direction(n);
            is_flat = is_flat && (twice_area == 0.0 || glm::length(glm::dvec3(n) - normal / twice_area) < 1e-4);
        }
        shading.material = triangle.material | (is_flat ? SHADING_FLAT : 0u);
        flat.shading.push_back(shading);

        for (const glm::vec3& p : placed) {
            flat.low = glm::min(flat.low, p);
            flat.high = glm::max(flat.high, p);
            flat.radius = std::max(flat.radius, double(glm::length(p)));
        }
    }
    flat.low -= float(bounds_padding);
    flat.high += float(bounds_padding);
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
    for (const Triangle& triangle : flat.sources) {
        const auto& vertex = triangle.vertex;
        if (features & FEATURE_TEXTURES) {
            for (const std::uint32_t v : vertex) flat.texcoords.push_back(texcoords_of(scene, v));
        }
        if (features & FEATURE_VERTEX_COLORS) {
            std::array<std::uint32_t, 8> words{};
            for (int c = 0; c < 3; ++c) {
                const glm::vec4& color = scene.colors[vertex[c]];
                words[2 * c] = glm::packHalf2x16(glm::vec2(color.r, color.g));
                words[2 * c + 1] = glm::packHalf2x16(glm::vec2(color.b, color.a));
            }
            flat.vertex_colors.emplace_back(words[0], words[1], words[2], words[3]);
            flat.vertex_colors.emplace_back(words[4], words[5], words[6], words[7]);
        }
        if (features & FEATURE_TANGENTS) {
            glm::uvec4 packed(0);
            for (int c = 0; c < 3; ++c) {
                const glm::vec4& tangent = scene.tangents[vertex[c]];
                if (tangent.w == 0.0f) continue;
                packed[c] = pack_direction(glm::vec3(tangent));
                packed.w |= 1u << c | (tangent.w < 0.0f ? TANGENTS_TURNED << c : 0u);
            }
            flat.tangents.push_back(packed);
        }
    }
}

}  // namespace

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
    flat.images = textures.texels();
    add_triangles(scene, traits, flat);
    add_lights(scene, flat);
    flat.features = features_of(scene, traits, flat);
    add_attributes(scene, flat);
    return flat;
}

}  // namespace vkcppm
