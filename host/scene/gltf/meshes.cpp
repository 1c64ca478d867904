#include "scene/gltf/meshes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>
#include <tiny_gltf.h>

#include "scene/bad_scene.h"
#include "scene/gltf/limits.h"
#include "scene/gltf/materials.h"
#include "scene/gltf/placement.h"
#include "scene/gltf/primitives.h"
#include "scene/gltf/values.h"
#include "scene/instances.h"

namespace vkcppm {

namespace {

/// A vertex in the world. What it does not have takes no room where no other has it either.
struct Vertex {
    glm::dvec3 position;
    glm::vec3 normal;
    std::array<std::optional<glm::vec2>, 2> uv;
    std::optional<glm::vec4> color;
    std::optional<glm::vec4> tangent;
};

// That each triangle takes at least while its BVH is built: in the scene 16, its corners 36, its box, its place and its
// node 76 (host/flat/bvh.cpp).
constexpr std::size_t bytes_a_triangle = 128;

const Placement identity = *Placement::of(glm::dmat4(1.0));
const glm::vec2 no_uv(0.0f);
const glm::vec4 white(1.0f);
const glm::vec4 no_tangent(0.0f);

/// Sets values[i], the next of a vector that is empty until the first value is there.
template <typename T> void append(std::vector<T>& values, std::size_t i, const std::optional<T>& value, const T& none) {
    if (values.empty() && !value) return;
    values.resize(i, none);
    values.push_back(value.value_or(none));
}

/// Room for `more` values, in steps that grow, as many small additions must not copy all each time.
template <typename T> void reserve_more(std::vector<T>& values, std::size_t more) {
    const std::size_t needed = values.size() + more;
    if (needed > values.capacity()) values.reserve(std::max(needed, values.capacity() * 3 / 2));
}

template <typename T> std::optional<T> element(const std::vector<T>& values, std::size_t i) {
    return i < values.size() ? std::optional(values[i]) : std::nullopt;
}

/// Triangles that sharing must spare, over all meshes, and that a mesh must have to be shared.
constexpr std::size_t most_copied = std::size_t(1) << 18;
constexpr std::size_t fewest_shared = 8;

/// A mesh as nodes show it.
struct MeshKey {
    int mesh;
    int owner;  // PrimitiveReader::owner
    auto operator<=>(const MeshKey&) const = default;
};

/// What a mesh adds to the scene.
struct MeshUse {
    std::size_t triangles = 0;
    std::size_t instances = 0;
    bool is_shareable = false;
    bool is_shared = false;
    std::optional<std::uint32_t> shared;  // into Scene::meshes, once it is read
};

class MeshAdder {
public:
    MeshAdder(const GltfFile& file, const tinygltf::Model& model, GltfAccessors& accessors, GltfSkins& skins,
              Sharing sharing, Scene& scene, Warnings& warnings)
        : file_(file),
          model_(model),
          accessors_(accessors),
          skins_(skins),
          primitives_(file, model, accessors, skins, warnings),
          sharing_(sharing),
          scene_(scene),
          warnings_(warnings),
          file_materials_(scene.materials.size()) {}

    void add(const std::vector<PlacedNode>& nodes) {
        plan(nodes);
        for (const PlacedNode& node : nodes) {
            if (model_.nodes[node.index].mesh >= 0) add_node(node);
        }
        const auto world = std::uint32_t(scene_.triangles.size());
        for (SharedMesh& mesh : scene_.meshes) mesh.first_triangle += world;
        if (!shared_triangles_.empty()) scene_.triangles.reserve(world + shared_triangles_.size());
        scene_.triangles.insert(scene_.triangles.end(), shared_triangles_.begin(), shared_triangles_.end());
        if (degenerate_triangles_ > 0) {
            warnings_.add(fmt::format("{} dropped", degenerate_triangles_), "triangles of zero area");
        }
        const std::size_t vertices = scene_.positions.size();
        for (std::vector<glm::vec2>& uv : scene_.uv) {
            if (!uv.empty()) uv.resize(vertices, no_uv);
        }
        if (!scene_.colors.empty()) scene_.colors.resize(vertices, white);
        if (!scene_.tangents.empty()) scene_.tangents.resize(vertices, no_tangent);
    }

private:
    MeshKey key_of(int node) { return {model_.nodes[node].mesh, primitives_.owner(node)}; }

    bool emits(int mesh) const {
        return std::ranges::any_of(model_.meshes[mesh].primitives, [&](const tinygltf::Primitive& source) {
            return source.material >= 0 && scene_.materials[source.material].emission != glm::vec3(0.0f);
        });
    }

