#include "support/device/disc_field.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>

#include "render/render.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

using std::numbers::pi;

}  // namespace

DiscField::DiscField(Device& device, const Settings& settings, const std::vector<Disc>& discs,
                     const std::vector<glm::dvec2>& photons)
    : scene_(photon_plane()),
      flat_(flatten(scene_)),
      on_device_(device, flat_),
      integrator_(on_device_, scene_.cameras.at(0), resolve_settings(settings, scene_)) {
    assert(discs.size() == settings.size->pixels() && photons.size() == settings.photons);
    const SceneFrame& frame = flat_.frame;
    const auto place = [&](const glm::dvec2& p) { return glm::vec3(frame.point({p.x, p.y, 0.0})); };
    for (const Disc& disc : discs) {
        hits_.push_back({place(disc.centre), HIT_DIFFUSE | 0x3fffffffu << 2});
        gpu::PixelState state{};
        const double radius = frame.length(disc.radius);
        state.radius2 = float(radius * radius);
        state.seeded = 1;
        state.batch = 1e30f;  // no test: the radius stays
        states_.push_back(state);
    }
    integrator_.buffer(Binding::hit_position).upload(hits_);
    integrator_.buffer(Binding::hit_weight).upload(std::vector<gpu::HitWeight>(hits_.size(), {glm::vec3(1.0f), 0}));
    integrator_.buffer(Binding::pixels).upload(states_);
    for (const glm::dvec2& photon : photons) photons_.push_back({place(photon), 0});
    integrator_.buffer(Binding::photon_flux).upload(std::vector<gpu::PhotonFlux>(photons.size(), {glm::vec3(1.0f), 0}));
    const gpu::Params& params = integrator_.params();
    // One photon a light path, each in the slot of its path.
    counters_.assign(std::size_t(params.cells) + 1 + 2 * std::size_t(params.photons) + 1, 0);
    const auto counts = counters_.begin() + params.cells + 1;
    std::fill(counts, counts + params.photons, 1);
    std::iota(counts + params.photons + 1, counters_.end(), 0);
}

void DiscField::iterate() {
    integrator_.buffer(Binding::counters).upload(counters_);
    integrator_.buffer(Binding::photons).upload(photons_);
    integrator_.run_from_grid();
}

std::vector<gpu::Gathered> DiscField::gathered() {
    return integrator_.buffer(Binding::gathered).download<gpu::Gathered>(hits_.size());
}

glm::dvec2 polar(double distance, double v) {
    return {distance * std::cos(2.0 * pi * v), distance * std::sin(2.0 * pi * v)};
}

Disc Spread::disc(double u, double v) const {
    // N c^2 / (2 log spread) photons are within c distance.
    const double share = std::sqrt(in_disc * 2.0 * std::log(spread) / photons);
    const double distance = reach * std::pow(spread, u - 1.0);
    return {polar(distance, v), share * distance};
}

glm::dvec2 Spread::photon(double u, double v) const { return polar(reach * std::pow(spread, u - 1.0), v); }

}  // namespace vkcppm::test
