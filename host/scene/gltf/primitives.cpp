#include "scene/gltf/primitives.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <utility>

#include <tiny_gltf.h>

#include "scene/bad_scene.h"
#include "scene/gltf/limits.h"
#include "scene/gltf/placement.h"
#include "scene/gltf/values.h"

namespace vkcppm {

namespace {

using nlohmann::json;

constexpr std::uint32_t primitive_restart = UINT32_MAX;  // among indices of any type, once they are read

/// Appends the triangles of glTF 2.0, section 3.7.2.1, in its order and winding: a list, a strip or a fan of `indices`.
void assemble_triangles(int mode, std::span<const std::uint32_t> indices, std::vector<CornerIndices>& triangles) {
    const std::size_t n = indices.size();
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        triangles.reserve(n / 3);
        for (std::size_t i = 0; i + 2 < n; i += 3) triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
        for (std::size_t i = 0; i + 2 < n; ++i) {
            triangles.push_back({indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]});
        }
    } else {
        for (std::size_t i = 0; i + 2 < n; ++i) triangles.push_back({indices[i + 1], indices[i + 2], indices[0]});
    }
}

/// Those of all strips or fans that primitive restart parts; of a list there is one.
std::vector<CornerIndices> assemble_parts(int mode, const std::vector<std::uint32_t>& indices) {
    std::vector<CornerIndices> triangles;
    for (auto begin = indices.begin(); begin < indices.end();) {
        const auto end = std::find(begin, indices.end(), primitive_restart);
        assemble_triangles(mode, std::span(begin, end), triangles);
        begin = end == indices.end() ? end : end + 1;
    }
    return triangles;
}

/// How many corners a primitive has, or 0 where it makes no triangles.
std::size_t corner_count(const tinygltf::Primitive& source, const GltfAccessors& accessors) {
    if (!has_triangles(source)) return 0;
    return accessors.count(source.indices >= 0 ? source.indices : source.attributes.at("POSITION"));
}

bool is_endless(const glm::dvec3& position) { return !is_finite(position); }

/// The positions with the origin for those that are no numbers or infinite; themselves where there are none.
SharedVectors<3> with_finite(const SharedVectors<3>& positions) {
    if (std::ranges::none_of(*positions, is_endless)) return positions;
    auto finite = std::make_shared<std::vector<glm::dvec3>>(*positions);
    std::ranges::replace_if(*finite, is_endless, glm::dvec3(0.0));
    return finite;
}

/// Leaves out the triangles with a corner at no point, of which exporters write some. False: there were none.
bool leave_out_endless(std::vector<CornerIndices>& triangles, const std::vector<glm::dvec3>& positions) {
    const auto has_none = [&](std::uint32_t vertex) { return is_endless(positions[vertex]); };
    return std::erase_if(triangles,
                         [&](const CornerIndices& corners) { return std::ranges::any_of(corners, has_none); }) > 0;
}

bool is_all_zero(const std::vector<double>& weights) {
    return std::ranges::all_of(weights, [](double weight) { return weight == 0.0; });
}

}  // namespace

bool has_triangles(const tinygltf::Primitive& source) {
    return source.mode >= TINYGLTF_MODE_TRIANGLES && source.attributes.contains("POSITION");
}

std::size_t triangle_count(const tinygltf::Primitive& source, const GltfAccessors& accessors) {
    const std::size_t corners = corner_count(source, accessors);
    return source.mode == TINYGLTF_MODE_TRIANGLES ? corners / 3 : std::max<std::size_t>(corners, 2) - 2;
}

const LocalPrimitive& PrimitiveReader::read(int node, int mesh, std::size_t index, const VertexNeeds& needs) {
    const tinygltf::Primitive& source = model_.meshes[mesh].primitives[index];
    const auto [found, is_new] = primitives_.try_emplace({mesh, index, owner(node)});
    if (!is_new) return found->second;

    const std::string object = fmt::format("meshes[{}].primitives[{}]", mesh, index);
    const std::size_t corners = corner_count(source, accessors_);
    if (source.mode == TINYGLTF_MODE_TRIANGLES ? corners % 3 != 0 : corners < 3) {
        warnings_.add("the corners that make no triangle are ignored", object);
    }
    std::vector<double> weights;
    if (!source.targets.empty()) weights = weights_of(node, mesh);
    if (weights.size() > source.targets.size()) {
        warnings_.add("more weights than morph targets, those that are left over are ignored", object);
        weights.resize(source.targets.size());
    }
    found->second = read_new(source, object, needs, weights);
    if (const JointMatrices* joints = skins_.joints(node)) pose(found->second, source, *joints, object);
    return found->second;
}

