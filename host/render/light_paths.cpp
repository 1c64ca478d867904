#include "render/light_paths.h"

#include <algorithm>
#include <cmath>

#include "render/integrator.h"

namespace vkcppm {
namespace {

constexpr std::uint32_t counted_paths = 16384;
constexpr std::uint32_t counted_seed = 1;
constexpr double factor = 200.0;          // A
constexpr double rays_a_pixel = 5.0;      // at most
constexpr double fewest = 10, most = 19;  // logarithms to base 2

}  // namespace

std::uint32_t light_paths(const SceneOnDevice& scene, const Camera& camera, const Settings& settings) {
    if (settings.photons) return *settings.photons;
    if (settings.direct != direct_sampled || scene.flat().lights.empty()) return usual_light_paths;
    Settings counted = settings;
    counted.size = Extent{1, 1};
    counted.photons = counted_paths;
    counted.seed = counted_seed;
    counted.aovs = false;
    Integrator integrator(scene, camera, counted);
    // The first iteration may trace its paths again, with more room for photons.
    Report first, second;
    integrator.run(1);
    integrator.fill(first);
    integrator.run(1);
    integrator.fill(second);
    const double rays = double(second.rays - first.rays) / counted_paths;  // those of the one pixel are few
    const double photons = std::max(1.0, double(second.stored_photons - first.stored_photons)) / counted_paths;
    const double pixels = double(settings.size->pixels());
    const double paths = std::min(factor * std::sqrt(pixels / (rays * photons)), rays_a_pixel * pixels / rays);
    return 1u << std::uint32_t(std::lround(std::clamp(std::log2(paths), fewest, most)));
}

}  // namespace vkcppm
