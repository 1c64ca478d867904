#include "support/device/synthetic_field.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "render/render.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

using std::numbers::pi;

constexpr double spacing = 4.2;  // between points, in R_1: clouds of two radii never meet

double flat_density(double, double) { return 1.0; }
double gauss_density(double x, double y) { return std::exp(-2.0 * (x * x + y * y)); }
double edge_density(double x, double) { return x < 0.3 ? 1.0 : 0.1; }
double unit_weight(double, double, Random&) { return 1.0; }

constexpr std::array all_fields = {
    Field{"uniform", "f = 1", flat_density, 1.0, unit_weight},
    Field{"linear", "f = 1 + 0.8 x", [](double x, double) { return std::max(0.0, 1.0 + 0.8 * x); }, 2.6, unit_weight},
    Field{"gauss", "f = exp(-r^2 / (2 0.5^2))", gauss_density, 1.0, unit_weight},
    Field{"edge", "f = 1 where x < 0.3, else 0.1", edge_density, 1.0, unit_weight},
    Field{"ridge", "f = 0.2 + 0.8 exp(-x^2 / (2 0.1^2))",
          [](double x, double) { return 0.2 + 0.8 * std::exp(-50.0 * x * x); }, 1.0, unit_weight},
    Field{"sine", "f = 1 + 0.8 sin(pi x)", [](double x, double) { return 1.0 + 0.8 * std::sin(pi * x); }, 1.8,
          unit_weight},
    Field{"uniform-clustered", "f = 1, three photons a path at one place", flat_density, 1.0, unit_weight, 3},
    Field{"edge-clustered", "edge, three photons a path at one place", edge_density, 1.0, unit_weight, 3},
    Field{"flux-gradient", "f = 1, psi = 1 - 0.8 abs(x)", flat_density, 1.0,
          [](double x, double, Random&) { return std::max(0.0, 1.0 - 0.8 * std::abs(x)); }},
    Field{"heavy-tailed", "f = 1, log psi normal: mean -1.3^2 / 2, deviation 1.3", flat_density, 1.0,
          [](double, double, Random& random) {
              return std::exp(std::normal_distribution<double>(-0.5 * 1.3 * 1.3, 1.3)(random));
          }},
};

/// The largest search radius over R_1: appm's disc grows up to twice its first one.
double reach_of(const Settings& settings) { return settings.estimator == "appm" ? 2.0 : 1.0; }

Settings resolve(Settings settings, const Field& field, std::uint32_t side, double lambda) {
    settings.size = Extent{side, side};
    // A lane has more than four slots a path. Six standard deviations above the mean.
    const double reach = reach_of(settings), mean = side * side * lambda * reach * reach * field.peak;
    settings.photons = std::uint32_t(std::ceil((mean + 6.0 * std::sqrt(mean * field.cluster)) / 4.0)) + 16;
    return resolve_settings(settings, photon_plane());
}

}  // namespace

double uniform(Random& random) { return double(random() >> 11) * 0x1p-53; }

std::span<const Field> fields() { return all_fields; }

const Field& find_field(std::string_view name) {
    for (const Field& field : all_fields) {
        if (field.name == name) return field;
    }
    throw std::invalid_argument("no field " + std::string(name));
}

SyntheticField::SyntheticField(Device& device, Settings settings, const Field& field, std::uint32_t side, double lambda,
                               std::uint64_t seed)
    : field_(field),
      settings_(resolve(settings, field, side, lambda)),
      flat_(flatten(photon_plane())),
      on_device_(device, flat_),
      integrator_(on_device_, photon_plane().cameras.at(0), settings_),
      lambda_(lambda),
      reach_(reach_of(settings_)),
      random_(seed) {
    const double step = 2.0 / side;
    const float radius = float(flat_.frame.length(step / spacing));
    radius2_ = double(radius * radius);
    // The estimate is sum(power) / (J pi R^2).
    power_ = float(double(integrator_.params().photons) * pi * radius2_ / lambda_);
    for (std::uint32_t y = 0; y < side; ++y) {
        for (std::uint32_t x = 0; x < side; ++x) {
            points_.push_back(glm::vec3(flat_.frame.point({(x + 0.5) * step - 1.0, (y + 0.5) * step - 1.0, 0.0})));
        }
    }
    const gpu::Params& params = integrator_.params();
    counters_.assign(std::size_t(params.cells) + 1 + 2 * std::size_t(params.photons) + 1, 0);
    upload_hits();
    reset(settings_.knn);
}

/// White surfaces that face +z (octahedral 0), throughput times BRDF 1.
void SyntheticField::upload_hits() {
    std::vector<gpu::HitPosition> positions;
    for (const glm::vec3& point : points_) positions.push_back({point, HIT_DIFFUSE | 0x3fffffffu << 2});
    integrator_.buffer(Binding::hit_position).upload(positions);
    integrator_.buffer(Binding::hit_weight).upload(std::vector<gpu::HitWeight>(pixels(), {glm::vec3(1.0f), 0}));
    integrator_.buffer(Binding::hit_emission).upload(std::vector<gpu::HitEmission>(pixels(), {glm::vec3(0.0f), 0.0f}));
}