    /// Decides which meshes are shared, and limits what those of all nodes add up to, before any is read: a small file
    /// can name one mesh very often.
    void plan(const std::vector<PlacedNode>& nodes) {
        std::vector<std::size_t> triangles(model_.meshes.size());
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            for (const tinygltf::Primitive& source : model_.meshes[i].primitives) {
                triangles[i] += triangle_count(source, accessors_);
                check_total(triangles[i], max_triangles, fmt::format("triangles of meshes[{}]", i), file_);
            }
        }
        std::size_t all_primitives = 0, all_instances = 0;
        for (const PlacedNode& node : nodes) {
            const int mesh = model_.nodes[node.index].mesh;
            if (mesh < 0) continue;
            // No product overflows: both of its factors are within their limits.
            const std::size_t count = skins_.joints(node.index) ? 1 : instance_count(file_, accessors_, node.index);
            check_total(count, max_instances, fmt::format("instances of nodes[{}]", node.index), file_);
            check_total(all_instances += count, max_instances, "instances", file_);
            MeshUse& use = uses_[key_of(node.index)];
            use.triangles = triangles[mesh];
            use.instances += count;
        }
        std::size_t spared = 0;
        for (auto& [key, use] : uses_) {
            use.is_shareable = sharing_ != Sharing::never && use.instances > 1 && use.triangles > 0 && !emits(key.mesh);
            if (sharing_ == Sharing::by_cost && use.triangles < fewest_shared) use.is_shareable = false;
            if (use.is_shareable) spared += (use.instances - 1) * use.triangles;
        }
        std::size_t all_triangles = 0;
        for (auto& [key, use] : uses_) {
            use.is_shared = use.is_shareable && (sharing_ == Sharing::always || spared > most_copied);
            const std::size_t copies = use.is_shared ? 1 : use.instances;
            check_total(all_triangles += copies * use.triangles, max_triangles, "triangles", file_);
            check_total(all_primitives += copies * model_.meshes[key.mesh].primitives.size(), max_primitives,
                        "primitives", file_);
        }
        check_room(all_triangles, bytes_a_triangle, "triangles", file_.name);
    }

    void add_node(const PlacedNode& node) {
        const std::string object = fmt::format("nodes[{}]", node.index);
        scene_.mesh_nodes.push_back(
            {std::uint32_t(node.index), model_.nodes[node.index].name, std::uint32_t(scene_.triangles.size())});
        MeshUse& use = uses_.at(key_of(node.index));
        if (skins_.joints(node.index)) {
            // Joints place it in the world; what of it has no weights stands where its node does, if that can be.
            add_primitives(node.index, Placement::of(node.to_world).value_or(identity), scene_.triangles);
            return;
        }
        for (const glm::dmat4& to_world : instances(file_, accessors_, node, warnings_)) {
            const std::optional<Placement> placement = Placement::of(to_world);
            if (!placement) {
                warnings_.add("its mesh is dropped, the transform is singular", object);
                continue;
            }
            if (use.is_shared && is_shareable(to_world)) {
                add_instance(node.index, to_world, use);
            } else {
                add_primitives(node.index, *placement, scene_.triangles);
            }
        }
    }

    void add_primitives(int node, const Placement& placement, std::vector<Triangle>& triangles) {
        const int mesh = model_.nodes[node].mesh;
        VertexBlocks blocks;
        for (std::size_t i = 0; i < model_.meshes[mesh].primitives.size(); ++i) {
            add_primitive(node, mesh, i, placement, blocks, triangles);
        }
        check_total(scene_.triangles.size() + shared_triangles_.size(), max_triangles, "triangles", file_);
    }

    void add_instance(int node, const glm::dmat4& to_world, MeshUse& use) {
        const auto mesh_node = std::uint32_t(scene_.mesh_nodes.size() - 1);
        if (!use.shared) {
            use.shared = std::uint32_t(scene_.meshes.size());
            scene_.meshes.push_back({std::uint32_t(shared_triangles_.size()), mesh_node});
            add_primitives(node, identity, shared_triangles_);
            SceneBox& box = boxes_.emplace_back(SceneBox::nothing());
            for (std::size_t i = scene_.meshes.back().first_triangle; i < shared_triangles_.size(); ++i) {
                for (const std::uint32_t v : shared_triangles_[i].vertex) box.grow(scene_.positions[v]);
            }
        }
        const SceneBox& box = boxes_[*use.shared];
        if (box.is_empty()) return;  // all of its triangles were dropped
        for (int corner = 0; corner < 8; ++corner) {
            const auto side = [&](int axis) { return (corner >> axis & 1 ? box.high : box.low)[axis]; };
            check_position(glm::dvec3(to_world * glm::dvec4(side(0), side(1), side(2), 1.0)), node);
        }
        scene_.instances.push_back({glm::dmat4x3(to_world), *use.shared, mesh_node});
    }

