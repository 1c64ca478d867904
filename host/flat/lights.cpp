#include "flat/lights.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "flat/textures.h"

namespace vkcppm {
namespace {

using std::numbers::pi;

constexpr std::uint32_t max_cut = 6;          // a textured emitter is cut in four at most this often
constexpr double texels_a_part = 4.0;         // parts that are smaller are not cut
constexpr int part_samples = 4;               // of a part along either side, to weigh it
constexpr std::size_t max_parts = 1u << 20;   // of all textured emitters
constexpr Extent least_map{128, 64};          // columns and rows of an environment: coarser ones are cut
constexpr std::uint64_t most_cut = 1u << 22;  //   into no more pixels than that

double mean(const glm::dvec3& v) { return (v.x + v.y + v.z) / 3.0; }

/// 1 - cos of an angle.
double versine(double angle) { return 2.0 * std::sin(0.5 * angle) * std::sin(0.5 * angle); }

/// Areas of the faces of the scene's bounds across x, y and z, which are padded: those of a flat scene are not 0.
glm::dvec3 face_areas(const FlatScene& flat) {
    const glm::dvec3 extent = glm::dvec3(flat.high) - glm::dvec3(flat.low);
    return {extent.y * extent.z, extent.z * extent.x, extent.x * extent.y};
}

/// The area by which parallel light enters where the box shows that much of itself: entry_area of the kernels.
double entry_area(const FlatScene& flat, double box) { return std::min(box, pi * std::pow(bounds_radius(flat), 2)); }

/// Alias table (Walker 1974, Vose 1991): entry i is kept with probability keep[i], else alias[i] stands for it; then
/// each is drawn in proportion to its weight.
struct AliasTable {
    std::vector<float> keep;
    std::vector<std::uint32_t> alias;
    double total = 0.0;  // of the weights

