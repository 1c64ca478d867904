// Starts of light paths: each light as often as its share of the power, in the directions and from the places where
// it emits; all from the scene's own numbers, not from the alias table.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "flat/features.h"
#include "flat/flatten.h"
#include "flat/bounds.h"
#include "kernels/probe.h"
#include "oracle/texture.h"
#include "support/device/gpu.h"
#include "support/scenes/shapes.h"
#include "support/statistics/statistics.h"

namespace vkcppm::test {
namespace {

using std::numbers::pi;

constexpr std::uint32_t emission_words[] = {
#include "emission.spv.inc"
};

constexpr std::size_t samples = 400000;

/// A light as the scene states it: what tells its paths from those of others, and its flux.
struct Source {
    std::string name;
    glm::dvec3 flux;                       // W
    const PunctualLight* light = nullptr;  // none: a triangle
    std::size_t triangle = 0;
    bool double_sided = false;
    std::vector<gpu::EmitOutput> starts;  // filled by the test, frame units
};

Scene lights_of_every_kind() {
    Scene scene;
    const auto floor = add_material(scene, lambert(glm::vec3(0.5f)));
    add_quad(scene, {-2, -1, -2}, {0, 0, 4}, {4, 0, 0}, floor);
    // Colours differ in hue, so that the power of a path tells its light.
    add_triangle(scene, {-1, 0, -1}, {0, 0.5, -1}, {-1, 1, 0}, add_material(scene, emitter({9, 1, 1})));
    add_triangle(scene, {1, 0, 1}, {1.2, 0.1, 1}, {1, 0.4, 1.3}, add_material(scene, emitter({1, 9, 1}, true)));
    add_triangle(scene, {0, 1, 0}, {0, 1, 1.5}, {1.5, 1, 0}, add_material(scene, emitter({1, 1, 9})));
    const auto add = [&](PunctualLight::Kind kind, const glm::vec3& intensity, const glm::dvec3& position,
                         const glm::dvec3& direction, double inner, double outer) {
        PunctualLight light;
        light.kind = kind;
        light.intensity = intensity;
        light.position = position;
        light.direction = glm::normalize(direction);
        light.inner_cone = inner;
        light.outer_cone = outer;
        scene.lights.push_back(light);
    };
    using Kind = PunctualLight::Kind;
    add(Kind::point, {0.9f, 0.9f, 0.1f}, {0.5, 0.5, 0.5}, {0, 0, -1}, 0, 0);
    add(Kind::point, {0.01f, 0.2f, 0.2f}, {-0.5, 0.5, 0.5}, {0, 0, -1}, 0, 0);
    add(Kind::spot, {5.0f, 0.5f, 5.0f}, {0, 0.9, -0.5}, {0.3, -1.0, 0.2}, 0.0, pi / 4.0);
    add(Kind::spot, {60.0f, 20.0f, 10.0f}, {0, 0.2, -0.5}, {-1.0, 0.5, -0.2}, 0.2, 0.25);
    add(Kind::directional, {0.1f, 0.5f, 0.9f}, {0, 0, 0}, {0.2, -1.0, 0.4}, 0, 0);
    add(Kind::directional, {0.2f, 0.05f, 0.01f}, {0, 0, 0}, {1.0, -0.1, 0.0}, 0, 0);
    return scene;
}

/// Corner c of a triangle in the frame.
glm::dvec3 corner(const Scene& scene, const FlatScene& flat, std::size_t triangle, int c) {
    return flat.frame.point(scene.positions[scene.triangles[triangle].vertex[c]]);
}

/// An axis-aligned box, in the frame.
struct Box {
    glm::dvec3 low, high;
};

/// What light from infinity enters by: the bounds of the scene, padded for rounding.
Box bounds_of(const Scene& scene, const FlatScene& flat) {
    Box box{glm::dvec3(std::numeric_limits<double>::infinity()), glm::dvec3(0.0)};
    box.high = -box.low;
    for (const auto& p : scene.positions) {
        box.low = glm::min(box.low, flat.frame.point(p));
        box.high = glm::max(box.high, flat.frame.point(p));
    }
    return {box.low - 1e-5, box.high + 1e-5};
}

/// Area of the box's silhouette along a unit vector.
double silhouette_area(const Box& box, const glm::dvec3& direction) {
    const glm::dvec3 e = box.high - box.low, d = glm::abs(direction);
    return d.x * e.y * e.z + d.y * e.z * e.x + d.z * e.x * e.y;
}

bool meets(const Box& box, const glm::dvec3& origin, const glm::dvec3& direction) {
    double near = -std::numeric_limits<double>::infinity(), far = -near;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = box.low[axis] - origin[axis], high = box.high[axis] - origin[axis];
        if (direction[axis] == 0.0) {
            if (low > 0.0 || high < 0.0) return false;
            continue;
        }
        near = std::max(near, std::min(low / direction[axis], high / direction[axis]));
        far = std::min(far, std::max(low / direction[axis], high / direction[axis]));
    }
    return near <= far;
}

/// A ray along `direction` comes into the box at this point, but for rounding.
bool enters(const Box& box, const glm::dvec3& point, const glm::dvec3& direction) {
    constexpr double rounding = 1e-6;
    bool turned = false;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = point[axis] - box.low[axis], high = point[axis] - box.high[axis];
        if (low < -rounding || high > rounding) return false;
        turned = turned || (direction[axis] > 0.0 && low < rounding) || (direction[axis] < 0.0 && high > -rounding);
    }
    return turned;
}

