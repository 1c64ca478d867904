#include "scene/gltf/meshopt.h"

#include <meshoptimizer.h>
#include <nlohmann/json.hpp>

#include "scene/bad_scene.h"

namespace vkcppm {

std::vector<std::uint8_t> decode_meshopt(const nlohmann::json& extension, std::span<const std::uint8_t> compressed,
                                         std::size_t size, const std::string& object, const std::string& file) {
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
    if (filter == "QUATERNION") require(stride == 8, "byteStride", stride, "QUATERNION needs 8");
    require(size % stride == 0 && size / stride == count, "count", count,
            fmt::format("{} bytes each, they must fill the {} of the bufferView", stride, size));
    // Two bits stand for 16 equal bytes at best, and a block's last group may be short.
    constexpr std::size_t best_ratio = 64;
    require(size / best_ratio <= compressed.size(), "byteLength", compressed.size(),
            fmt::format("too few for {} bytes, the format makes at most {} of one", size, best_ratio));

    std::vector<std::uint8_t> bytes(size);
    int (*decode)(void*, std::size_t, std::size_t, const unsigned char*, std::size_t) = meshopt_decodeVertexBuffer;
    if (mode == "TRIANGLES") decode = meshopt_decodeIndexBuffer;
    if (mode == "INDICES") decode = meshopt_decodeIndexSequence;
    const int failure = decode(bytes.data(), count, stride, compressed.data(), compressed.size());
    if (failure != 0) {
        bad_scene(file, object, fmt::format("broken (meshoptimizer's error {})", failure),
                  fmt::format("its data must be {} of EXT_meshopt_compression", mode));
    }
    if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(bytes.data(), count, stride);
    if (filter == "QUATERNION") meshopt_decodeFilterQuat(bytes.data(), count, stride);
    if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), count, stride);
    return bytes;
}

}  // namespace vkcppm
