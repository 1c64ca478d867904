#include "support/scenes/draco.h"

#include <map>
#include <stdexcept>

#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

namespace vkcppm::test {
namespace {

using nlohmann::json;

draco::DataType data_type(int component) {
    static const std::map<int, draco::DataType> types = {{5120, draco::DT_INT8},   {5121, draco::DT_UINT8},
                                                         {5122, draco::DT_INT16},  {5123, draco::DT_UINT16},
                                                         {5125, draco::DT_UINT32}, {5126, draco::DT_FLOAT32}};
    return types.at(component);
}

draco::GeometryAttribute::Type use_of(const std::string& name) {
    if (name == "POSITION") return draco::GeometryAttribute::POSITION;
    if (name == "NORMAL") return draco::GeometryAttribute::NORMAL;
    if (name.starts_with("TEXCOORD")) return draco::GeometryAttribute::TEX_COORD;
    if (name.starts_with("COLOR")) return draco::GeometryAttribute::COLOR;
    return draco::GeometryAttribute::GENERIC;
}

/// The elements of an accessor, packed.
std::string data_of(const GltfBuilder& builder, const json& accessor, std::size_t element) {
    const json& view = builder.document["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    return builder.bytes().substr(view["byteOffset"].get<std::size_t>(),
                                  accessor["count"].get<std::size_t>() * element);
}

}  // namespace

void compress_by_draco(GltfBuilder& builder, std::size_t mesh, const DracoFormat& format) {
    json& primitive = builder.document["meshes"][mesh]["primitives"][0];
    json& accessors = builder.document["accessors"];
    draco::Mesh source;
    const std::map<std::string, std::size_t> attributes = primitive["attributes"];
    source.set_num_points(accessors[attributes.at("POSITION")]["count"].get<std::uint32_t>());
    json ids;
    for (const auto& [name, index] : attributes) {
        const json& accessor = accessors[index];
        const int components = accessor["type"] == "SCALAR" ? 1 : accessor["type"].get<std::string>().back() - '0';
        const draco::DataType type = data_type(accessor["componentType"]);
        const int stride = components * draco::DataTypeLength(type);
        draco::GeometryAttribute attribute;
        attribute.Init(use_of(name), nullptr, std::uint8_t(components), type, accessor.value("normalized", false),
                       stride, 0);
        const int id = source.AddAttribute(attribute, true, source.num_points());
        const std::string data = data_of(builder, accessor, std::size_t(stride));
        for (std::uint32_t i = 0; i < source.num_points(); ++i) {
            source.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), data.data() + i * stride);
        }
        ids[name] = source.attribute(id)->unique_id();
    }
    const json& indices = accessors[primitive["indices"].get<std::size_t>()];
    const std::string corners = data_of(builder, indices, 2);
    for (std::size_t i = 0; i + 5 < corners.size(); i += 6) {
        std::array<std::uint16_t, 3> corner;
        std::memcpy(corner.data(), corners.data() + i, sizeof corner);
        source.AddFace({draco::PointIndex(corner[0]), draco::PointIndex(corner[1]), draco::PointIndex(corner[2])});
    }
    draco::ExpertEncoder encoder(source);
    encoder.SetTrackEncodedProperties(true);
    encoder.SetEncodingMethod(format.sequential ? draco::MESH_SEQUENTIAL_ENCODING : draco::MESH_EDGEBREAKER_ENCODING);
    if (format.position_bits > 0) {
        encoder.SetAttributeQuantization(source.GetNamedAttributeId(draco::GeometryAttribute::POSITION),
                                         format.position_bits);
    }
    draco::EncoderBuffer encoded;
    const draco::Status status = encoder.EncodeToBuffer(&encoded);
    if (!status.ok()) throw std::runtime_error(status.error_msg_string());

    const int view = builder.view(std::vector<char>(encoded.data(), encoded.data() + encoded.size()));
    primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", view}, {"attributes", ids}};
    for (const auto& [name, index] : attributes) {
        accessors[index].erase("bufferView");
        accessors[index]["count"] = encoder.num_encoded_points();
    }
    accessors[primitive["indices"].get<std::size_t>()].erase("bufferView");
    accessors[primitive["indices"].get<std::size_t>()]["count"] = 3 * encoder.num_encoded_faces();
    builder.document["extensionsUsed"].push_back("KHR_draco_mesh_compression");
    builder.document["extensionsRequired"].push_back("KHR_draco_mesh_compression");
}

}  // namespace vkcppm::test