void SyntheticField::reset(double batch) {
    iterations_ = 0;
    gpu::PixelState state{};
    state.radius2 = float(radius2_);
    state.seeded = 1;
    state.batch = float(batch);
    set_states(std::vector<gpu::PixelState>(pixels(), state));
    for (const Binding binding : {Binding::tally, Binding::moments, Binding::film}) {
        Buffer& buffer = integrator_.buffer(binding);
        buffer.upload(std::vector<std::uint32_t>(buffer.bytes() / 4, 0));
    }
}

void SyntheticField::set_batch(double batch) {
    std::vector<gpu::PixelState> all = states();
    for (gpu::PixelState& state : all) state.batch = float(batch);
    set_states(all);
}

void SyntheticField::look_once_after(std::uint32_t iterations) {
    set_batch(1e30);
    run(iterations - 1);
    set_batch(0.0);
    run(1);
}

std::vector<gpu::PixelState> SyntheticField::states() {
    return integrator_.buffer(Binding::pixels).download<gpu::PixelState>(pixels());
}

void SyntheticField::set_states(const std::vector<gpu::PixelState>& states) {
    integrator_.buffer(Binding::pixels).upload(states);
}

double SyntheticField::rejected() {
    const std::vector<gpu::PixelState> all = states();
    return double(std::count_if(all.begin(), all.end(), [](const auto& s) { return s.rejections > 0; })) /
           double(pixels());
}

std::vector<double> SyntheticField::estimates() {
    std::vector<double> values;
    for (const gpu::Film& film : integrator_.buffer(Binding::film).download<gpu::Film>(pixels())) {
        values.push_back((double(film.sum.x) + double(film.low.x)) / iterations_);
    }
    return values;
}

void SyntheticField::add_photon(std::size_t pixel, double x, double y) {
    const double radius = std::sqrt(radius2_);
    const float power = power_ * float(field_.weight(x, y, random_));
    photons_.push_back({points_[pixel] + glm::vec3(float(x * radius), float(y * radius), 0.0f), 0});
    flux_.push_back({glm::vec3(power), 0});
}

void SyntheticField::run(std::uint32_t iterations) {
    // Paths of the highest density on squares around all points, thinned to the field's.
    const double paths = double(pixels()) * lambda_ / pi * 4.0 * reach_ * reach_ * field_.peak / field_.cluster;
    std::poisson_distribution<std::uint32_t> number(paths);
    for (std::uint32_t i = 0; i < iterations; ++i) {
        for (std::uint32_t path = number(random_); path > 0; --path) {
            const auto pixel = std::size_t(uniform(random_) * double(pixels()));
            const double x = reach_ * (2.0 * uniform(random_) - 1.0), y = reach_ * (2.0 * uniform(random_) - 1.0);
            if (x * x + y * y >= reach_ * reach_) continue;
            if (uniform(random_) * field_.peak >= field_.density(x, y)) continue;
            for (std::uint32_t photon = 0; photon < field_.cluster; ++photon) add_photon(pixel, x, y);
        }
        iterate();
    }
}

void SyntheticField::run_exact(std::uint32_t count) {
    for (std::size_t pixel = 0; pixel < pixels(); ++pixel) {
        for (std::uint32_t photon = 0; photon < count;) {
            const double x = 2.0 * uniform(random_) - 1.0, y = 2.0 * uniform(random_) - 1.0;
            if (x * x + y * y >= 0.9999 || uniform(random_) * field_.peak >= field_.density(x, y)) continue;
            add_photon(pixel, x, y);
            ++photon;
        }
    }
    iterate();
}

/// Shares the photons out to the light paths and runs the kernels on them.
void SyntheticField::iterate() {
    const gpu::Params& params = integrator_.params();
    if (photons_.size() > std::size_t(params.photon_lanes) * params.photon_capacity) {
        throw std::length_error("more photons than slots");
    }
    std::uint32_t* counts = counters_.data() + params.cells + 1;
    std::uint32_t* slots = counts + params.photons + 1;
    for (std::size_t p = 0; p < params.photons; ++p) {
        slots[p] = std::uint32_t(photons_.size() * p / params.photons);
        counts[p] = std::uint32_t(photons_.size() * (p + 1) / params.photons) - slots[p];
    }
    integrator_.buffer(Binding::counters).upload(counters_);
    integrator_.buffer(Binding::photons).upload(photons_);
    integrator_.buffer(Binding::photon_flux).upload(flux_);
    photons_.clear();
    flux_.clear();
    integrator_.run_from_grid();
    ++iterations_;
}

}  // namespace vkcppm::test
