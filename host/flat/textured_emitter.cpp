#include "flat/textured_emitter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "flat/textures.h"

namespace vkcppm {
namespace {

constexpr std::uint32_t max_cut = 6;         // an emitter is cut in four at most this often
constexpr double texels_a_part = 4.0;        // parts that are smaller are not cut
constexpr int part_samples = 4;              // of a part along either side, to weigh it
constexpr std::size_t max_parts = 1u << 20;  // of all emitters

using PartCorners = std::array<glm::vec2, 3>;  // barycentrics in the whole triangle

/// Cuts one textured emitter into parts.
class TexturedEmitter {
public:
    TexturedEmitter(const Scene& scene, const Triangle& triangle, std::vector<WeighedLight>& lights,
                    MeansOfImages& means)
        : scene_(scene),
          triangle_(triangle),
          material_(scene.materials[triangle.material]),
          lights_(lights),
          means_(means) {}

    /// `whole` has the flux that the factor alone would give.
    void add(const gpu::Light& whole) {
        whole_ = whole;
        cut({{{0.0f, 0.0f}, {1.0f, 0.0f}, {0.0f, 1.0f}}}, 0);
    }

private:
    struct Weight {
        double mean = 0.0;
        double largest = 0.0;
    };

    /// The mean channel of the texture over a part, where the surface is there, by the nearest texels.
    Weight weigh(const PartCorners& corners) const {
        Weight weight;
        int count = 0;
        for (int i = 0; i < part_samples; ++i) {
            for (int j = 0; i + j < part_samples; ++j) {
                const float u = (float(i) + 1.0f / 3.0f) / part_samples, v = (float(j) + 1.0f / 3.0f) / part_samples;
                const double value = emitted((1.0f - u - v) * corners[0] + u * corners[1] + v * corners[2]);
                weight.mean += value;
                weight.largest = std::max(weight.largest, value);
                ++count;
            }
        }
        weight.mean /= count;
        return weight;
    }

    double emitted(const glm::vec2& b) const {
        double value = 1.0;
        if (material_.emissive_texture) {
            value *= mean_channel(glm::dvec3(
                nearest_texel(scene_, *material_.emissive_texture, uv(*material_.emissive_texture, b), true)));
        }
        if (material_.alpha != Material::Alpha::opaque && material_.base_color_texture) {
            const float alpha =
                material_.opacity *
                nearest_texel(scene_, *material_.base_color_texture, uv(*material_.base_color_texture, b), true).a;
            value *= material_.alpha == Material::Alpha::blend ? alpha : alpha >= material_.alpha_cutoff ? 1.0 : 0.0;
        }
        return value;
    }

    /// The mean of what the texels give that lookups within a part can read: 0 only where the part is dark throughout.
    double mean_of_texels(const PartCorners& corners) const {
        double value = 1.0;
        if (material_.emissive_texture) {
            value *= mean_of_texels(*material_.emissive_texture, corners, means_.emissive,
                                    [](const glm::vec4& texel) { return mean_channel(glm::dvec3(texel)); });
        }
        if (material_.alpha != Material::Alpha::opaque && material_.base_color_texture) {
            value *= mean_of_texels(*material_.base_color_texture, corners, means_.alpha, [&](const glm::vec4& texel) {
                const double alpha = material_.opacity * texel.a;
                return material_.alpha == Material::Alpha::blend ? alpha : alpha >= material_.alpha_cutoff ? 1.0 : 0.0;
            });
        }
        return value;
    }

