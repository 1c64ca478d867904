#include "scene/gltf/draco.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>

#include "scene/bad_scene.h"
#include "scene/gltf/accessor.h"
#include "scene/gltf/limits.h"
#include "scene/gltf/schema.h"
#include "scene/gltf/views.h"

namespace vkcppm {

namespace {

using nlohmann::json;

constexpr const char* extension = "KHR_draco_mesh_compression";
constexpr std::size_t connectivity_bytes_a_triangle = 12;

/// Counts that stand at the beginning of what a decoder calls connectivity.
struct Connectivity {
    std::uint32_t triangles = 0;
    std::uint32_t vertices = 0;
    std::uint8_t seams = 0;  // tables of seams, each of a corner of every triangle

    bool read(draco::DecoderBuffer ahead, const draco::MeshSequentialDecoder&) {
        return draco::DecodeVarint(&triangles, &ahead) && draco::DecodeVarint(&vertices, &ahead);
    }

    bool read(draco::DecoderBuffer ahead, const draco::MeshEdgebreakerDecoder&) {
        std::uint32_t symbols = 0, splits = 0;
        const bool is_whole = draco::DecodeVarint(&vertices, &ahead) && draco::DecodeVarint(&triangles, &ahead) &&
                              ahead.Decode(&seams) && draco::DecodeVarint(&symbols, &ahead) &&
                              draco::DecodeVarint(&splits, &ahead);
        // Each split makes a vertex of its own for a while, and each is one of the symbols.
        return is_whole && splits <= symbols && symbols <= triangles;
    }

