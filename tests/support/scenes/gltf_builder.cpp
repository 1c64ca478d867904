#include "support/scenes/gltf_builder.h"

namespace vkcppm::test {

namespace {

std::string base64(const std::string& bytes) {
    constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? std::uint8_t(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[bits >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

std::string u32(std::size_t value) {
    std::string bytes;
    for (int shift = 0; shift < 32; shift += 8) bytes += char(value >> shift & 255);
    return bytes;
}

std::string padded(std::string text, char fill) {
    text.resize((text.size() + 3) / 4 * 4, fill);
    return text;
}

}  // namespace

std::string GltfBuilder::gltf_with_uri(const std::string& uri) const {
    nlohmann::json whole = document;
    if (!buffer_.empty()) whole["buffers"] = {{{"byteLength", buffer_.size()}, {"uri", uri}}};
    return whole.dump();
}

std::string GltfBuilder::gltf() const { return gltf_with_uri(data_uri(bytes(), "application/octet-stream")); }

std::string GltfBuilder::glb() const {
    nlohmann::json whole = document;
    whole["buffers"] = {{{"byteLength", buffer_.size()}}};
    const std::string json = padded(whole.dump(), ' '), binary = padded(bytes(), '\0');
    return "glTF" + u32(2) + u32(12 + 8 + json.size() + 8 + binary.size()) + u32(json.size()) + "JSON" + json +
           u32(binary.size()) + std::string("BIN\0", 4) + binary;
}

std::string data_uri(const std::string& bytes, const std::string& media_type) {
    return "data:" + media_type + ";base64," + base64(bytes);
}

GltfBuilder one_triangle() {
    GltfBuilder builder;
    builder.mesh({{"attributes", {{"POSITION", builder.float3({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})}}}});
    builder.add("nodes", {{"mesh", 0}});
    return builder;
}

GltfBuilder grid(int n) {
    GltfBuilder builder;
    std::vector<Float3> positions;
    std::vector<std::array<float, 2>> uv;
    std::vector<std::array<std::uint8_t, 4>> colors;
    std::vector<std::uint16_t> indices;
    for (int y = 0; y <= n; ++y) {
        for (int x = 0; x <= n; ++x) {
            positions.push_back({float(x), float(y), 0.25f * float((3 * x + 5 * y) % 7)});
            uv.push_back({float(x) / float(n), float(y) / float(n)});
            colors.push_back({std::uint8_t(10 * x), std::uint8_t(20 * y), 200, 255});
            if (x == n || y == n) continue;
            const int corner = y * (n + 1) + x;
            for (const int i : {0, 1, n + 2, 0, n + 2, n + 1}) indices.push_back(std::uint16_t(corner + i));
        }
    }
    const std::size_t count = positions.size();
    const int color = builder.accessor(builder.view(colors), "VEC4", 5121, count);
    builder.document["accessors"][color]["normalized"] = true;
    builder.mesh({{"attributes",
                   {{"POSITION", builder.float3(positions)},
                    {"NORMAL", builder.float3(std::vector<Float3>(count, Float3{0, 0, 1}))},
                    {"TEXCOORD_0", builder.accessor(builder.view(uv), "VEC2", 5126, count)},
                    {"COLOR_0", color}}},
                  {"indices", builder.u16(indices)}});
    builder.add("nodes", {{"mesh", 0}});
    return builder;
}

}  // namespace vkcppm::test