std::vector<Source> sources_of(const Scene& scene, const FlatScene& flat) {
    std::vector<Source> sources;
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        const Material& material = scene.materials[scene.triangles[i].material];
        if (material.emission == glm::vec3(0.0f)) continue;
        const auto& v = scene.triangles[i].vertex;
        const double area = 0.5 * glm::length(glm::cross(scene.positions[v[1]] - scene.positions[v[0]],
                                                         scene.positions[v[2]] - scene.positions[v[0]]));
        const double sides = material.double_sided ? 2.0 : 1.0;
        sources.push_back({fmt::format("triangle {}", i),
                           pi * area * sides * glm::dvec3(material.emission),
                           nullptr,
                           i,
                           material.double_sided,
                           {}});
    }
    const Box box = bounds_of(scene, flat);
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const PunctualLight& light = scene.lights[i];
        double factor = 4.0 * pi;
        if (light.kind == PunctualLight::Kind::spot) {
            const double inner = std::cos(light.inner_cone), outer = std::cos(light.outer_cone);
            factor = 2.0 * pi * ((1.0 - inner) + (inner - outer) / 3.0);
        } else if (light.kind == PunctualLight::Kind::directional) {
            factor = silhouette_area(box, light.direction) / std::pow(flat.frame.scale, 2);
        }
        sources.push_back({fmt::format("light {}", i), factor * glm::dvec3(light.intensity), &light, 0, false, {}});
    }
    return sources;
}

double mean(const glm::dvec3& v) { return (v.x + v.y + v.z) / 3.0; }

/// Cosine of the direction to `axis` and azimuth about it, in bins; any frame will do, azimuths are uniform.
std::vector<std::uint64_t> direction_bins(const Source& source, const glm::dvec3& axis, double low, double high) {
    const glm::dvec3 side =
        glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const glm::dvec3 other = glm::cross(axis, side);
    std::vector<std::uint64_t> bins(10 * 8);
    for (const auto& start : source.starts) {
        const glm::dvec3 d(start.direction);
        const double turn = std::atan2(glm::dot(d, other), glm::dot(d, side)) / (2.0 * pi) + 0.5;
        const double place = (glm::dot(d, axis) - low) / (high - low);
        ++bins[std::size_t(std::clamp(10.0 * place, 0.0, 9.0)) * 8 + std::min<std::size_t>(7, std::size_t(8.0 * turn))];
    }
    return bins;
}

/// Of ten bins of the cosine over [low, high], times eight azimuths, for the cumulative distribution `below`.
template <typename Cumulative> std::vector<double> direction_density(double low, double high, Cumulative below) {
    std::vector<double> density;
    for (int i = 0; i < 10; ++i) {
        const double p = below(low + (high - low) * (i + 1) / 10.0) - below(low + (high - low) * i / 10.0);
        density.insert(density.end(), 8, p / 8.0);
    }
    return density;
}

/// Parallel rays that start where they enter the box, uniform over its silhouette.
void expect_silhouette(const std::vector<gpu::EmitOutput>& starts, const Box& box, const glm::dvec3& direction,
                       double level) {
    constexpr int cells = 12, fine = 40;  // a side of the rectangle about the silhouette, and of a cell
    const glm::dvec3 side = glm::normalize(glm::cross(direction, glm::dvec3(0.36, 0.48, 0.8)));
    const glm::dvec3 other = glm::cross(direction, side), centre = 0.5 * (box.low + box.high);
    const double half_side = 0.5 * glm::dot(glm::abs(side), box.high - box.low),
                 half_other = 0.5 * glm::dot(glm::abs(other), box.high - box.low);
    std::vector<double> shares(cells * cells);
    double met = 0.0;
    for (int y = 0; y < cells * fine; ++y) {
        for (int x = 0; x < cells * fine; ++x) {
            const double u = (x + 0.5) / (cells * fine) * 2.0 - 1.0, v = (y + 0.5) / (cells * fine) * 2.0 - 1.0;
            if (!meets(box, centre + u * half_side * side + v * half_other * other, direction)) continue;
            shares[std::size_t(y / fine) * cells + std::size_t(x / fine)] += 1.0;
            met += 1.0;
        }
    }
    const double area = met * 4.0 * half_side * half_other / std::pow(cells * fine, 2);
    EXPECT_NEAR(area / silhouette_area(box, direction), 1.0, 5e-3) << "area of the silhouette, by quadrature";
    std::vector<std::uint64_t> counts(shares.size());
    for (const auto& start : starts) {
        ASSERT_LT(glm::distance(glm::dvec3(start.direction), direction), 1e-6);
        ASSERT_TRUE(enters(box, glm::dvec3(start.origin), direction));
        const glm::dvec3 offset = glm::dvec3(start.origin) - centre;
        const double x = 0.5 * cells * (glm::dot(offset, side) / half_side + 1.0),
                     y = 0.5 * cells * (glm::dot(offset, other) / half_other + 1.0);
        ++counts[std::size_t(std::clamp(y, 0.0, cells - 1.0)) * cells + std::size_t(std::clamp(x, 0.0, cells - 1.0))];
    }
    // Slivers at the edge, whose shares the quadrature hardly knows, count together.
    for (std::size_t i = 1; i < shares.size(); ++i) {
        if (shares[i] > 1e-3 * met) continue;
        shares[0] += std::exchange(shares[i], 0.0);
        counts[0] += std::exchange(counts[i], 0);
    }
    for (double& share : shares) share /= met;
    expect_density("places on the silhouette", chi_squared(counts, shares), level);
}