    std::size_t bytes() const {
        return connectivity_bytes_a_triangle * triangles * (1 + std::size_t(seams)) + sizeof(float) * vertices;
    }
};

/// A decoder of libdraco that stops where the data claims more than `most` bytes, before there is memory for them:
/// neither the counts of triangles nor those of attributes are held against the bytes by the library.
template <typename Decoder> class LimitedDecoder : public Decoder {
public:
    explicit LimitedDecoder(std::size_t most) : most_(most) {}

    /// Bytes that the data claims, as far as it was read.
    std::size_t claimed() const { return claimed_; }

protected:
    bool DecodeConnectivity() override {
        Connectivity connectivity;
        if (!connectivity.read(*this->buffer(), *this)) return false;
        claimed_ = connectivity.bytes();
        return claimed_ <= most_ && Decoder::DecodeConnectivity();
    }

    bool DecodeAllAttributes() override {
        std::size_t bytes_a_point = 0;
        for (int i = 0; i < this->point_cloud()->num_attributes(); ++i) {
            bytes_a_point += std::size_t(this->point_cloud()->attribute(i)->byte_stride()) + sizeof(std::uint32_t);
        }
        claimed_ += bytes_a_point * this->point_cloud()->num_points();
        return claimed_ <= most_ && Decoder::DecodeAllAttributes();
    }

private:
    std::size_t most_, claimed_ = 0;
};

/// How many numbers an element of the accessor has; 0 of matrices, which no vertex has.
int components_of(const json& accessor) {
    static constexpr std::string_view types[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    for (int i = 0; i < 4; ++i) {
        if (accessor["type"] == types[i]) return i + 1;
    }
    return 0;
}

/// Whether each point has a value of the attribute, whatever the data says.
bool is_whole(const draco::PointAttribute& attribute, std::uint32_t points) {
    if (!attribute.is_mapping_identity() && attribute.indices_map_size() < points) return false;
    for (std::uint32_t i = 0; i < points; ++i) {
        const std::int64_t value = attribute.mapped_index(draco::PointIndex(i)).value();
        if (value >= std::int64_t(attribute.size())) return false;
        const std::int64_t end = attribute.byte_offset() + (value + 1) * attribute.byte_stride();
        if (end > std::int64_t(attribute.buffer()->data_size())) return false;
    }
    return true;
}

/// [points] elements of `components` numbers of type T, packed; false where one does not fit into its type.
template <typename T>
bool append_values(std::vector<std::uint8_t>& bytes, const draco::PointAttribute& attribute, std::uint32_t points,
                   int components) {
    std::array<T, 4> value;
    for (std::uint32_t i = 0; i < points; ++i) {
        const draco::AttributeValueIndex index = attribute.mapped_index(draco::PointIndex(i));
        if (!attribute.ConvertValue<T>(index, std::int8_t(components), value.data())) return false;
        const auto* begin = reinterpret_cast<const std::uint8_t*>(value.data());
        bytes.insert(bytes.end(), begin, begin + components * sizeof(T));
    }
    return true;
}

bool append_values(std::vector<std::uint8_t>& bytes, const draco::PointAttribute& attribute, std::uint32_t points,
                   int components, ComponentType type) {
    switch (type) {
        case ComponentType::i8: return append_values<std::int8_t>(bytes, attribute, points, components);
        case ComponentType::u8: return append_values<std::uint8_t>(bytes, attribute, points, components);
        case ComponentType::i16: return append_values<std::int16_t>(bytes, attribute, points, components);
        case ComponentType::u16: return append_values<std::uint16_t>(bytes, attribute, points, components);
        case ComponentType::u32: return append_values<std::uint32_t>(bytes, attribute, points, components);
        case ComponentType::f32: return append_values<float>(bytes, attribute, points, components);
    }
    return false;
}

class DracoMeshes {
public:
    explicit DracoMeshes(GltfFile& file) : file_(file), views_(file) {}

    /// `primitive`, named `object`, whose extension is `source`.
    void decode(json& primitive, const json& source, const std::string& object) {
        const int mode = primitive.value("mode", triangles_mode);
        if (mode != triangles_mode && mode != strip_mode) {
            bad_scene(file_.name, object + ".mode", fmt::to_string(mode),
                      fmt::format("{} needs {} or {}, triangles", extension, triangles_mode, strip_mode));
        }
        const std::string name = fmt::format("{}.extensions.{}", object, extension);
        const auto decoded = decode(views_.bytes(source["bufferView"].get<std::size_t>()), name);
        const draco::Mesh& mesh = *decoded;
        add_indices(primitive, mesh, mode, object);
        for (const auto& [attribute, id] : source["attributes"].items()) {
            const auto accessor = primitive["attributes"].find(attribute);
            if (accessor == primitive["attributes"].end()) continue;  // nothing says what it is
            const draco::PointAttribute* values = mesh.GetAttributeByUniqueId(id.get<std::uint32_t>());
            if (!values) {
                bad_scene(file_.name, fmt::format("{}.attributes[{}]", name, json_text(attribute)), id.dump(),
                          "its data has no attribute of this number");
            }
            *accessor = add_attribute(accessor->get<std::size_t>(), *values, mesh.num_points(),
                                      fmt::format("{} of {}", json_text(attribute), object), name);
        }
        primitive["mode"] = triangles_mode;  // which Draco's triangles are, whatever they were compressed from
    }

private:
    static constexpr int triangles_mode = 4, strip_mode = 5;

    std::unique_ptr<draco::Mesh> decode(std::span<const std::uint8_t> bytes, const std::string& name) const {
        draco::DecoderBuffer buffer;
        buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        draco::DracoHeader header;
        draco::DecoderBuffer ahead = buffer;
        if (!draco::PointCloudDecoder::DecodeHeader(&ahead, &header).ok()) {
            bad_scene(file_.name, name, "broken", "its data must begin like Draco's");
        }
        if (header.version_major != 2 || header.version_minor != 2) {
            bad_scene(file_.name, "the version of " + name,
                      fmt::format("{}.{}", header.version_major, header.version_minor), "the extension asks for 2.2");
        }
        if (header.encoder_type != draco::TRIANGULAR_MESH) {
            bad_scene(file_.name, name, "points alone", "its data must be a mesh");
        }
        auto mesh = std::make_unique<draco::Mesh>();
        if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING) {
            decode_by<draco::MeshSequentialDecoder>(buffer, *mesh, name);
        } else {
            decode_by<draco::MeshEdgebreakerDecoder>(buffer, *mesh, name);
        }
        return mesh;
    }

    template <typename Decoder>
    void decode_by(draco::DecoderBuffer& buffer, draco::Mesh& mesh, const std::string& name) const {
        LimitedDecoder<Decoder> decoder(max_draco_bytes.of(file_.bytes) - decoded_bytes_);
        const draco::DecoderOptions options;
        const draco::Status status = decoder.Decode(options, &buffer, &mesh);
        check_bytes(decoder.claimed(), name);
        if (!status.ok()) {
            bad_scene(file_.name, name, fmt::format("broken (libdraco: {})", status.error_msg()),
                      "its data must be a mesh of Draco");
        }
    }

    void check_bytes(std::size_t more, const std::string& name) const {
        check_total(decoded_bytes_ + more, max_draco_bytes, "bytes that Draco decodes to, with those of " + name,
                    file_);
    }

    void add_indices(json& primitive, const draco::Mesh& mesh, int mode, const std::string& object) {
        std::vector<std::uint32_t> indices;
        indices.reserve(3 * std::size_t(mesh.num_faces()));
        for (draco::FaceIndex i(0); i < mesh.num_faces(); ++i) {
            for (const draco::PointIndex& point : mesh.face(i)) indices.push_back(point.value());
        }
        const auto stated = primitive.find("indices");
        json accessor = json::object();
        const std::size_t own = stated == primitive.end() ? 0 : stated->get<std::size_t>();
        if (stated != primitive.end()) {
            accessor = file_.document["accessors"][own];
            const auto count = accessor["count"].get<std::size_t>();
            if (mode == triangles_mode && count != indices.size()) {
                bad_scene(file_.name, fmt::format("accessors[{}].count (indices of {})", own, object),
                          fmt::to_string(count), fmt::format("its Draco data has {}", indices.size()));
            }
        }
        accessor["type"] = "SCALAR";
        accessor["componentType"] = int(ComponentType::u32);
        accessor["count"] = indices.size();
        const auto* begin = reinterpret_cast<const std::uint8_t*>(indices.data());
        primitive["indices"] = add_accessor(
            std::move(accessor), own, std::vector<std::uint8_t>(begin, begin + indices.size() * sizeof indices[0]));
    }

    std::size_t add_attribute(std::size_t own, const draco::PointAttribute& values, std::uint32_t points,
                              const std::string& use, const std::string& name) {
        const json accessor = file_.document["accessors"][own];
        const std::string object = fmt::format("accessors[{}]", own);
        const auto count = accessor["count"].get<std::size_t>();
        if (count != points) {
            bad_scene(file_.name, fmt::format("{}.count ({})", object, use), fmt::to_string(count),
                      fmt::format("its Draco data has {}", points));
        }
        const int components = components_of(accessor);
        if (values.num_components() != components) {
            bad_scene(file_.name, object + ".type", accessor["type"].dump(),
                      fmt::format("{} of Draco has {} components", use, int(values.num_components())));
        }
        if (!is_whole(values, points)) bad_scene(file_.name, name, "broken", fmt::format("it lacks values of {}", use));
        const auto type = ComponentType(accessor["componentType"].get<int>());
        std::vector<std::uint8_t> bytes;
        bytes.reserve(points * std::size_t(components) * component_size(type));
        if (!append_values(bytes, values, points, components, type)) {
            bad_scene(file_.name, object + ".componentType", fmt::to_string(int(type)),
                      fmt::format("no type that holds {} of Draco", use));
        }
        return add_accessor(accessor, own, std::move(bytes));
    }

    /// An accessor like accessors[own] over `bytes`, packed, in a view and a buffer of its own.
    std::size_t add_accessor(json accessor, std::size_t own, std::vector<std::uint8_t> bytes) {
        decoded_bytes_ += bytes.size();
        check_total(decoded_bytes_, max_draco_bytes, "bytes that Draco decodes to", file_);
        json& views = file_.document["bufferViews"];
        accessor.erase("sparse");
        accessor.erase("byteOffset");
        accessor["bufferView"] = views.size();
        views.push_back({{"buffer", file_.buffers.size()}, {"byteLength", bytes.size()}});
        file_.buffers.push_back(
            {bytes.size(), std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes)), ""});
        file_.decoded.push_back(own);
        json& accessors = file_.document["accessors"];
        accessors.push_back(std::move(accessor));
        return accessors.size() - 1;
    }

