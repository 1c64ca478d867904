#include "scene/gltf/views.h"

#include "scene/gltf/accessor.h"
#include "scene/bad_scene.h"
#include "scene/gltf/limits.h"
#include "scene/gltf/meshopt.h"

namespace vkcppm {

namespace {

using nlohmann::json;

std::string name_of(std::size_t view) { return fmt::format("bufferViews[{}]", view); }

}  // namespace

GltfViews::GltfViews(const GltfFile& file) : file_(file) {
    const auto sources = file.document.find("bufferViews");
    if (sources == file.document.end()) return;
    for (std::size_t i = 0; i < sources->size(); ++i) {
        const json& source = (*sources)[i];
        views_.push_back(range(source, name_of(i)));
        const char* extension = meshopt_extension(source);
        if (!extension) continue;
        compressed_[i] = range(source["extensions"][extension], fmt::format("{}.extensions.{}", name_of(i), extension));
    }
}

GltfViews::View GltfViews::range(const json& source, const std::string& object) const {
    const View view{source["buffer"].get<std::size_t>(), source.value("byteOffset", std::size_t(0)),
                    source["byteLength"].get<std::size_t>(), source.value("byteStride", std::size_t(0))};
    const std::size_t available = file_.buffers[view.buffer].size;
    if (!elements_fit(view.offset, 1, 1, view.size, available)) {
        bad_scene(file_.name, object, fmt::format("{} bytes from {} on", view.size, view.offset),
                  fmt::format("buffers[{}] has {}", view.buffer, available));
    }
    return view;
}

std::span<const std::uint8_t> GltfViews::stored(const View& view) const {
    const GltfBuffer& buffer = file_.buffers[view.buffer];
    if (!buffer.bytes) {
        bad_scene(file_.name, fmt::format("buffers[{}]", view.buffer), "absent", buffer.absent);
    }
    return std::span(*buffer.bytes).subspan(view.offset, view.size);
}

std::span<const std::uint8_t> GltfViews::bytes(std::size_t view) {
    const auto source = compressed_.find(view);
    if (source == compressed_.end()) return stored(views_[view]);
    const auto [decoded, is_new] = decoded_.try_emplace(view);
    if (is_new) {
        decoded_size_ += views_[view].size;
        check_total(decoded_size_, max_decoded_bytes, "bytes of the compressed bufferViews together", file_);
        decoded->second =
            decode_meshopt(file_.document["bufferViews"][view], stored(source->second), name_of(view), file_.name);
    }
    return decoded->second;
}

}  // namespace vkcppm