std::vector<gpu::EmitInput> random_inputs(std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<gpu::EmitInput> inputs(samples);
    for (auto& input : inputs) {
        for (int c = 0; c < 4; ++c) input.bits[c] = std::uint32_t(random());
        for (int c = 0; c < 4; ++c) input.v[c] = float(random() >> 8) / 16777216.0f;
    }
    return inputs;
}

class Emission : public GpuTest {
protected:
    std::vector<gpu::EmitOutput> emit(const FlatScene& flat, const std::vector<gpu::EmitInput>& inputs) {
        gpu::Params params{};
        params.bounds_low = flat.low;
        params.bounds_high = flat.high;
        params.bounds_radius = float(bounds_radius(flat));
        params.light_count = std::uint32_t(flat.lights.size());
        params.environment = {flat.environment_size.width, flat.environment_size.height};
        Probe probe("emission", emission_words, flat.bvh.stack, bits_of(flat.features));
        probe.input(Binding::params, std::vector{params});
        probe.input(Binding::lights, flat.lights);
        probe.input(Binding::shading, flat.shading);
        probe.input(Binding::instances, flat.instances);
        probe.input(Binding::materials, flat.materials);
        probe.input(Binding::texcoords, flat.texcoords);
        probe.input(Binding::vertex_colors, flat.vertex_colors);
        probe.input(Binding::textures, flat.textures);
        probe.input(Binding::images, flat.images);
        probe.input(Binding::environment, flat.environment);
        probe.input(Binding::environment_alias, flat.environment_alias);
        probe.input(PROBE_INPUT, inputs);
        probe.output<gpu::EmitOutput>(PROBE_OUTPUT, inputs.size());
        probe.run(inputs.size(),
                  {.iteration = 0, .last_round = 0, .argument = 0, .items = std::uint32_t(inputs.size())});
        return probe.result<gpu::EmitOutput>(PROBE_OUTPUT, inputs.size());
    }
};

TEST_F(Emission, LightsEmitTheirShareWhereAndWhereTo) {
    const Scene scene = lights_of_every_kind();
    const FlatScene flat = flatten(scene);
    std::vector<Source> sources = sources_of(scene, flat);
    ASSERT_EQ(flat.lights.size(), sources.size());
    glm::dvec3 total(0.0);
    for (const Source& source : sources) total += source.flux;
    const double scale2 = flat.frame.scale * flat.frame.scale;

    const auto starts = emit(flat, random_inputs(6));

    // A path of a light carries its flux over its probability.
    glm::dvec3 sum(0.0), squares(0.0);
    for (const auto& start : starts) {
        const glm::dvec3 power = glm::dvec3(start.power) / scale2;
        sum += power;
        squares += power * power;
        bool known = false;
        for (Source& source : sources) {
            const glm::dvec3 expected = source.flux * (mean(total) / mean(source.flux));
            if (glm::distance(power, expected) > 2e-6 * glm::length(expected)) continue;
            known = true;
            ASSERT_EQ(start.kind == LIGHT_TRIANGLE, source.light == nullptr) << source.name;
            source.starts.push_back(start);
        }
        ASSERT_TRUE(known) << "power (" << power.x << ", " << power.y << ", " << power.z << ") W is that of no light";
        ASSERT_NEAR(glm::length(glm::dvec3(start.direction)), 1.0, 1e-6);
    }
    const double level = sidak(1e-4, 1 + 3 * sources.size());
    std::vector<std::uint64_t> counts;
    std::vector<double> shares;
    for (const Source& source : sources) {
        counts.push_back(source.starts.size());
        shares.push_back(mean(source.flux) / mean(total));
    }
    expect_density("lights in proportion to power", chi_squared(counts, shares), level);
    for (int c = 0; c < 3; ++c) {
        const double average = sum[c] / samples;
        const double error = std::sqrt((squares[c] / samples - average * average) / samples);
        EXPECT_NEAR(average, total[c], 4.0 * error) << "total power, channel " << c << ", standard error " << error;
    }

    for (const Source& source : sources) {
        SCOPED_TRACE(source.name);
        ASSERT_GT(source.starts.size(), 1000u);
        if (!source.light) {
            const glm::dvec3 v0 = corner(scene, flat, source.triangle, 0);
            const glm::dvec3 e1 = corner(scene, flat, source.triangle, 1) - v0,
                             e2 = corner(scene, flat, source.triangle, 2) - v0;
            const glm::dvec3 normal = glm::cross(e1, e2), unit = glm::normalize(normal);
            std::vector<std::uint64_t> places(16);
            Source turned = source;
            std::vector<std::uint64_t> sides(2);
            for (auto& start : turned.starts) {
                const double cosine = glm::dot(glm::dvec3(start.direction), unit);
                ++sides[cosine < 0.0 ? 1 : 0];
                const glm::dvec3 offset = glm::dvec3(start.origin) - v0;
                const double height = glm::dot(offset, unit);
                ASSERT_LT(std::abs(height), 5e-6);
                ASSERT_GT(height * cosine, 0.0) << "the path starts behind its own emitter";
                const double b = glm::dot(glm::cross(offset, e2), normal) / glm::dot(normal, normal);
                const double c = glm::dot(glm::cross(e1, offset), normal) / glm::dot(normal, normal);
                ASSERT_TRUE(b > -1e-5 && c > -1e-5 && b + c < 1.0 + 1e-5) << b << " " << c;
                // Uniform on the triangle: 1 - (1 - b)^2 and c / (1 - b) are uniform and independent.
                const double u = 1.0 - (1.0 - b) * (1.0 - b), v = c / std::max(1e-9, 1.0 - b);
                ++places[std::size_t(std::clamp(4.0 * u, 0.0, 3.0)) * 4 + std::size_t(std::clamp(4.0 * v, 0.0, 3.0))];
                if (cosine < 0.0) start.direction = glm::vec3(glm::dvec3(start.direction) - 2.0 * cosine * unit);
            }
            expect_density("places", chi_squared_uniform(places), level);
            expect_density("directions",
                           chi_squared(direction_bins(turned, unit, 0.0, 1.0),
                                       direction_density(0.0, 1.0, [](double c) { return c * c; })),
                           level);
            if (source.double_sided) {
                expect_density("sides", chi_squared_uniform(sides), level);
            } else {
                EXPECT_EQ(sides[1], 0u) << "emitted behind a one-sided triangle";
            }
            continue;
        }
        const PunctualLight& light = *source.light;
        const glm::dvec3 position = flat.frame.point(light.position);
        if (light.kind == PunctualLight::Kind::directional) {
            expect_silhouette(source.starts, bounds_of(scene, flat), light.direction, level);
            continue;
        }
        double low = -1.0;
        std::function<double(double)> below = [](double c) { return 0.5 * (c + 1.0); };
        if (light.kind == PunctualLight::Kind::spot) {
            low = std::cos(light.outer_cone);
            const double inner = std::cos(light.inner_cone), third = (inner - low) / 3.0, whole = third + 1.0 - inner;
            below = [=](double c) {
                return (third * std::pow(std::min(1.0, (c - low) / (inner - low)), 3) + std::max(0.0, c - inner)) /
                       whole;
            };
        }
        for (const auto& start : source.starts) {
            ASSERT_LT(glm::distance(glm::dvec3(start.origin), position), 1e-6);
            if (light.kind == PunctualLight::Kind::spot) {
                ASSERT_GT(glm::dot(glm::dvec3(start.direction), light.direction), low - 1e-6) << "outside the cone";
            }
        }
        const glm::dvec3 axis = light.kind == PunctualLight::Kind::point ? glm::dvec3(0.6, 0.0, 0.8) : light.direction;
        expect_density("directions",
                       chi_squared(direction_bins(source, axis, low, 1.0), direction_density(low, 1.0, below)), level);
    }
}

