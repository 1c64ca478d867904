#include "scene/gltf/meshopt.h"

#include <meshoptimizer.h>
#include <nlohmann/json.hpp>

#include "scene/bad_scene.h"
#include "scene/gltf/meshopt_v1.h"

namespace vkcppm {

namespace {

constexpr const char* khr_meshopt = "KHR_meshopt_compression";

}  // namespace

const char* meshopt_extension(const nlohmann::json& object) {
    const auto extensions = object.find("extensions");
    if (extensions == object.end()) return nullptr;
    for (const char* name : {khr_meshopt, "EXT_meshopt_compression"}) {
        if (extensions->contains(name)) return name;
    }
    return nullptr;
}

std::vector<std::uint8_t> decode_meshopt(const nlohmann::json& view, std::span<const std::uint8_t> compressed,
                                         const std::string& view_name, const std::string& file) {
    const std::string name = meshopt_extension(view);
    const nlohmann::json& extension = view["extensions"][name];
    const std::string object = fmt::format("{}.extensions.{}", view_name, name);
    const auto size = view["byteLength"].get<std::size_t>();
    const bool is_khr = name == khr_meshopt;
    const auto stride = extension["byteStride"].get<std::size_t>(), count = extension["count"].get<std::size_t>();
    const auto mode = extension["mode"].get<std::string>();
    const std::string filter = extension.value("filter", "NONE");
    const auto require = [&](bool holds, const char* member, std::size_t value, std::string_view limit) {
        if (!holds) bad_scene(file, fmt::format("{}.{}", object, member), fmt::to_string(value), limit);
    };
    const bool is_attributes = mode == "ATTRIBUTES";
    if (is_attributes) {
        require(stride % 4 == 0, "byteStride", stride, "for ATTRIBUTES it must be a multiple of 4");
    } else {
        require(stride == 2 || stride == 4, "byteStride", stride, "an index has 2 or 4 bytes");
    }
    if (mode == "TRIANGLES") require(count % 3 == 0, "count", count, "triangles have 3 indices each");
    if (filter != "NONE" && !is_attributes) {
        bad_scene(file, object + ".filter", filter, "a filter needs the mode ATTRIBUTES");
    }
    if (filter == "OCTAHEDRAL") require(stride == 4 || stride == 8, "byteStride", stride, "OCTAHEDRAL needs 4 or 8");
    if (filter == "COLOR") require(stride == 4 || stride == 8, "byteStride", stride, "COLOR needs 4 or 8");
    if (filter == "QUATERNION") require(stride == 8, "byteStride", stride, "QUATERNION needs 8");
    require(size % stride == 0 && size / stride == count, "count", count,
            fmt::format("{} bytes each, they must fill the {} of the bufferView", stride, size));
    // Two bits stand for 16 equal bytes at best, and a block's last group may be short; in version 1 two bits for the
    // 256 of a block.
    const bool is_v1 = is_attributes && is_khr && is_meshopt_v1(compressed);
    const std::size_t best_ratio = is_v1 ? 1024 : 64;
    require(size / best_ratio <= compressed.size(), "byteLength", compressed.size(),
            fmt::format("too few for {} bytes, the format makes at most {} of one", size, best_ratio));

    std::vector<std::uint8_t> bytes(size);
    int (*decode)(void*, std::size_t, std::size_t, const unsigned char*, std::size_t) = meshopt_decodeVertexBuffer;
    if (mode == "TRIANGLES") decode = meshopt_decodeIndexBuffer;
    if (mode == "INDICES") decode = meshopt_decodeIndexSequence;
    const std::string what = fmt::format("its data must be {} of {}", mode, name);
    if (is_v1) {
        if (!decode_meshopt_v1(compressed, stride, bytes)) bad_scene(file, object, "broken", what);
    } else if (const int failure = decode(bytes.data(), count, stride, compressed.data(), compressed.size())) {
        bad_scene(file, object, fmt::format("broken (meshoptimizer's error {})", failure), what);
    }
    if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(bytes.data(), count, stride);
    if (filter == "QUATERNION") meshopt_decodeFilterQuat(bytes.data(), count, stride);
    if (filter == "COLOR") decode_meshopt_colors(bytes, stride);
    if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), count, stride);
    return bytes;
}

}  // namespace vkcppm