    /// whole: the mean over the image, once it is known.
    template <typename Value>
    double mean_of_texels(const Texture& texture, const PartCorners& corners, std::optional<double>& whole,
                          Value value) const {
        const TextureImage& image = scene_.images[texture.image];
        const glm::dvec2 size(image.size.width, image.size.height);
        glm::dvec2 low(std::numeric_limits<double>::infinity()), high(-low);
        for (const glm::vec2& corner : corners) {
            const glm::dvec2 at = glm::dvec2(texture.matrix * uv(texture, corner) + texture.offset) * size;
            low = glm::min(low, at);
            high = glm::max(high, at);
        }
        low = glm::floor(low - 1.0);  // bilinear lookups reach half a texel further, and rounding
        high = glm::floor(high + 1.0);
        const bool all_columns = high.x - low.x + 1.0 >= size.x, all_rows = high.y - low.y + 1.0 >= size.y;
        if (all_columns && all_rows && whole) return *whole;
        if (all_columns) low.x = 0.0, high.x = size.x - 1.0;
        if (all_rows) low.y = 0.0, high.y = size.y - 1.0;
        double sum = 0.0;
        for (auto y = std::int64_t(low.y); y <= std::int64_t(high.y); ++y) {
            for (auto x = std::int64_t(low.x); x <= std::int64_t(high.x); ++x) {
                sum += value(texel_of(image, wrapped_texel(x, image.size.width, texture.wrap_s),
                                      wrapped_texel(y, image.size.height, texture.wrap_t), true));
            }
        }
        const double result = sum / ((high.x - low.x + 1.0) * (high.y - low.y + 1.0));
        if (all_columns && all_rows) whole = result;
        return result;
    }

    glm::vec2 uv(const Texture& texture, const glm::vec2& b) const {
        const std::vector<glm::vec2>& set = scene_.uv[texture.uv_set];
        if (set.empty()) return glm::vec2(0.0f);
        return (1.0f - b.x - b.y) * set[triangle_.vertex[0]] + b.x * set[triangle_.vertex[1]] +
               b.y * set[triangle_.vertex[2]];
    }

    /// Texels that a part covers, about.
    double texels(const PartCorners& corners) const {
        if (!material_.emissive_texture) return 0.0;
        const Texture& texture = *material_.emissive_texture;
        const glm::dvec2 size(scene_.images[texture.image].size.width, scene_.images[texture.image].size.height);
        const glm::dvec2 a = glm::dvec2(texture.matrix * (uv(texture, corners[1]) - uv(texture, corners[0]))) * size;
        const glm::dvec2 b = glm::dvec2(texture.matrix * (uv(texture, corners[2]) - uv(texture, corners[0]))) * size;
        return 0.5 * std::abs(a.x * b.y - a.y * b.x);
    }

    void cut(const PartCorners& c, std::uint32_t depth) {
        // An even part may hide what its few samples missed: it is left whole only where it has few texels.
        const Weight weight = weigh(c);
        const double few = weight.largest <= 1.5 * weight.mean ? texels_a_part * part_samples : texels_a_part;
        if (depth == max_cut || texels(c) <= few || lights_.size() + 4 > max_parts) return add_part(c, depth, weight);
        const glm::vec2 m01 = 0.5f * (c[0] + c[1]), m12 = 0.5f * (c[1] + c[2]), m20 = 0.5f * (c[2] + c[0]);
        for (const PartCorners& part : {PartCorners{c[0], m01, m20}, PartCorners{m01, c[1], m12},
                                        PartCorners{m20, m12, c[2]}, PartCorners{m12, m20, m01}}) {
            cut(part, depth + 1);
        }
    }

    void add_part(const PartCorners& c, std::uint32_t depth, const Weight& weight) {
        const auto along = [&](const glm::vec2& b) { return b.x * whole_.e1 + b.y * whole_.e2; };
        WeighedLight part{whole_};
        part.light.position = whole_.position + along(c[0]);
        part.light.e1 = along(c[1] - c[0]);
        part.light.e2 = along(c[2] - c[0]);
        std::copy(c.begin(), c.end(), part.light.corner);
        part.light.textured = 1;
        const double share = std::ldexp(1.0, -2 * int(depth));  // of the triangle's area
        part.light.power = glm::vec3(glm::dvec3(whole_.power) * share);
        // The few samples can miss bright texels.
        part.weight = mean_channel(glm::dvec3(part.light.power)) * std::max(weight.mean, 0.25 * mean_of_texels(c));
        if (part.weight > 0.0) lights_.push_back(part);
    }

    const Scene& scene_;
    const Triangle& triangle_;
    const Material& material_;
    std::vector<WeighedLight>& lights_;
    MeansOfImages& means_;
    gpu::Light whole_{};
};

}  // namespace

void add_textured_emitter(const Scene& scene, const Triangle& triangle, const gpu::Light& whole,
                          std::vector<WeighedLight>& lights, MeansOfImages& means) {
    TexturedEmitter(scene, triangle, lights, means).add(whole);
}

}  // namespace vkcppm
