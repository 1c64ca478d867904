#pragma once
// The primitives of glTF meshes in the space of their mesh: attributes and triangles, before they are placed.

#include <array>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "scene/gltf/accessors.h"
#include "scene/gltf/file.h"
#include "scene/gltf/materials.h"
#include "scene/gltf/skins.h"
#include "scene/warnings.h"

namespace tinygltf {
struct Primitive;
}

namespace vkcppm {

using CornerIndices = std::array<std::uint32_t, 3>;

/// One primitive in the space of its mesh. Attributes that are missing or that nothing reads are null.
struct LocalPrimitive {
    SharedVectors<3> positions;          // finite
    SharedVectors<3> normals;            // null: flat
    std::array<SharedVectors<2>, 2> uv;  // not zeros, at most max_uv
    SharedVectors<4> colors;             // 0..1
    SharedVectors<4> tangents;
    std::vector<CornerIndices> triangles;  // into the above, in order and winding of the file
    bool is_posed = false;                 // by joints, and so in the world already
};

/// Whether a primitive makes triangles at all.
bool has_triangles(const tinygltf::Primitive& source);

/// How many triangles, degenerate ones included. Reads no accessor.
std::size_t triangle_count(const tinygltf::Primitive& source, const GltfAccessors& accessors);

/// Reads primitives, each once. Throws Error(bad_input) with object, value, limit and file.
class PrimitiveReader {
public:
    /// Keeps all five.
    PrimitiveReader(const GltfFile& file, const tinygltf::Model& model, GltfAccessors& accessors, GltfSkins& skins,
                    Warnings& warnings)
        : file_(file), model_(model), accessors_(accessors), skins_(skins), warnings_(warnings) {}

    /// The node whose weights or joints make of its mesh one of its own; -1 where the mesh is that of all nodes.
    int owner(int node);

    /// meshes[mesh].primitives[index] as `node` shows it, which has_triangles(). `needs` is its material's.
    const LocalPrimitive& read(int node, int mesh, std::size_t index, const VertexNeeds& needs);

private:
    LocalPrimitive read_new(const tinygltf::Primitive& source, const std::string& object, const VertexNeeds& needs,
                            const std::vector<double>& weights);
    std::vector<double> weights_of(int node, int mesh) const;
    std::optional<int> accessor_of(const tinygltf::Primitive& source, const std::string& name, std::size_t vertices,
                                   const std::string& object) const;
    void check_count(int accessor, std::size_t vertices, const std::string& use) const;
    template <int N>
    SharedVectors<N> attribute(const tinygltf::Primitive& source, const char* name, std::size_t vertices,
                               const std::string& object);
    template <int N>
    SharedVectors<N> morphed(const SharedVectors<N>& base, const tinygltf::Primitive& source, const char* name,
                             const std::vector<double>& weights, const std::string& object);
    SharedVectors<2> uv(const tinygltf::Primitive& source, std::size_t set, std::size_t vertices,
                        const std::string& object);
    SharedVectors<4> colors(const tinygltf::Primitive& source, std::size_t vertices, const std::string& object);
    std::vector<std::uint32_t> corner_indices(const tinygltf::Primitive& source, std::size_t vertices,
                                              const std::string& object);
    void check_finite(const std::vector<glm::dvec3>& posed, const std::string& object) const;
    void pose(LocalPrimitive& primitive, const tinygltf::Primitive& source, const JointMatrices& joints,
              const std::string& object);

    const GltfFile& file_;
    const tinygltf::Model& model_;
    GltfAccessors& accessors_;
    GltfSkins& skins_;
    Warnings& warnings_;
    std::map<std::tuple<int, std::size_t, int>, LocalPrimitive> primitives_;  // by mesh, primitive, owner
    std::map<int, SharedVectors<2>> uv_;                                      // by accessor
    std::map<int, SharedVectors<4>> colors_;                                  // by accessor; null: all white
    std::map<int, SharedVectors<3>> finite_;                                  // by accessor: positions
    std::size_t moved_vectors_ = 0;                                           // by morph targets and joints
};

}  // namespace vkcppm