/// A floor under an environment of columns x rows random pixels, one of them black and one very bright.
Scene open_scene(std::uint32_t columns, std::uint32_t rows) {
    Scene scene;
    add_quad(scene, {-2, -1, -2}, {0, 0, 4}, {4, 0, 0}, add_material(scene, lambert(glm::vec3(0.5f))));
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    Environment map;
    map.size = {columns, rows};
    for (std::uint32_t i = 0; i < columns * rows; ++i) {
        map.radiance.emplace_back(uniform(random), uniform(random), uniform(random));
    }
    if (columns * rows > 2) {
        map.radiance[columns * rows / 2] = glm::vec3(30.0f, 20.0f, 5.0f);
        map.radiance[columns * rows / 3] = glm::vec3(0.0f);
    }
    scene.environment = map;
    return scene;
}

TEST_F(Emission, AnEnvironmentEmitsItsRadianceFromEveryPixel) {
    constexpr std::array<std::array<std::uint32_t, 2>, 4> sizes = {{{1, 1}, {16, 8}, {7, 5}, {130, 65}}};
    constexpr int fine = 16;  // points a side of a part of a pixel
    const double level = sidak(1e-4, sizes.size());
    for (const auto& [columns, rows] : sizes) {
        SCOPED_TRACE(fmt::format("{} x {} pixels", columns, rows));
        const Scene scene = open_scene(columns, rows);
        const FlatScene flat = flatten(scene);
        ASSERT_EQ(flat.lights.size(), 1u);
        const std::vector<glm::vec3>& radiance = scene.environment->radiance;
        const Box box = bounds_of(scene, flat);

        // Sub-bins of a pixel: 2 azimuths by 2 cosines, by the flux through the bounds.
        std::vector<double> shares;
        glm::dvec3 flux(0.0);
        for (std::uint32_t i = 0; i < columns * rows; ++i) {
            const double top = std::cos(pi * (i / columns) / rows), bottom = std::cos(pi * (i / columns + 1.0) / rows);
            for (int part = 0; part < 4; ++part) {
                double area = 0.0;  // mean of the silhouette's, by quadrature
                for (int k = 0; k < fine * fine; ++k) {
                    const double u = (part % 2 + (k % fine + 0.5) / fine) / 2.0;
                    const double y = std::lerp(top, bottom, (part / 2 + (k / fine + 0.5) / fine) / 2.0);
                    const double azimuth = 2.0 * pi * ((i % columns + u) / columns - 0.5);
                    const double r = std::sqrt(1.0 - y * y);
                    area += silhouette_area(box, {r * std::cos(azimuth), y, r * std::sin(azimuth)}) / (fine * fine);
                }
                const glm::dvec3 part_flux = glm::dvec3(radiance[i]) * (area * (top - bottom) * 0.5 * pi / columns);
                flux += part_flux;
                shares.push_back(mean(part_flux));
            }
        }
        for (double& share : shares) share /= mean(flux);

        std::vector<std::uint64_t> counts(shares.size());
        glm::dvec3 sum(0.0), squares(0.0);
        std::size_t edges = 0;
        double most = 0.0;  // power, in the flux
        for (const auto& start : emit(flat, random_inputs(8))) {
            EXPECT_EQ(start.kind, LIGHT_ENVIRONMENT);
            const glm::dvec3 away = -glm::dvec3(start.direction);
            ASSERT_NEAR(glm::length(away), 1.0, 1e-6);
            const double x = columns * (0.5 + std::atan2(away.z, away.x) / (2.0 * pi));
            const double y = rows * std::acos(std::clamp(away.y, -1.0, 1.0)) / pi;
            const auto column = std::min<std::size_t>(columns - 1, std::size_t(x));
            const auto row = std::min<std::size_t>(rows - 1, std::size_t(y));
            const double top = std::cos(pi * double(row) / rows), bottom = std::cos(pi * double(row + 1) / rows);
            const std::size_t half = std::min<std::size_t>(1, std::size_t(2.0 * (x - double(column))));
            const std::size_t lower = away.y < 0.5 * (top + bottom) ? 1 : 0;
            ++counts[4 * (row * columns + column) + 2 * lower + half];

            // The colour of the power is that of the pixel that an eye ray would see there.
            const glm::dvec3 power(start.power), seen(start.radiance);
            const glm::dvec3 expected = seen * (mean(power) / mean(seen));
            most = std::max(most, mean(power) / mean(flux));
            const bool edge = std::abs(x - std::round(x)) < 1e-5 || std::abs(y - std::round(y)) < 1e-5;
            edges += edge ? 1 : 0;
            if (!edge) {
                ASSERT_EQ(start.radiance, radiance[row * columns + column]) << x << " " << y;
                ASSERT_LT(glm::distance(power, expected), 1e-5 * glm::length(expected)) << x << " " << y;
            }
            sum += power;
            squares += power * power;

            ASSERT_TRUE(enters(box, glm::dvec3(start.origin), -away));
        }
        EXPECT_LT(edges, samples / 1000);
        expect_density("pixels", chi_squared(counts, shares), level);
        EXPECT_LT(most, 2.01) << "where a pixel sees the floor end-on";
        for (int c = 0; c < 3; ++c) {
            const double average = sum[c] / samples;
            const double error = std::sqrt(std::max(0.0, squares[c] / samples - average * average) / samples);
            EXPECT_NEAR(average, flux[c], 4.0 * error + 1e-6 * flux[c])
                << "flux, channel " << c << ", standard error " << error;
        }
    }
}

