#pragma once
// Discs and photons of given places on one plane, fed to the real grid and gather kernels.

#include <cstdint>
#include <random>
#include <vector>

#include <glm/vec2.hpp>

#include "flat/flatten.h"
#include "render/integrator.h"
#include "render/settings.h"
#include "vk/device.h"

namespace vkcppm::test {

/// Of the plane's square from -1 to 1, m.
struct Disc {
    glm::dvec2 centre{0.0};
    double radius = 0.0;
};

/// Settings::size pixels, each with a disc that keeps its radius, and Settings::photons photons of power 1.
class DiscField {
public:
    DiscField(Device& device, const Settings& settings, const std::vector<Disc>& discs,
              const std::vector<glm::dvec2>& photons);

    /// One iteration from the grid on.
    void iterate();

    Integrator& integrator() { return integrator_; }
    gpu::Grid grid() { return integrator_.buffer(Binding::grid).download_value<gpu::Grid>(); }
    /// [P] what the last iteration found.
    std::vector<gpu::Gathered> gathered();

    /// [P] in frame units, as uploaded; positions [N] of the photons.
    const std::vector<gpu::HitPosition>& hits() const { return hits_; }
    const std::vector<gpu::PixelState>& states() const { return states_; }
    const std::vector<gpu::Photon>& photons() const { return photons_; }

private:
    Scene scene_;
    FlatScene flat_;
    SceneOnDevice on_device_;
    Integrator integrator_;
    std::vector<gpu::HitPosition> hits_;
    std::vector<gpu::PixelState> states_;
    std::vector<gpu::Photon> photons_;
    std::vector<std::uint32_t> counters_;
};

/// At a distance from the middle, in the direction of v in [0, 1).
glm::dvec2 polar(double distance, double v);

/// Photons of density 1 / distance^2 from reach / spread to reach, and discs that each expect `in_disc` of them: their
/// radii go with the distance, and with the inverse root of the density.
struct Spread {
    double reach = 0.7;   // m
    double spread = 1e3;  // largest radius over the smallest
    double in_disc = 10.0;
    std::uint32_t photons = 0;

    Disc disc(double u, double v) const;
    glm::dvec2 photon(double u, double v) const;
};

}  // namespace vkcppm::test