int PrimitiveReader::owner(int node) {
    const auto has_targets = [](const tinygltf::Primitive& source) { return !source.targets.empty(); };
    const bool has_own_weights = file_.document["nodes"][node].contains("weights") &&
                                 std::ranges::any_of(model_.meshes[model_.nodes[node].mesh].primitives, has_targets);
    return has_own_weights || skins_.joints(node) ? node : -1;
}

/// The default weights of a mesh's morph targets: the node's, else the mesh's, else none.
std::vector<double> PrimitiveReader::weights_of(int node, int mesh) const {
    const json& owner = file_.document["nodes"][node];
    return (owner.contains("weights") ? owner : file_.document["meshes"][mesh]).value("weights", std::vector<double>());
}

LocalPrimitive PrimitiveReader::read_new(const tinygltf::Primitive& source, const std::string& object,
                                         const VertexNeeds& needs, const std::vector<double>& weights) {
    LocalPrimitive primitive;
    const int positions = source.attributes.at("POSITION");
    const SharedVectors<3> at_rest = accessors_.vectors<3>(positions, "POSITION");
    const std::size_t vertices = at_rest->size();
    primitive.positions = morphed(at_rest, source, "POSITION", weights, object);
    primitive.normals = morphed(attribute<3>(source, "NORMAL", vertices, object), source, "NORMAL", weights, object);
    for (std::size_t set = 0; set < 2; ++set) {
        if (needs.uv[set]) primitive.uv[set] = uv(source, set, vertices, object);
    }
    if (needs.frame && !needs.uv[0]) {
        if (source.attributes.contains("TEXCOORD_0")) {
            primitive.uv[0] = uv(source, 0, vertices, object);
        } else if (!source.attributes.contains("TANGENT")) {
            warnings_.add("it has neither tangents nor texture coordinates, its material's anisotropy is not seen",
                          object);
        }
    }
    primitive.colors = colors(source, vertices, object);
    // Without normals there are no tangents either (glTF 2.0, section 3.7.2.1).
    if (needs.tangents && primitive.normals) {
        primitive.tangents =
            morphed(attribute<4>(source, "TANGENT", vertices, object), source, "TANGENT", weights, object);
    }
    for (std::size_t k = 0; k < weights.size(); ++k) {
        for (const auto& [name, accessor] : source.targets[k]) {
            const bool is_moved = name == "POSITION" || name == "NORMAL" || name == "TANGENT";
            if (weights[k] == 0.0 || is_moved || name.starts_with('_')) continue;
            warnings_.add("its morph targets are ignored", fmt::format("{} of {}", name, object));
        }
    }
    primitive.triangles = assemble_parts(source.mode, corner_indices(source, vertices, object));
    const SharedVectors<3> given = primitive.positions;
    SharedVectors<3> of_moved;
    SharedVectors<3>& finite = given == at_rest ? finite_[positions] : of_moved;
    if (!finite) finite = with_finite(given);
    primitive.positions = finite;
    if (finite != given && leave_out_endless(primitive.triangles, *given)) {
        warnings_.add("corners that are no finite numbers, their triangles are left out",
                      fmt::format("{} (POSITION of {})", accessors_.name(positions), object));
    }
    return primitive;
}

/// The accessor of an attribute with one element a vertex; none where the primitive has no such attribute.
std::optional<int> PrimitiveReader::accessor_of(const tinygltf::Primitive& source, const std::string& name,
                                                std::size_t vertices, const std::string& object) const {
    const auto found = source.attributes.find(name);
    if (found == source.attributes.end()) return std::nullopt;
    check_count(found->second, vertices, fmt::format("{} of {}", name, object));
    return found->second;
}

void PrimitiveReader::check_count(int accessor, std::size_t vertices, const std::string& use) const {
    const std::size_t count = accessors_.count(accessor);
    if (count == vertices) return;
    bad_scene(file_.name, fmt::format("{}.count ({})", accessors_.name(accessor), use), fmt::to_string(count),
              fmt::format("POSITION has {}", vertices));
}

/// The vectors of an attribute; null where the primitive has none.
template <int N>
SharedVectors<N> PrimitiveReader::attribute(const tinygltf::Primitive& source, const char* name, std::size_t vertices,
                                            const std::string& object) {
    const std::optional<int> accessor = accessor_of(source, name, vertices, object);
    return accessor ? accessors_.vectors<N>(*accessor, name) : nullptr;
}