/// A box of three different sides: its silhouette is a hexagon from most directions.
Scene long_box() {
    Scene scene;
    add_box(scene, {-2.0, 0.0, -1.0}, {2.0, 0.7, 1.0}, add_material(scene, lambert(glm::vec3(0.5f))), false);
    return scene;
}

Scene under_sun(const glm::dvec3& direction) {
    Scene scene = long_box();
    PunctualLight sun;
    sun.kind = PunctualLight::Kind::directional;
    sun.intensity = {0.5f, 2.0f, 4.0f};
    sun.direction = glm::normalize(direction);
    scene.lights.push_back(sun);
    return scene;
}

TEST_F(Emission, ADirectionalLightIsUniformOverTheSilhouetteOfTheBounds) {
    const std::array<glm::dvec3, 5> directions = {
        glm::dvec3(1, -2, 0.5), {-0.3, 0.2, 0.9}, {0, 1, 0}, {-1, 0, -1}, {1e-3, -1, -1e-6}};
    for (const glm::dvec3& direction : directions) {
        SCOPED_TRACE(fmt::format("along ({}, {}, {})", direction.x, direction.y, direction.z));
        const Scene scene = under_sun(direction);
        const FlatScene flat = flatten(scene);
        expect_silhouette(emit(flat, random_inputs(10)), bounds_of(scene, flat), scene.lights[0].direction,
                          sidak(1e-4, directions.size()));
    }
}

/// From above a sphere about it shows less of itself than a box, from the side more.
Scene lens() {
    Scene scene;
    add_sphere(scene, {0, 0, 0}, 1.0, 3, add_material(scene, lambert(glm::vec3(0.5f))), true);
    for (auto& p : scene.positions) p.y *= 0.5;
    return scene;
}

TEST_F(Emission, ADirectionalLightOnABallIsUniformOverADisc) {
    Scene scene = lens();
    scene.lights = under_sun({0.2, 1.0, -0.1}).lights;
    const FlatScene flat = flatten(scene);
    const glm::dvec3 direction = scene.lights[0].direction;
    std::vector<std::uint64_t> rings(8), turns(8);
    for (const auto& start : emit(flat, random_inputs(12))) {
        const double along = glm::dot(glm::dvec3(start.origin), direction);
        const glm::dvec3 across = glm::dvec3(start.origin) - along * direction;
        const double distance = glm::length(across) / flat.radius;
        ASSERT_LT(along, -flat.radius) << "the disc cuts the scene";
        ASSERT_LT(distance, 1.0001);
        ++rings[std::min<std::size_t>(7, std::size_t(8.0 * distance * distance))];
        const glm::dvec3 side = glm::normalize(glm::cross(direction, glm::dvec3(0.36, 0.48, 0.8)));
        const double turn = std::atan2(glm::dot(across, glm::cross(direction, side)), glm::dot(across, side));
        ++turns[std::min<std::size_t>(7, std::size_t(8.0 * (turn / (2.0 * pi) + 0.5)))];
    }
    expect_density("rings of the disc", chi_squared_uniform(rings), sidak(1e-4, 2));
    expect_density("turns of the disc", chi_squared_uniform(turns), sidak(1e-4, 2));
}