    /// First vertex in the scene of what primitives of one mesh instance share: the same attributes.
    using VertexBlocks = std::map<std::array<const void*, 6>, std::size_t>;

    void add_primitive(int node, int mesh, std::size_t index, const Placement& placement, VertexBlocks& blocks,
                       std::vector<Triangle>& triangles) {
        const tinygltf::Primitive& source = model_.meshes[mesh].primitives[index];
        if (!has_triangles(source)) {
            warnings_.add(
                source.mode < TINYGLTF_MODE_TRIANGLES ? "points and lines are skipped" : "skipped, it has no POSITION",
                fmt::format("meshes[{}].primitives[{}]", mesh, index));
            return;
        }
        if (triangle_count(source, accessors_) == 0) {
            warnings_.add("skipped, it has no triangle", fmt::format("meshes[{}].primitives[{}]", mesh, index));
            return;
        }
        const std::uint32_t material = material_index(source);
        const LocalPrimitive& local = primitives_.read(node, mesh, index, vertex_needs(scene_.materials[material]));
        const Placement& at = local.is_posed ? identity : placement;
        if (local.normals) {
            add_smooth(local, at, material, first_vertex(local, node, at, blocks), triangles);
        } else {
            add_flat(local, node, at, material, triangles);
        }
    }

    /// The material of a primitive; glTF's default, added once, where it names none.
    std::uint32_t material_index(const tinygltf::Primitive& primitive) {
        if (primitive.material >= 0) return std::uint32_t(primitive.material);
        if (scene_.materials.size() == file_materials_) scene_.materials.emplace_back().name = "default";
        return std::uint32_t(file_materials_);
    }

    void check_position(const glm::dvec3& p, int node) const {
        if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= max_coordinate && is_finite(p)) return;
        bad_scene(file_.name, fmt::format("the world position of a vertex of nodes[{}]", node), to_text(p),
                  fmt::format("the limit is {}", max_coordinate));
    }

    /// Vertex i of a primitive in the world, its position checked, without its normal.
    Vertex placed(const LocalPrimitive& local, std::size_t i, int node, const Placement& placement) const {
        Vertex vertex;
        vertex.position = placement.point((*local.positions)[i]);
        check_position(vertex.position, node);
        for (std::size_t set = 0; set < 2; ++set) {
            if (local.uv[set]) vertex.uv[set] = glm::vec2((*local.uv[set])[i]);
        }
        if (local.colors) vertex.color = glm::vec4((*local.colors)[i]);
        if (local.tangents) vertex.tangent = placement.tangent((*local.tangents)[i]);
        return vertex;
    }

    /// For so many vertices more: one large primitive then takes no more than it needs.
    void make_room(std::size_t vertices) {
        reserve_more(scene_.positions, vertices);
        reserve_more(scene_.normals, vertices);
    }

    std::uint32_t add_vertex(const Vertex& vertex) {
        const std::size_t i = scene_.positions.size();
        check_total(i + 1, max_vertices, "vertices", file_);
        scene_.positions.push_back(vertex.position);
        scene_.normals.push_back(vertex.normal);
        for (std::size_t set = 0; set < 2; ++set) append(scene_.uv[set], i, vertex.uv[set], no_uv);
        append(scene_.colors, i, vertex.color, white);
        append(scene_.tangents, i, vertex.tangent, no_tangent);
        return std::uint32_t(i);
    }

    /// Another vertex like vertex i, with a normal of its own.
    std::uint32_t add_copy(std::size_t i, const glm::vec3& normal) {
        return add_vertex({scene_.positions[i],
                           normal,
                           {element(scene_.uv[0], i), element(scene_.uv[1], i)},
                           element(scene_.colors, i),
                           element(scene_.tangents, i)});
    }

    /// Puts the vertices of a primitive with normals into the scene, once an instance, and returns the first.
    std::size_t first_vertex(const LocalPrimitive& local, int node, const Placement& placement, VertexBlocks& blocks) {
        const auto [block, is_new] = blocks.try_emplace({local.positions.get(), local.normals.get(), local.uv[0].get(),
                                                         local.uv[1].get(), local.colors.get(), local.tangents.get()},
                                                        scene_.positions.size());
        if (is_new) make_room(local.positions->size());
        for (std::size_t i = 0; is_new && i < local.positions->size(); ++i) {
            Vertex vertex = placed(local, i, node, placement);
            vertex.normal = placement.normal((*local.normals)[i]);
            add_vertex(vertex);
        }
        return block->second;
    }

