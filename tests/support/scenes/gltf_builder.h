#pragma once
// Small glTF files for tests: a JSON document that stays open to change, and one buffer that grows.

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace vkcppm::test {

using Float3 = std::array<float, 3>;
inline constexpr float float_nan = std::numeric_limits<float>::quiet_NaN();

class GltfBuilder {
public:
    nlohmann::json document = {{"asset", {{"version", "2.0"}}}};

    /// Appends `elements` to the buffer, aligned to 4 bytes, and returns the index of a bufferView of them.
    template <typename T> int view(const std::vector<T>& elements) {
        buffer_.resize((buffer_.size() + 3) / 4 * 4);
        const std::size_t offset = buffer_.size(), size = elements.size() * sizeof(T);
        buffer_.resize(offset + size);
        std::memcpy(buffer_.data() + offset, elements.data(), size);
        return add("bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}});
    }

    /// An accessor over a whole view; `type` is glTF's name, `component` its number of the component type.
    int accessor(int view, const char* type, int component, std::size_t count) {
        return add("accessors", {{"bufferView", view}, {"type", type}, {"componentType", component}, {"count", count}});
    }

    int float3(const std::vector<Float3>& values) { return accessor(view(values), "VEC3", 5126, values.size()); }
    int u16(const std::vector<std::uint16_t>& values) { return accessor(view(values), "SCALAR", 5123, values.size()); }

    /// Appends to a root array and returns the index.
    int add(const char* array, const nlohmann::json& element) {
        document[array].push_back(element);
        return int(document[array].size()) - 1;
    }

    /// A mesh of one primitive, e.g. {{"attributes", {{"POSITION", 0}}}}.
    int mesh(const nlohmann::json& primitive) { return add("meshes", {{"primitives", {primitive}}}); }

    /// The first primitive of the first mesh.
    nlohmann::json& primitive() { return document["meshes"][0]["primitives"][0]; }

    /// The index of a texture without sampler whose image is the bytes of a picture's file, in a bufferView.
    int texture(const std::string& file) {
        const int data = view(std::vector<char>(file.begin(), file.end()));
        return add("textures", {{"source", add("images", {{"bufferView", data}, {"mimeType", "image/png"}})}});
    }

    /// The document as .gltf, its buffer as a base64 data URI.
    std::string gltf() const;

    /// The document as .gltf, its buffer named by `uri` and left to the caller: see bytes().
    std::string gltf_with_uri(const std::string& uri) const;

    /// The document and the buffer as .glb.
    std::string glb() const;

    std::string bytes() const { return std::string(buffer_.begin(), buffer_.end()); }

private:
    std::vector<char> buffer_;
};

/// "data:<media type>;base64,..."
std::string data_uri(const std::string& bytes, const std::string& media_type);

/// One triangle (0,0,0), (1,0,0), (0,1,0) without normals at a node without transform: the least file that shows
/// something. Accessor 0 is POSITION, mesh 0, node 0.
GltfBuilder one_triangle();

/// n x n squares of two triangles that face +z and rise by a wave, with normals, texture coordinates and colours of
/// bytes: mesh 0 at node 0.
GltfBuilder grid(int n);

}  // namespace vkcppm::test
