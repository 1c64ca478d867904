#include "scene/gltf/images.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <tbb/parallel_for.h>

#include "scene/bad_scene.h"
#include "scene/gltf/limits.h"
#include "scene/gltf/schema.h"
#include "scene/gltf/picture.h"
#include "scene/gltf/resource.h"
#include "scene/gltf/uri.h"

namespace vkcppm {

using nlohmann::json;

GltfImages::GltfImages(const GltfFile& file, GltfViews& views, Warnings& warnings)
    : file_(file), views_(views), warnings_(warnings), hash_(file.hash) {}

namespace {

// That each texel takes at least: as it was decoded, and where kernels read it.
constexpr std::size_t bytes_a_texel = 8;

/// Puts the roughness of texels whose alpha is glossiness where a metallic-roughness texture has it.
void make_roughness(std::vector<std::uint8_t>& rgba, double factor) {
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
        const double roughness = 255.0 - std::clamp(factor, 0.0, 1.0) * rgba[i + 3];
        rgba[i] = rgba[i + 2] = 0;
        rgba[i + 1] = std::uint8_t(std::lround(roughness));
        rgba[i + 3] = 255;
    }
}

}  // namespace

std::optional<std::uint32_t> GltfImages::index(std::size_t image, std::optional<double> glossiness) {
    const json& source = file_.document["images"][image];
    const std::string object = fmt::format("images[{}]", image);
    const std::string uri = source.value("uri", ""), name = source.value("name", "");
    const bool has_view = source.contains("bufferView");
    if (has_view == source.contains("uri")) {
        bad_scene(file_.name, object, json_text(source), "it must have either a uri or a bufferView");
    }
    const std::string use = glossiness ? fmt::format("glossiness {} ", *glossiness) : "";
    const auto [found, is_new] = by_source_.try_emplace(use + (has_view ? source["bufferView"].dump() : "uri " + uri));
    if (!is_new) return found->second;

    if (has_view) {
        found->second = add({name, object, {}, views_.bytes(source["bufferView"].get<std::size_t>()), glossiness});
        return found->second;
    }
    std::string why;
    std::optional<Bytes> bytes = read_uri(uri, max_gltf_bytes, object + ".uri", file_.name, file_.root, hash_, why);
    if (!bytes) {
        warnings_.add("its textures are ignored, the image is absent", fmt::format("{} ({})", object, why));
        return found->second;
    }
    Source own{name, object, std::move(*bytes), {}, glossiness};
    if (!is_data_uri(uri)) {
        if (name.empty()) own.name = uri;
        own.object = fmt::format("{} ({})", object, json_text(uri));
    }
    own.bytes = own.own_bytes;
    found->second = add(std::move(own));
    return found->second;
}

constexpr const char* unreadable = "it is unreadable, its textures do without it";

/// The place of the picture among those to decode; none, with a warning, where its format is foreign or unknown.
std::optional<std::uint32_t> GltfImages::add(Source source) {
    const std::string &name = source.name, &object = source.object;
    const std::span<const std::uint8_t> bytes = source.bytes;
    if (const std::string_view format = foreign_format(bytes); !format.empty()) {
        warnings_.add(
            fmt::format("its textures are ignored, this program lacks {}: export PNG, JPEG or WebP instead", format),
            object);
        return std::nullopt;
    }
    try {
        const Extent size = picture_size(bytes);
        if (size.width > max_image_side || size.height > max_image_side) {
            bad_scene(file_.name, "the size of " + object, fmt::format("{} x {}", size.width, size.height),
                      fmt::format("the limit is {} texels a side", max_image_side));
        }
        // Before there is memory for them: a header claims any size.
        const std::size_t most = max_texels_per_byte * bytes.size() + (is_webp(bytes) ? max_flat_texels : 0);
        if (size.pixels() > most) {
            bad_scene(file_.name, "the size of " + object, fmt::format("{} x {}", size.width, size.height),
                      fmt::format("its {} bytes hold {} texels at most", bytes.size(), most));
        }
        bytes_ += bytes.size();
        texels_ += size.pixels() * (has_16_bits(bytes) ? 2 : 1);
        check_total(texels_, max_texels(bytes_), "texels, with those of " + object, file_.name);
        images_.push_back({name, size, {}});
        sources_.push_back(std::move(source));
        return std::uint32_t(images_.size() - 1);
    } catch (const Error&) {
        throw;
    } catch (const std::runtime_error& error) {
        warnings_.add(unreadable, fmt::format("{} ({})", object, error.what()));
        return std::nullopt;
    }
}

/// Decodes the pictures from that place on. [all places] why one is broken; empty where it is not.
std::vector<std::string> GltfImages::decode_from(std::size_t first) {
    check_room(texels_, bytes_a_texel, "texels", file_.name);
    std::vector<std::string> broken(images_.size()), flaws(images_.size());
    tbb::parallel_for(first, images_.size(), [&](std::size_t i) {
        try {
            Picture picture = decode_picture(sources_[i].bytes);
            images_[i].rgba = std::move(picture.rgba);
            flaws[i] = std::move(picture.flaw);
            if (sources_[i].glossiness) {
                make_roughness(images_[i].rgba, *sources_[i].glossiness);
            } else {
                images_[i].rest = std::move(picture.rest);
            }
            Bytes().swap(sources_[i].own_bytes);
        } catch (const std::runtime_error& error) {
            broken[i] = error.what();
        }
    });
    for (std::size_t i = first; i < images_.size(); ++i) {
        const std::string& why = broken[i].empty() ? flaws[i] : broken[i];
        if (why.empty()) continue;
        warnings_.add(broken[i].empty() ? "it is damaged, what can be read is used" : unreadable,
                      fmt::format("{} ({})", sources_[i].object, why));
    }
    return broken;
}

GltfImages::Taken GltfImages::take_images() {
    std::vector<std::optional<std::uint32_t>> used;  // [places] instead of each
    for (std::size_t first = 0; first < images_.size();) {
        const std::vector<std::string> broken = decode_from(first);
        const std::size_t last = images_.size();
        for (; first < last; ++first) {
            used.push_back(std::uint32_t(first));
            if (broken[first].empty()) continue;
            used.back() = std::nullopt;
            const std::optional<double> glossiness = sources_[first].glossiness;
            if (const auto beside = sources_[first].beside) used.back() = index(*beside, glossiness);
        }
    }
    Taken taken;
    taken.at.resize(images_.size());
    for (std::size_t i = 0; i < images_.size(); ++i) {
        if (used[i] != i) continue;
        taken.at[i] = std::uint32_t(taken.images.size());
        taken.images.push_back(std::move(images_[i]));
    }
    for (std::size_t i = 0; i < images_.size(); ++i) {
        if (used[i] && used[i] != i) taken.at[i] = taken.at[*used[i]];
    }
    return taken;
}

}  // namespace vkcppm