    explicit AliasTable(const std::vector<double>& weights) {
        for (const double weight : weights) total += weight;
        std::vector<double> share;
        std::vector<std::uint32_t> small, large;
        for (std::uint32_t i = 0; i < weights.size(); ++i) {
            share.push_back(weights[i] / total * double(weights.size()));
            keep.push_back(1.0f);
            alias.push_back(i);
            (share[i] < 1.0 ? small : large).push_back(i);
        }
        while (!small.empty() && !large.empty()) {
            const std::uint32_t poor = small.back(), rich = large.back();
            small.pop_back();
            keep[poor] = float(share[poor]);
            alias[poor] = rich;
            share[rich] -= 1.0 - share[poor];
            if (share[rich] < 1.0) {
                large.pop_back();
                small.push_back(rich);
            }
        }
    }
};

/// A light and what it is drawn in proportion to: the mean channel of its flux, about.
struct WeighedLight {
    gpu::Light light;  // power: flux, in frame units (W times scale^2)
    double weight = 0.0;
};

using Corners = std::array<glm::vec2, 3>;  // barycentrics in the whole triangle

/// Of the textures of a material, where a part was that covers them whole.
struct MeansOfImages {
    std::optional<double> emissive, alpha;
};

/// Cuts textured emitters into parts.
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
    Weight weigh(const Corners& corners) const {
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
            value *= mean(glm::dvec3(
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
    double mean_of_texels(const Corners& corners) const {
        double value = 1.0;
        if (material_.emissive_texture) {
            value *= mean_of_texels(*material_.emissive_texture, corners, means_.emissive,
                                    [](const glm::vec4& texel) { return mean(glm::dvec3(texel)); });
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
    double mean_of_texels(const Texture& texture, const Corners& corners, std::optional<double>& whole,
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
    double texels(const Corners& corners) const {
        if (!material_.emissive_texture) return 0.0;
        const Texture& texture = *material_.emissive_texture;
        const glm::dvec2 size(scene_.images[texture.image].size.width, scene_.images[texture.image].size.height);
        const glm::dvec2 a = glm::dvec2(texture.matrix * (uv(texture, corners[1]) - uv(texture, corners[0]))) * size;
        const glm::dvec2 b = glm::dvec2(texture.matrix * (uv(texture, corners[2]) - uv(texture, corners[0]))) * size;
        return 0.5 * std::abs(a.x * b.y - a.y * b.x);
    }

    void cut(const Corners& c, std::uint32_t depth) {
        // An even part may hide what its few samples missed: it is left whole only where it has few texels.
        const Weight weight = weigh(c);
        const double few = weight.largest <= 1.5 * weight.mean ? texels_a_part * part_samples : texels_a_part;
        if (depth == max_cut || texels(c) <= few || lights_.size() + 4 > max_parts) return add_part(c, depth, weight);
        const glm::vec2 m01 = 0.5f * (c[0] + c[1]), m12 = 0.5f * (c[1] + c[2]), m20 = 0.5f * (c[2] + c[0]);
        for (const Corners& part :
             {Corners{c[0], m01, m20}, Corners{m01, c[1], m12}, Corners{m20, m12, c[2]}, Corners{m12, m20, m01}}) {
            cut(part, depth + 1);
        }
    }

    void add_part(const Corners& c, std::uint32_t depth, const Weight& weight) {
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
        part.weight = mean(glm::dvec3(part.light.power)) * std::max(weight.mean, 0.25 * mean_of_texels(c));
        if (part.weight > 0.0) lights_.push_back(part);
    }

    const Scene& scene_;
    const Triangle& triangle_;
    const Material& material_;
    std::vector<WeighedLight>& lights_;
    MeansOfImages& means_;
    gpu::Light whole_{};
};

const gpu::SurfaceMaterial& material_of(const FlatScene& flat, std::uint32_t triangle) {
    return flat.materials[flat.shading[triangle].material & ~SHADING_FLAT];
}

/// Triangles that emit, in the order of the scene: the light that a random number chooses does not hang on the BVH.
std::vector<std::uint32_t> emitters(const FlatScene& flat) {
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 0; i < flat.triangles.size(); ++i) {
        const gpu::SurfaceMaterial& surface = material_of(flat, i);
        if (surface.emission != glm::vec3(0.0f) && !(surface.flags & SURFACE_UNLIT)) found.push_back(i);
    }
    std::ranges::sort(found, {}, [&](std::uint32_t i) { return flat.bvh.order[i]; });
    return found;
}

void add_emitters(const Scene& scene, const FlatScene& flat, std::vector<WeighedLight>& lights) {
    std::vector<MeansOfImages> means(scene.materials.size());
    for (const std::uint32_t i : emitters(flat)) {
        const gpu::SurfaceMaterial& surface = material_of(flat, i);
        const gpu::TriangleGeometry& triangle = flat.triangles[i];
        gpu::Light light{};
        light.kind = LIGHT_TRIANGLE;
        light.position = triangle.v0;
        light.e1 = triangle.e1;
        light.e2 = triangle.e2;
        light.triangle = i;
        light.double_sided = (surface.flags & SURFACE_DOUBLE_SIDED) != 0 ? 1 : 0;
        const double area = 0.5 * glm::length(glm::cross(glm::dvec3(triangle.e1), glm::dvec3(triangle.e2)));
        light.power = glm::vec3(glm::dvec3(surface.emission) * (pi * area * (light.double_sided ? 2.0 : 1.0)));
        if (surface.texture[TEXTURE_EMISSIVE] != 0 || (surface.flags & (SURFACE_MASK | SURFACE_BLEND)) != 0) {
            const Triangle& source = flat.sources[i];
            TexturedEmitter(scene, source, lights, means[source.material]).add(light);
        } else {
            lights.push_back({light, mean(glm::dvec3(light.power))});
        }
    }
}

void add_punctual_lights(const Scene& scene, const FlatScene& flat, std::vector<WeighedLight>& lights) {
    const double scale2 = flat.frame.scale * flat.frame.scale;
    for (const PunctualLight& source : scene.lights) {
        gpu::Light light{};
        const glm::dvec3 intensity(source.intensity);
        light.position = glm::vec3(flat.frame.point(source.position));
        light.e1 = glm::vec3(source.direction);
        switch (source.kind) {
            case PunctualLight::Kind::point:
                light.kind = LIGHT_POINT;
                light.power = glm::vec3(intensity * (4.0 * pi * scale2));
                break;
            case PunctualLight::Kind::spot: {
                light.kind = LIGHT_SPOT;
                const double inner = versine(source.inner_cone), outer = versine(source.outer_cone);
                light.e2 = glm::vec3(inner, outer, 0.0);
                // Integral of clamp((outer - v) / (outer - inner), 0, 1)^2 over the sphere.
                light.power = glm::vec3(intensity * (2.0 * pi * scale2 * (inner + (outer - inner) / 3.0)));
                break;
            }
            case PunctualLight::Kind::directional: {
                light.kind = LIGHT_DIRECTIONAL;
                const double box = glm::dot(face_areas(flat), glm::abs(source.direction));
                light.power = glm::vec3(intensity * entry_area(flat, box));
                break;
            }
        }
        lights.push_back({light, mean(glm::dvec3(light.power))});
    }
}

/// The same radiance from the same directions by a map of at least least_map's columns and rows, so that the area by
/// which light enters varies little over a pixel, and the power of photons with it; none where that is so, or where it
/// would take too many pixels.
std::optional<Environment> cut(const Environment& map) {
    const std::uint32_t columns = (least_map.width + map.size.width - 1) / map.size.width;
    const std::uint32_t rows = (least_map.height + map.size.height - 1) / map.size.height;
    const std::uint64_t pixels = map.size.pixels() * columns * rows;
    if (pixels == map.size.pixels() || pixels > most_cut) return std::nullopt;
    Environment fine{{columns * map.size.width, rows * map.size.height}, {}};
    for (std::uint32_t row = 0; row < fine.size.height; ++row) {
        for (std::uint32_t column = 0; column < fine.size.width; ++column) {
            fine.radiance.push_back(map.radiance[std::size_t(row / rows) * map.size.width + column / columns]);
        }
    }
    return fine;
}

/// Integral of |cos| from 0 to an angle.
double integral_of_cosine(double angle) {
    const double half_turns = std::round(angle / pi);
    return 2.0 * half_turns + std::sin(angle - half_turns * pi);
}

void add_environment(const Scene& scene, FlatScene& flat, std::vector<WeighedLight>& lights) {
    if (!scene.environment) return;
    const std::optional<Environment> fine = cut(*scene.environment);
    const Environment& map = fine ? *fine : *scene.environment;
    const auto [columns, rows] = map.size;
    // The box shows areas . |direction| of itself, integrated here over the directions of a pixel.
    const glm::dvec3 areas = face_areas(flat);
    const double width = 2.0 * pi / columns, height = pi / rows;
    std::vector<double> level;  // [columns] integral over the azimuth of the areas across x and z
    for (std::uint32_t column = 0; column < columns; ++column) {
        const double first = width * column - pi, last = width * (column + 1.0) - pi;
        level.push_back(areas.x * (integral_of_cosine(last) - integral_of_cosine(first)) +
                        areas.z * (integral_of_cosine(last - 0.5 * pi) - integral_of_cosine(first - 0.5 * pi)));
    }
    std::vector<double> weights;  // mean channel of the flux into the scene, about
    for (std::uint32_t row = 0; row < rows; ++row) {
        const double top = height * row, middle = height * (row + 0.5), bottom = height * (row + 1.0);
        // Integrals over the polar angle t of sin t, sin^2 t and |cos t| sin t; differences would cancel near the
        // poles.
        const double band = 2.0 * std::sin(middle) * std::sin(0.5 * height);
        const double across = 0.5 * (height - std::sin(height)) + std::sin(height) * std::pow(std::sin(middle), 2);
        const double upright =
            0.5 * (std::cos(top) * std::abs(std::cos(top)) - std::cos(bottom) * std::abs(std::cos(bottom)));
        for (std::uint32_t column = 0; column < columns; ++column) {
            const double box = (across * level[column] + upright * areas.y * width) / (band * width);
            const double area = entry_area(flat, box);
            const glm::vec3& radiance = map.radiance[std::size_t(row) * columns + column];
            weights.push_back(mean(glm::dvec3(radiance)) * area * band * width);
            flat.environment_alias.emplace_back(0u, std::bit_cast<std::uint32_t>(float(area)));
        }
    }
    const AliasTable table(weights);
    flat.environment_size = map.size;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        flat.environment.emplace_back(map.radiance[i], table.keep[i]);
        flat.environment_alias[i].x = table.alias[i];
    }
    if (!(table.total > 0.0)) return;
    gpu::Light light{};
    light.kind = LIGHT_ENVIRONMENT;
    light.power = glm::vec3(glm::dvec3(table.total));
    lights.push_back({light, table.total});
}

}  // namespace

double bounds_radius(const FlatScene& flat) { return flat.radius > 0.0 ? flat.radius + 2e-5 : 0.0; }

void add_lights(const Scene& scene, FlatScene& flat) {
    std::vector<WeighedLight> lights;
    add_punctual_lights(scene, flat, lights);
    add_emitters(scene, flat, lights);
    add_environment(scene, flat, lights);
    std::erase_if(lights, [](const WeighedLight& light) { return !(light.weight > 0.0); });
    if (lights.empty()) return;
    std::vector<double> weights;
    for (const WeighedLight& light : lights) weights.push_back(light.weight);
    const AliasTable table(weights);
    flat.light_power = table.total;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        gpu::Light light = lights[i].light;
        light.power = glm::vec3(glm::dvec3(light.power) * (table.total / lights[i].weight));  // flux / probability
        light.keep = table.keep[i];
        light.alias_entry = table.alias[i];
        flat.lights.push_back(light);
    }
}

}  // namespace vkcppm