/// base + sum of weight * target (glTF 2.0, section 3.7.2.2); the base itself where nothing moves it. The fourth
/// number of tangents, a sign, stays.
template <int N>
SharedVectors<N> PrimitiveReader::morphed(const SharedVectors<N>& base, const tinygltf::Primitive& source,
                                          const char* name, const std::vector<double>& weights,
                                          const std::string& object) {
    if (!base || is_all_zero(weights)) return base;
    moved_vectors_ += base->size() * weights.size();
    check_total(moved_vectors_, max_read_vectors, "vectors of morph targets", file_);
    auto moved = std::make_shared<std::vector<glm::vec<N, double>>>(*base);
    for (std::size_t k = 0; k < weights.size(); ++k) {
        const auto target = source.targets[k].find(name);
        if (weights[k] == 0.0 || target == source.targets[k].end()) continue;
        check_count(target->second, base->size(), fmt::format("{} of {}.targets[{}]", name, object, k));
        const SharedVectors<3>& displacement = accessors_.vectors<3>(target->second, name);
        for (std::size_t i = 0; i < moved->size(); ++i) {
            for (int c = 0; c < 3; ++c) (*moved)[i][c] += weights[k] * (*displacement)[i][c];
        }
    }
    return moved;
}

/// Puts the vertices where the joints that they follow put them, in proportion to their weights, whose sum is taken for
/// 1 (glTF 2.0, section 3.7.3.3).
void PrimitiveReader::pose(LocalPrimitive& primitive, const tinygltf::Primitive& source, const JointMatrices& joints,
                           const std::string& object) {
    const std::size_t vertices = primitive.positions->size();
    std::vector<std::pair<SharedVectors<4>, SharedVectors<4>>> sets;
    for (;;) {
        const std::string joints_name = fmt::format("JOINTS_{}", sets.size());
        const std::string weights_name = fmt::format("WEIGHTS_{}", sets.size());
        const auto of = attribute<4>(source, joints_name.c_str(), vertices, object);
        const auto weights = attribute<4>(source, weights_name.c_str(), vertices, object);
        if (!of || !weights) break;
        sets.emplace_back(of, weights);
    }
    if (sets.empty() || joints.empty()) {
        warnings_.add("its skin is ignored, it has no joints and weights", object);
        return;
    }
    moved_vectors_ += vertices * sets.size();
    check_total(moved_vectors_, max_read_vectors, "vectors that joints move", file_);

    auto positions = std::make_shared<std::vector<glm::dvec3>>(*primitive.positions);
    auto normals = primitive.normals ? std::make_shared<std::vector<glm::dvec3>>(*primitive.normals) : nullptr;
    auto tangents = primitive.tangents ? std::make_shared<std::vector<glm::dvec4>>(*primitive.tangents) : nullptr;
    std::vector<bool> is_mirrored(vertices);
    for (std::size_t i = 0; i < vertices; ++i) {
        glm::dmat4 sum(0.0);
        double weights = 0.0;
        for (const auto& [of, weight] : sets) {
            for (int k = 0; k < 4; ++k) {
                const double joint = (*of)[i][k];
                if ((*weight)[i][k] == 0.0) continue;
                if (!(joint >= 0.0 && joint < double(joints.size()))) {
                    bad_scene(file_.name, fmt::format("joint {} of vertex {} of {}", k, i, object),
                              fmt::to_string(joint), fmt::format("its skin has {}", joints.size()));
                }
                sum += (*weight)[i][k] * joints[std::size_t(joint)];
                weights += (*weight)[i][k];
            }
        }
        if (weights > 0.0 && std::isfinite(weights)) {
            sum /= weights;
        } else {
            warnings_.add("vertices without weights, they follow the first joint", object);
            sum = joints.front();
        }
        (*positions)[i] = glm::dvec3(sum * glm::dvec4((*positions)[i], 1.0));
        const std::optional<Placement> placement = Placement::of(sum);
        is_mirrored[i] = placement && placement->mirrored;
        // Without a direction the triangle's own is taken.
        if (normals) (*normals)[i] = placement ? placement->normal((*normals)[i]) : glm::vec3(0.0f);
        if (tangents) (*tangents)[i] = placement ? placement->tangent((*tangents)[i]) : glm::vec4(0.0f);
    }
    check_finite(*positions, object);
    primitive.positions = positions;
    primitive.normals = normals;
    primitive.tangents = tangents;
    for (CornerIndices& corners : primitive.triangles) {
        if (is_mirrored[corners[0]]) std::swap(corners[1], corners[2]);
    }
    primitive.is_posed = true;
}