    /// cross(p1 - p0, p2 - p0) as a unit vector; zero, and counted, where the area is zero.
    glm::vec3 geometric_normal(const std::array<glm::dvec3, 3>& p) {
        const glm::vec3 normal(unit_or_zero(glm::cross(p[1] - p[0], p[2] - p[0])));
        if (normal == glm::vec3(0.0f)) ++degenerate_triangles_;
        return normal;
    }

    /// The corners counter-clockwise in the world: a mirroring transform turns them over.
    static CornerIndices wound(CornerIndices corners, const Placement& placement) {
        if (placement.mirrored) std::swap(corners[1], corners[2]);
        return corners;
    }

    void add_smooth(const LocalPrimitive& local, const Placement& placement, std::uint32_t material, std::size_t first,
                    std::vector<Triangle>& triangles) {
        reserve_more(triangles, local.triangles.size());
        for (const CornerIndices& corners : local.triangles) {
            Triangle triangle{wound(corners, placement), material};
            std::array<glm::dvec3, 3> p;
            for (int k = 0; k < 3; ++k) {
                triangle.vertex[k] += std::uint32_t(first);
                p[k] = scene_.positions[triangle.vertex[k]];
            }
            const glm::vec3 geometric = geometric_normal(p);
            if (geometric == glm::vec3(0.0f)) continue;
            for (int k = 0; k < 3; ++k) {
                if (scene_.normals[triangle.vertex[k]] != glm::vec3(0.0f)) continue;
                triangle.vertex[k] = add_copy(triangle.vertex[k], geometric);
                warnings_.add("no direction, the triangle's own is used", "a normal");
            }
            triangles.push_back(triangle);
        }
    }

    /// Three vertices a triangle with its own normal, as glTF 2.0, section 3.7.2.1, asks for where NORMAL is missing.
    void add_flat(const LocalPrimitive& local, int node, const Placement& placement, std::uint32_t material,
                  std::vector<Triangle>& triangles) {
        make_room(3 * local.triangles.size());
        reserve_more(triangles, local.triangles.size());
        for (const CornerIndices& corners : local.triangles) {
            Triangle triangle{wound(corners, placement), material};
            std::array<Vertex, 3> vertices;
            for (int k = 0; k < 3; ++k) vertices[k] = placed(local, triangle.vertex[k], node, placement);
            const glm::vec3 geometric =
                geometric_normal({vertices[0].position, vertices[1].position, vertices[2].position});
            if (geometric == glm::vec3(0.0f)) continue;
            for (int k = 0; k < 3; ++k) {
                vertices[k].normal = geometric;
                triangle.vertex[k] = add_vertex(vertices[k]);
            }
            triangles.push_back(triangle);
        }
    }

    const GltfFile& file_;
    const tinygltf::Model& model_;
    GltfAccessors& accessors_;
    GltfSkins& skins_;
    PrimitiveReader primitives_;
    const Sharing sharing_;
    Scene& scene_;
    Warnings& warnings_;
    const std::size_t file_materials_;
    std::map<MeshKey, MeshUse> uses_;
    std::vector<Triangle> shared_triangles_;  // of all shared meshes
    std::vector<SceneBox> boxes_;             // [Scene::meshes] in their own space
    std::size_t degenerate_triangles_ = 0;
};

}  // namespace

std::vector<bool> used_materials(const GltfFile& file, const tinygltf::Model& model,
                                 const std::vector<PlacedNode>& nodes) {
    std::vector<bool> is_used(file.document.value("materials", nlohmann::json::array()).size());
    std::vector<bool> is_seen(model.meshes.size());
    for (const PlacedNode& node : nodes) {
        const int mesh = model.nodes[node.index].mesh;
        if (mesh < 0 || is_seen[mesh]) continue;
        is_seen[mesh] = true;
        for (const tinygltf::Primitive& primitive : model.meshes[mesh].primitives) {
            if (primitive.material >= 0 && has_triangles(primitive)) is_used[primitive.material] = true;
        }
    }
    return is_used;
}

void add_meshes(const GltfFile& file, const tinygltf::Model& model, GltfAccessors& accessors, GltfSkins& skins,
                const std::vector<PlacedNode>& nodes, Sharing sharing, Scene& scene, Warnings& warnings) {
    MeshAdder(file, model, accessors, skins, sharing, scene, warnings).add(nodes);
}

}  // namespace vkcppm
