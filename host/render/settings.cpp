#include "render/settings.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "render/estimators.h"
#include "shared/types.h"

namespace vkcppm {
namespace {

constexpr std::uint32_t default_longer_side = 512;
constexpr std::uint32_t max_side = 65536;
constexpr std::size_t max_pixels = std::size_t(1) << 27;
constexpr double longest = 1e9;  // m, of a lens; one over it is the shortest

template <typename T> void check_range(const char* option, T value, T low, T high) {
    if (!(value >= low && value <= high)) {
        throw Error(ExitCode::usage, fmt::format("{} {} is outside {}..{}", option, value, low, high));
    }
}

/// The kernels take the value as a float, which must not be an end of the range either.
void check_open(const char* option, double value, double low, double high) {
    if (!(float(value) > float(low) && float(value) < float(high))) {
        throw Error(ExitCode::usage, fmt::format("{} {} is not between {} and {}", option, value, low, high));
    }
}

/// Index of the camera that `wanted` names: by name, else by index; empty is the first.
std::size_t find_camera(const std::string& wanted, const Scene& scene) {
    if (wanted.empty()) return 0;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        if (scene.cameras[i].name == wanted) return i;
        names.push_back(fmt::format("{} '{}'", i, scene.cameras[i].name));
    }
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
    if (error == std::errc() && end == wanted.data() + wanted.size() && index < scene.cameras.size()) return index;
    throw Error(ExitCode::usage, fmt::format("--camera '{}' is none of the cameras of {}: {}", wanted,
                                             scene.file.string(), fmt::join(names, ", ")));
}

Extent default_size(const Camera& camera) {
    const double aspect = camera.aspect.value_or(1.0);
    const auto side = [](double pixels) {
        return std::uint32_t(std::clamp(std::lround(pixels), 1l, long(default_longer_side)));
    };
    return aspect >= 1.0 ? Extent{default_longer_side, side(default_longer_side / aspect)}
                         : Extent{side(default_longer_side * aspect), default_longer_side};
}

/// A lens has an opening and a distance at which it is sharp, or neither.
void check_lens(double aperture, const std::optional<double>& focus_distance) {
    check_range("--aperture", aperture, 0.0, longest);
    if (focus_distance) check_range("--focus-distance", *focus_distance, 1.0 / longest, longest);
    if (aperture > 0.0 && !focus_distance) {
        throw Error(ExitCode::usage, fmt::format("--aperture {} needs --focus-distance", aperture));
    }
    if (focus_distance && aperture == 0.0) {
        throw Error(ExitCode::usage,
                    fmt::format("--focus-distance {} needs --aperture greater than 0", *focus_distance));
    }
}

}  // namespace

Settings resolve_settings(const Settings& settings, const Scene& scene) {
    Settings resolved = settings;
    const EstimatorRow& estimator = find_estimator(settings.estimator);
    check_range<std::uint32_t>("--iterations", settings.iterations, 1, max_iterations);
    if (settings.seconds) check_open("--time", *settings.seconds, 0.0, 1e9);
    check_range<std::uint32_t>("--photons", settings.photons, 1, 1u << 24);
    check_lens(settings.aperture, settings.focus_distance);
    check_range<std::uint32_t>("--max-depth", settings.max_depth, 1, 1024);
    check_range<std::uint32_t>("--knn", settings.knn, 2, 256);
    check_open("--alpha", settings.alpha, 0.0, 1.0);
    check_open("--k", settings.k, 0.0, 1.0);
    if (!(settings.beta >= 1.0 && settings.beta <= 1000.0)) {
        throw Error(ExitCode::usage, fmt::format("--beta {} is outside 1..1000", settings.beta));
    }
    check_open("--significance", settings.significance, 0.0, 1.0);
    check_range<std::uint32_t>("--rings", settings.rings, 1, MAX_RINGS);
    if (settings.sectors != 4 && settings.sectors != 6 && settings.sectors != 8 && settings.sectors != 12) {
        throw Error(ExitCode::usage, fmt::format("--sectors {} is none of 4, 6, 8, 12", settings.sectors));
    }
    static_assert(MAX_SECTORS == 12);
    if (estimator.statistic == Statistic::tally && cells(estimator, 1, settings.sectors) < 2 + estimator.fitted) {
        throw Error(ExitCode::usage, fmt::format("--sectors {} leave the test of {} no degree of freedom",
                                                 settings.sectors, estimator.name));
    }
    resolved.estimator = std::string(estimator.name);

    const std::size_t camera = find_camera(settings.camera, scene);
    resolved.camera = std::to_string(camera);
    if (!settings.size) resolved.size = default_size(scene.cameras.at(camera));
    check_range<std::uint32_t>("--size: width", resolved.size->width, 1, max_side);
    check_range<std::uint32_t>("--size: height", resolved.size->height, 1, max_side);
    if (resolved.size->pixels() > max_pixels) {
        throw Error(ExitCode::usage, fmt::format("--size: {}x{} are {} pixels; the limit is {}", resolved.size->width,
                                                 resolved.size->height, resolved.size->pixels(), max_pixels));
    }
    return resolved;
}

std::vector<Feature> features_of(const Settings& settings) {
    std::vector<Feature> features;
    if (settings.aovs) features.push_back({FEATURE_AOVS, "further channels", "--aovs"});
    if (settings.aperture > 0.0)
        features.push_back({FEATURE_LENS, "depth of field", fmt::format("--aperture {:g}", settings.aperture)});
    if (settings.caustics) features.push_back({FEATURE_SPLIT, "caustics alone", "a reference"});
    return features;
}

const Camera& camera_of(const Settings& settings, const Scene& scene) {
    std::size_t index = 0;
    std::from_chars(settings.camera.data(), settings.camera.data() + settings.camera.size(), index);
    return scene.cameras.at(index);
}

}  // namespace vkcppm
