#pragma once
// Photons drawn from known densities and fed to the real grid, gather and update kernels. Every pixel looks at a point
// of its own on one plane; the points are so far apart that their photons never mix, so the pixels are independent
// trials of one field.

#include <cstdint>
#include <random>
#include <span>
#include <string_view>
#include <vector>

#include "flat/flatten.h"
#include "render/integrator.h"
#include "render/settings.h"
#include "vk/device.h"

namespace vkcppm::test {

using Random = std::mt19937_64;

/// Uniform in [0, 1), 53 bits.
double uniform(Random& random);

/// A field about a point, x and y in units of the starting radius R_1: photons fall with the density
/// lambda / pi * f(x, y) and carry psi(x, y). f(0) E[psi(0)] = 1: the estimate has to approach 1.
struct Field {
    std::string_view name;
    std::string_view formula;                              // of f, and of psi where it is not 1
    double (*density)(double x, double y);                 // f
    double peak;                                           // of f within two radii
    double (*weight)(double x, double y, Random& random);  // psi
    std::uint32_t cluster = 1;                             // photons of a path, which land together
};

/// uniform, linear, gauss, edge, ridge, sine, uniform-clustered, edge-clustered, flux-gradient, heavy-tailed.
std::span<const Field> fields();
const Field& find_field(std::string_view name);

/// side x side pixels on one field.
class SyntheticField {
public:
    /// `lambda`: photons expected in a first disc of density 1. The estimator and its parameters are those of
    /// `settings`; its size and number of paths are set here.
    SyntheticField(Device& device, Settings settings, const Field& field, std::uint32_t side, double lambda,
                   std::uint64_t seed);

    /// Iterations on fresh photons, a Poisson process.
    void run(std::uint32_t iterations);

    /// One iteration on exactly `count` photons in the first disc of every pixel, drawn with the field's density.
    void run_exact(std::uint32_t count);

    /// Back to the first radius and empty statistics, with this batch.
    void reset(double batch);

    /// Sets the batch of every pixel and nothing else.
    void set_batch(double batch);

    /// Iterations of which only the last one tests.
    void look_once_after(std::uint32_t iterations);

    std::uint64_t pixels() const { return points_.size(); }
    double first_radius2() const { return radius2_; }  // frame units
    std::vector<gpu::PixelState> states();
    void set_states(const std::vector<gpu::PixelState>& states);

    /// Share of pixels that rejected at least once since the reset.
    double rejected();

    /// Mean over the iterations since the reset, a pixel.
    std::vector<double> estimates();

    Integrator& integrator() { return integrator_; }

private:
    void upload_hits();
    void add_photon(std::size_t pixel, double x, double y);
    void iterate();

    const Field& field_;
    Settings settings_;
    FlatScene flat_;
    SceneOnDevice on_device_;
    Integrator integrator_;
    double lambda_;
    double reach_;  // radii around a point within which photons can matter
    double radius2_;
    float power_;  // of a photon with psi = 1
    Random random_;
    std::uint32_t iterations_ = 0;   // since the reset
    std::vector<glm::vec3> points_;  // frame
    std::vector<gpu::Photon> photons_;
    std::vector<gpu::PhotonFlux> flux_;
    std::vector<std::uint32_t> counters_;
};

}  // namespace vkcppm::test
