#include "flat/environment_light.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

#include <glm/geometric.hpp>

#include "flat/alias_table.h"
#include "flat/bounds.h"

namespace vkcppm {
namespace {

using std::numbers::pi;

constexpr Extent least_map{128, 64};          // columns and rows: coarser maps are cut
constexpr std::uint64_t most_cut = 1u << 22;  //   into no more pixels than that

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

}  // namespace

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
            weights.push_back(mean_channel(glm::dvec3(radiance)) * area * band * width);
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

}  // namespace vkcppm