TEST_F(Emission, LightFromInfinityLightsPlanesInsideTheBounds) {
    constexpr double side = 0.45;  // m, of the squares that are lit
    const std::array<glm::dvec3, 5> normals = {
        glm::dvec3(0, 1, 0), {1, 0, 0}, {0, 0, -1}, {0.6, -0.48, 0.64}, {-0.2, 0.9, 0.4}};
    Scene sky = long_box(), spot = long_box(), lens_in_sky = lens(), lens_in_spot = lens(), lens_in_sun = lens();
    sky.environment = Environment{{1, 1}, {glm::vec3(0.5f, 2.0f, 4.0f)}};
    spot.environment = Environment{{10, 5}, std::vector<glm::vec3>(50, glm::vec3(0.5f))};
    spot.environment->radiance[12] = {30.0f, 20.0f, 10.0f};
    lens_in_sky.environment = sky.environment;
    lens_in_spot.environment = spot.environment;
    lens_in_sun.lights = under_sun({0.2, 1, -0.1}).lights;
    for (const Scene& scene :
         {sky, spot, under_sun({1, -2, 0.5}), under_sun({-0.3, 0.2, 0.9}), lens_in_sky, lens_in_spot, lens_in_sun}) {
        const FlatScene flat = flatten(scene);
        const auto starts = emit(flat, random_inputs(9));
        for (const glm::dvec3& across : normals) {
            const glm::dvec3 n = glm::normalize(across);
            SCOPED_TRACE(fmt::format("{}, normal ({:.2f}, {:.2f}, {:.2f})",
                                     scene.environment ? "environment" : "directional", n.x, n.y, n.z));
            glm::dvec3 want(0.0);  // irradiance
            if (scene.environment) {
                const auto [columns, rows] = scene.environment->size;
                constexpr std::uint32_t fine = 200;
                for (std::uint32_t i = 0; i < fine * fine * 2; ++i) {
                    const double u = (i % (2 * fine) + 0.5) / (2 * fine), v = (i / (2 * fine) + 0.5) / fine;
                    const double polar = pi * v, azimuth = 2.0 * pi * (u - 0.5);
                    const glm::dvec3 away(std::sin(polar) * std::cos(azimuth), std::cos(polar),
                                          std::sin(polar) * std::sin(azimuth));
                    const auto pixel = std::size_t(v * rows) * columns + std::size_t(u * columns);
                    want += glm::dvec3(scene.environment->radiance[pixel]) *
                            (std::max(0.0, glm::dot(away, n)) * std::sin(polar) * pi * pi / (fine * fine));
                }
            } else {
                want = glm::dvec3(scene.lights[0].intensity) * std::max(0.0, -glm::dot(scene.lights[0].direction, n));
            }
            const glm::dvec3 a = glm::normalize(glm::cross(n, glm::dvec3(0.36, 0.48, 0.8))), b = glm::cross(n, a);
            const glm::dvec3 centre = glm::dvec3(0.5f * (flat.low + flat.high));
            const double half = 0.5 * flat.frame.length(side);
            glm::dvec3 sum(0.0), squares(0.0);
            for (const auto& start : starts) {
                const glm::dvec3 o(start.origin), d(start.direction);
                const double cosine = -glm::dot(d, n);
                if (cosine <= 0.0) continue;
                const glm::dvec3 offset = o + d * (glm::dot(o - centre, n) / cosine) - centre;
                if (std::abs(glm::dot(offset, a)) > half || std::abs(glm::dot(offset, b)) > half) continue;
                const glm::dvec3 irradiance = glm::dvec3(start.power) / (4.0 * half * half);
                sum += irradiance;
                squares += irradiance * irradiance;
            }
            for (int c = 0; c < 3; ++c) {
                const double got = sum[c] / samples, error = std::sqrt(squares[c] - sum[c] * got) / samples;
                EXPECT_NEAR(got, want[c], 4.0 * error + 1e-3 * want[c]) << "channel " << c << ", error " << error;
                EXPECT_LT(error, 0.03 * want[c] + 1e-9) << "too few photons to tell";
            }
        }
    }
}

TEST_F(Emission, PhotonsOfAConstantSkyAreOfAboutOnePower) {
    Scene scene = long_box();
    scene.environment = Environment{{1, 1}, {glm::vec3(1.0f)}};
    const FlatScene flat = flatten(scene);
    // A convex body is seen with a quarter of its surface in the mean (Cauchy).
    const glm::dvec3 e = bounds_of(scene, flat).high - bounds_of(scene, flat).low;
    const double flux = 2.0 * pi * (e.x * e.y + e.y * e.z + e.z * e.x);
    double sum = 0.0, squares = 0.0;
    for (const auto& start : emit(flat, random_inputs(11))) {
        const double power = double(start.power.y) / flux;
        sum += power;
        squares += power * power;
        ASSERT_NEAR(power, 1.0, 0.15);
    }
    EXPECT_NEAR(sum / samples, 1.0, 1e-3);
    EXPECT_LT(std::sqrt(squares / samples - std::pow(sum / samples, 2)), 0.03);
}