void PrimitiveReader::check_finite(const std::vector<glm::dvec3>& posed, const std::string& object) const {
    for (std::size_t i = 0; i < posed.size(); ++i) {
        if (is_finite(posed[i])) continue;
        bad_scene(file_.name, fmt::format("posed element {} (POSITION of {})", i, object), to_text(posed[i]),
                  "a position must be finite");
    }
}

/// A set of texture coordinates, zeros where they are no numbers; null, with a warning, where the primitive has none.
SharedVectors<2> PrimitiveReader::uv(const tinygltf::Primitive& source, std::size_t set, std::size_t vertices,
                                     const std::string& object) {
    const std::string name = fmt::format("TEXCOORD_{}", set);
    const std::optional<int> accessor = accessor_of(source, name, vertices, object);
    if (!accessor) {
        warnings_.add("it is missing, its material's texture is looked up at (0, 0)",
                      fmt::format("{} of {}", name, object));
        return nullptr;
    }
    const auto [cached, is_new] = uv_.try_emplace(*accessor);
    if (!is_new) return cached->second;
    cached->second = accessors_.vectors<2>(*accessor, name);
    const auto is_usable = [](const glm::dvec2& uv) { return std::abs(uv.x) <= max_uv && std::abs(uv.y) <= max_uv; };
    if (!std::ranges::all_of(*cached->second, is_usable)) {
        warnings_.add(fmt::format("texture coordinates beyond {} or no numbers, (0, 0) is taken", max_uv),
                      accessors_.name(*accessor));
        auto mended = std::make_shared<std::vector<glm::dvec2>>(*cached->second);
        std::ranges::replace_if(*mended, std::not_fn(is_usable), glm::dvec2(0.0));
        cached->second = mended;
    }
    return cached->second;
}

/// COLOR_0 as red, green, blue, alpha in 0..1; null where it is missing or white throughout.
SharedVectors<4> PrimitiveReader::colors(const tinygltf::Primitive& source, std::size_t vertices,
                                         const std::string& object) {
    const std::optional<int> index = accessor_of(source, "COLOR_0", vertices, object);
    if (!index) return nullptr;
    const auto [cached, is_new] = colors_.try_emplace(*index);
    if (!is_new) return cached->second;
    auto colors = std::make_shared<std::vector<glm::dvec4>>();
    if (accessors_.components(*index) == 3) {
        for (const glm::dvec3& rgb : *accessors_.vectors<3>(*index, "COLOR_0")) colors->emplace_back(rgb, 1.0);
    } else {
        *colors = *accessors_.vectors<4>(*index, "COLOR_0");
    }
    const std::string accessor = accessors_.name(*index);
    for (std::size_t i = 0; i < colors->size(); ++i) {
        glm::dvec4& color = (*colors)[i];
        for (int c = 0; c < 4; ++c) {
            if (std::isnan(color[c])) {
                warnings_.add("vertex colours that are no numbers, taken for 1", accessor);
                color[c] = 1.0;
            }
            if (color[c] < 0.0 || color[c] > 1.0) warnings_.add("vertex colours outside 0 to 1, clamped", accessor);
            color[c] = std::clamp(color[c], 0.0, 1.0);
        }
    }
    const bool is_white = std::ranges::all_of(*colors, [](const glm::dvec4& c) { return c == glm::dvec4(1.0); });
    if (!is_white) cached->second = colors;
    return cached->second;
}

/// The vertex of each corner in the order of the file: the indices, or 0, 1, 2... without them. In strips and fans
/// primitive_restart as well, which glTF leaves to an extension and graphics cards follow.
std::vector<std::uint32_t> PrimitiveReader::corner_indices(const tinygltf::Primitive& source, std::size_t vertices,
                                                           const std::string& object) {
    if (source.indices < 0) {
        std::vector<std::uint32_t> indices(vertices);
        for (std::size_t i = 0; i < vertices; ++i) indices[i] = std::uint32_t(i);
        return indices;
    }
    auto [indices, restart] = accessors_.indices(source.indices);
    for (std::size_t i = 0; i < indices.size(); ++i) {
        if (indices[i] < vertices && indices[i] != restart) continue;
        if (indices[i] == restart && source.mode != TINYGLTF_MODE_TRIANGLES) {
            indices[i] = primitive_restart;
            warnings_.add("indices that begin a new strip or fan, which glTF leaves to an extension", object);
            continue;
        }
        bad_scene(file_.name, fmt::format("{} element {} (indices of {})", accessors_.name(source.indices), i, object),
                  fmt::to_string(indices[i]),
                  fmt::format("POSITION has {} vertices, and {} is no index", vertices, restart));
    }
    return indices;
}

}  // namespace vkcppm