    GltfFile& file_;
    GltfViews views_;
    std::size_t decoded_bytes_ = 0;
};

/// Whether a program without the extension could show the primitive: all of its accessors have data of their own.
bool has_fallback(const GltfFile& file, const json& primitive) {
    if (requires_extension(file, extension)) return false;
    const auto has_data = [&](const json& accessor) {
        return file.document["accessors"][accessor.get<std::size_t>()].contains("bufferView");
    };
    return std::ranges::all_of(primitive["attributes"], has_data) &&
           (!primitive.contains("indices") || has_data(primitive["indices"]));
}

}  // namespace

void decode_draco(GltfFile& file, Warnings& warnings) {
    std::set<std::size_t> shown;
    for (const json& node : file.document.value("nodes", json::array())) {
        if (node.contains("mesh")) shown.insert(node["mesh"].get<std::size_t>());
    }
    if (!file.document.contains("meshes")) return;
    json& meshes = file.document["meshes"];
    std::optional<DracoMeshes> decoder;
    for (std::size_t mesh = 0; mesh < meshes.size(); ++mesh) {
        json& primitives = meshes[mesh]["primitives"];
        for (std::size_t i = 0; i < primitives.size(); ++i) {
            const auto extensions = primitives[i].find("extensions");
            if (extensions == primitives[i].end() || !extensions->contains(extension)) continue;
            const json source = std::move((*extensions)[extension]);
            extensions->erase(extension);  // tinygltf would decode it, unchecked
            if (!shown.contains(mesh)) continue;
            if (!decoder) decoder.emplace(file);
            const std::string object = fmt::format("meshes[{}].primitives[{}]", mesh, i);
            const json uncompressed = primitives[i];
            try {
                decoder->decode(primitives[i], source, object);
            } catch (const Error&) {
                if (!has_fallback(file, uncompressed)) throw;
                primitives[i] = uncompressed;
                warnings.add("its data cannot be read, what the file keeps for other programs is shown",
                             fmt::format("{}.extensions.{}", object, extension));
            }
        }
    }
}

}  // namespace vkcppm