/// An emitter of two triangles with uv (0, 0) to (1, 1) over it.
Scene textured_emitter(const TextureImage& image, const Texture& texture, Material::Alpha alpha) {
    Scene scene;
    Material material;
    material.metallic = 0.0f;
    material.specular = 0.0f;
    material.base_color = glm::vec3(0.0f);
    material.emission = {2.0f, 4.0f, 6.0f};
    material.alpha = alpha;
    (alpha == Material::Alpha::opaque ? material.emissive_texture : material.base_color_texture) = texture;
    scene.materials.push_back(material);
    scene.images.push_back(image);
    add_quad(scene, {0, 0, 0}, {1.5, 0, 0}, {0, 1, 0}, 0);
    for (const auto& p : scene.positions) scene.uv[0].emplace_back(p.x / 1.5, 1.0 - p.y);
    return scene;
}

TextureImage noise(std::uint32_t width, std::uint32_t height, std::uint32_t seed) {
    TextureImage image{"noise", {width, height}, {}};
    std::mt19937 random(seed);
    for (std::uint32_t i = 0; i < 4 * width * height; ++i) image.rgba.push_back(std::uint8_t(random()));
    return image;
}

/// Black but for one texel.
TextureImage spark(std::uint32_t size, std::uint32_t x, std::uint32_t y) {
    TextureImage image{"spark", {size, size}, std::vector<std::uint8_t>(4 * size * size)};
    for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
    std::fill_n(image.rgba.begin() + 4 * (y * size + x), 3, std::uint8_t(255));
    return image;
}

TEST_F(Emission, TexturedEmittersEmitTheirTexture) {
    struct Case {
        const char* name;
        TextureImage image;
        bool nearest;
        Material::Alpha alpha;
    };
    const std::array cases = {Case{"bilinear", noise(8, 8, 1), false, Material::Alpha::opaque},
                              Case{"nearest", noise(16, 10, 2), true, Material::Alpha::opaque},
                              Case{"fine", noise(200, 100, 3), true, Material::Alpha::opaque},
                              Case{"one texel of 64 x 64", spark(64, 37, 22), true, Material::Alpha::opaque},
                              Case{"one texel of 200 x 200", spark(200, 11, 151), false, Material::Alpha::opaque},
                              Case{"blended", noise(8, 8, 4), false, Material::Alpha::blend},
                              Case{"masked", noise(10, 8, 5), true, Material::Alpha::mask}};
    for (const Case& c : cases) {
        SCOPED_TRACE(c.name);
        Texture texture;
        texture.nearest = c.nearest;
        texture.wrap_s = texture.wrap_t = Texture::Wrap::clamp_to_edge;
        const Scene scene = textured_emitter(c.image, texture, c.alpha);
        const FlatScene flat = flatten(scene);
        const double scale2 = flat.frame.scale * flat.frame.scale;

        // The parts cover the emitter: their areas add up, and their corners are where they say.
        double area = 0.0;
        for (const gpu::Light& light : flat.lights) {
            EXPECT_EQ(light.textured, 1u);
            area += 0.5 * glm::length(glm::cross(glm::dvec3(light.e1), glm::dvec3(light.e2))) / scale2;
            const gpu::TriangleGeometry& whole = flat.triangles[light.triangle];
            const glm::vec3 ends[] = {light.position, light.position + light.e1, light.position + light.e2};
            for (int k = 0; k < 3; ++k) {
                const glm::vec3 at = whole.v0 + light.corner[k].x * whole.e1 + light.corner[k].y * whole.e2;
                ASSERT_LT(glm::distance(at, ends[k]), 1e-6f);
            }
        }
        const bool sparse = std::string(c.name).starts_with("one texel");
        if (sparse) {
            EXPECT_LT(area, 0.5 * 1.5) << "most of the emitter is black";
        } else if (c.alpha != Material::Alpha::mask) {
            EXPECT_NEAR(area, 1.5, 1e-5);
        }

        // Power by place, on a grid of cells, against the texture integrated on a finer one.
        constexpr int cells = 8, fine = 200;  // the edges of all texels are edges of the finer one
        std::vector<glm::dvec3> want(cells * cells, glm::dvec3(0.0));
        const double cell_area = 1.5 / (cells * cells);
        for (int i = 0; i < cells * fine; ++i) {
            for (int j = 0; j < cells * fine; ++j) {
                const glm::dvec2 uv((i + 0.5) / (cells * fine), (j + 0.5) / (cells * fine));
                const glm::dvec4 t = oracle::lookup(texture, c.image, uv, oracle::Encoding::srgb);
                glm::dvec3 share(1.0);
                switch (c.alpha) {
                    case Material::Alpha::opaque: share = glm::dvec3(t); break;
                    case Material::Alpha::blend: share = glm::dvec3(t.a); break;
                    case Material::Alpha::mask: share = glm::dvec3(t.a >= 0.5 ? 1.0 : 0.0); break;
                }
                want[std::size_t(j / fine) * cells + std::size_t(i / fine)] +=
                    share * glm::dvec3(scene.materials[0].emission) * (pi * cell_area / (double(fine) * fine));
            }
        }
        std::mt19937 random(9);
        std::vector<gpu::EmitInput> inputs(samples);
        for (auto& input : inputs) {
            for (int k = 0; k < 4; ++k) input.bits[k] = std::uint32_t(random());
            for (int k = 0; k < 4; ++k) input.v[k] = float(random() >> 8) / 16777216.0f;
        }
        std::vector<glm::dvec3> sum(want.size(), glm::dvec3(0.0)), squares = sum;
        double heaviest = 0.0, all = 0.0;
        for (const auto& start : emit(flat, inputs)) {
            const glm::dvec3 p = glm::dvec3(start.origin) / flat.frame.scale + flat.frame.centre;
            const auto cell = [&](double x) { return std::size_t(std::clamp(x * cells, 0.0, cells - 1.0)); };
            const std::size_t at = cell(1.0 - p.y) * cells + cell(p.x / 1.5);
            const glm::dvec3 power = glm::dvec3(start.power) / scale2;
            sum[at] += power;
            squares[at] += power * power;
            heaviest = std::max(heaviest, mean(power));
            all += mean(power) / samples;
        }
        double total = 0.0;
        for (const glm::dvec3& power : want) total += mean(power);
        for (std::size_t at = 0; at < want.size(); ++at) {
            for (int k = 0; k < 3; ++k) {
                const double average = sum[at][k] / samples;
                const double error = std::sqrt(std::max(0.0, squares[at][k] / samples - average * average) / samples);
                // 1300 means: five standard errors.
                EXPECT_NEAR(average, want[at][k], 5.0 * error + 1e-4 * want[at][k] + 1e-6 * total)
                    << "cell " << at % cells << ", " << at / cells << ", channel " << k << ", standard error " << error;
            }
        }
        EXPECT_NEAR(all, total, 0.02 * total) << "the whole";
        EXPECT_LT(heaviest, 80.0 * total) << "a path carries far more than the mean";
    }
}

