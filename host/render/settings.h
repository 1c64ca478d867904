#pragma once
// What a render is asked to do. Defaults are the paper's (Lin et al. 2020, supplementary section 1).

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "flat/feature.h"
#include "scene/scene.h"

namespace vkcppm {

/// Beyond, the counter of random numbers starts again and iterations repeat.
inline constexpr std::uint32_t max_iterations = (1u << 30) - 1;

struct Settings {
    std::string estimator = "cppm";        // a name of render/estimators.h
    std::uint32_t iterations = 64;         // 1..max_iterations; an upper bound where `seconds` is set
    std::optional<double> seconds;         // stop after the iteration in which this wall time is passed
    std::uint32_t photons = 65536;         // light paths emitted an iteration, 1..2^24
    std::optional<Extent> size;            // default: 512 on the longer side at the camera's aspect
    std::string camera;                    // name or index; empty: the first
    double aperture = 0.0;                 // m, diameter of the lens; 0: a pinhole
    std::optional<double> focus_distance;  // m along the camera's axis, > 0; needed where there is an aperture
    std::uint32_t seed = 1;
    std::uint32_t max_depth = 64;    // bounces of a light path and of an eye path, 1..1024
    std::uint32_t knn = 10;          // k nearest photons give the starting radius, 2..256
    double alpha = 2.0 / 3.0;        // sppm, sppm-kz: 0 < alpha < 1
    double k = 0.8;                  // cppm: area factor where no inner disc passes, 0 < k < 1
    double beta = 1.2;               // cppm: growth of a batch after a rejection, 1 <= beta
    double significance = 0.05;      // of every test, 0 < x < 1
    std::uint32_t rings = 2;         // n_a
    std::uint32_t sectors = 6;       // n_s
    std::optional<double> caustics;  // caustics alone, for a reference (study/reference.h): the starting radius in
                                     // footprints of the pixel, a quarter of it at a photon's first rough surface
    bool aovs = false;               // also depth, albedo, normal and the state of every pixel
};

/// Throws Error(usage) where a setting is out of range, with its name, value and limit.
/// `scene` resolves what depends on it: the size of the picture and the camera.
Settings resolve_settings(const Settings& settings, const Scene& scene);

/// The camera of resolved settings, which hold its index.
const Camera& camera_of(const Settings& settings, const Scene& scene);

/// What the settings ask of the kernels.
std::vector<Feature> features_of(const Settings& settings);

}  // namespace vkcppm