TEST_F(Emission, NoBrightTexelIsLeftOut) {
    // The one bright texel of a dark image, wherever it is: all of it belongs to lights.
    Texture texture;
    texture.nearest = true;
    std::mt19937 random(10);
    for (const std::uint32_t size : {16u, 64u, 300u}) {
        std::size_t missed = 0;
        std::string first;
        for (int trial = 0; trial < 60; ++trial) {
            const std::uint32_t x = random() % size, y = random() % size;
            const FlatScene flat = flatten(textured_emitter(spark(size, x, y), texture, Material::Alpha::opaque));
            std::size_t uncovered = 0;
            for (const glm::dvec2 inside : {glm::dvec2(0.5), {0.06, 0.09}, {0.91, 0.05}, {0.07, 0.96}, {0.95, 0.94}}) {
                const glm::dvec2 uv = (glm::dvec2(x, y) + inside) / double(size);
                const glm::dvec3 p = flat.frame.point({1.5 * uv.x, 1.0 - uv.y, 0.0});
                const bool covered = std::any_of(flat.lights.begin(), flat.lights.end(), [&](const gpu::Light& light) {
                    const glm::dvec3 e1(light.e1), e2(light.e2), n = glm::cross(e1, e2),
                                                                 at = p - glm::dvec3(light.position);
                    const double b = glm::dot(glm::cross(at, e2), n) / glm::dot(n, n);
                    const double c = glm::dot(glm::cross(e1, at), n) / glm::dot(n, n);
                    return b >= -1e-4 && c >= -1e-4 && b + c <= 1.0 + 1e-4;
                });
                uncovered += covered ? 0 : 1;
            }
            if (uncovered == 0) continue;
            ++missed;
            if (first.empty())
                first =
                    fmt::format("texel ({}, {}), {} of 5 points of it, {} lights", x, y, uncovered, flat.lights.size());
        }
        EXPECT_EQ(missed, 0u) << "of 60 texels of " << size << " x " << size << ", the first: " << first;
    }
}

TEST_F(Emission, CornersOfTheHypercubeGiveFiniteStarts) {
    const FlatScene flat = flatten(lights_of_every_kind());
    const float last = 1.0f - 1.0f / 16777216.0f;
    std::vector<gpu::EmitInput> inputs;
    for (std::size_t light = 0; light < flat.lights.size(); ++light) {
        for (std::uint32_t bits = 0; bits < 128; ++bits) {
            const auto end = [&](int bit) { return (bits >> bit & 1) ? last : 0.0f; };
            const auto word = [&](int bit) { return (bits >> bit & 1) ? 0xffffffffu : 0u; };
            const auto middle = std::uint32_t((double(light) + 0.5) / double(flat.lights.size()) * 4294967296.0);
            inputs.push_back({{middle, word(0), word(1), word(2)}, {end(3), end(4), end(5), end(6)}});
        }
    }
    inputs.push_back({glm::uvec4(0xffffffffu), glm::vec4(last)});
    for (const auto& start : emit(flat, inputs)) {
        EXPECT_NEAR(glm::length(glm::dvec3(start.direction)), 1.0, 1e-6);
        EXPECT_LT(glm::length(start.origin), 10.0f);
        EXPECT_GT(mean(start.power), 0.0);
    }
}

}  // namespace
}  // namespace vkcppm::test
