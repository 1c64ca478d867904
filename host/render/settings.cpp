#include "render/settings.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "flat/features.h"
#include "flat/flat_scene.h"
#include "render/estimators.h"
#include "render/settings_rows.h"
#include "shared/types.h"

namespace vkcppm {
namespace {

constexpr std::uint32_t default_longer_side = 512;

// Each throws Error(usage) where a row does not take the value.
template <typename T> void check(const std::string&, const T&, setting::Any) {}
template <typename T> void check(const std::string& option, T value, setting::Within<T> range) {
    if (!(value >= range.low && value <= range.high))
        throw Error(ExitCode::usage, fmt::format("{} {} is outside {}..{}", option, value, range.low, range.high));
}
void check(const std::string& option, double value, setting::Between range) {
    if (!(float(value) > float(range.low) && float(value) < float(range.high))) {
        throw Error(ExitCode::usage,
                    fmt::format("{} {} is not between {} and {}", option, value, range.low, range.high));
    }
}
template <typename T, std::size_t N> void check(const std::string& option, T value, const setting::OneOf<T, N>& list) {
    if (std::ranges::find(list.values, value) == list.values.end()) {
        throw Error(ExitCode::usage, fmt::format("{} {} is none of {}", option, value, fmt::join(list.values, ", ")));
    }
}
void check(const std::string& option, const Extent& size, setting::Pixels limit) {
    check(option + ": width", size.width, setting::within(1u, limit.side));
    check(option + ": height", size.height, setting::within(1u, limit.side));
    if (size.pixels() > limit.pixels) {
        throw Error(ExitCode::usage, fmt::format("{}: {}x{} are {} pixels; the limit is {}", option, size.width,
                                                 size.height, size.pixels(), limit.pixels));
    }
}
void check(const std::string&, const std::string& name, setting::AnEstimator) { find_estimator(name); }
template <std::size_t N>
void check(const std::string& option, const std::string& word, const setting::Words<N>& words) {
    std::vector<std::string> names;
    for (const setting::Word& known : words.values) names.push_back(known.name);
    if (std::ranges::find(names, word) == names.end())
        throw Error(ExitCode::usage, fmt::format("{} '{}' is none of {}", option, word, fmt::join(names, ", ")));
}

/// Index of the camera that `wanted` names: by its name, else by that of its node, else by index; empty is the first.
std::size_t find_camera(const std::string& wanted, const Scene& scene) {
    if (wanted.empty()) return 0;
    std::vector<std::string> names;
    for (const auto name : {&Camera::name, &Camera::node}) {
        const auto found = std::ranges::find(scene.cameras, wanted, name);
        if (found != scene.cameras.end()) return std::size_t(found - scene.cameras.begin());
    }
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        const Camera& camera = scene.cameras[i];
        const bool says_more = !camera.node.empty() && camera.node != camera.name;
        names.push_back(
            fmt::format("{} '{}'{}", i, camera.name, says_more ? fmt::format(" of '{}'", camera.node) : ""));
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
void check_lens(const Settings& settings) {
    if (settings.fstop && settings.aperture > 0.0)
        throw Error(ExitCode::usage, "--fstop and --aperture exclude one another");
    const char* opening = settings.fstop ? "--fstop" : "--aperture";
    const double value = settings.fstop.value_or(settings.aperture);
    if (value > 0.0 && !settings.focus_distance)
        throw Error(ExitCode::usage, fmt::format("{} {} needs --focus-distance", opening, value));
    if (settings.focus_distance && value == 0.0) {
        throw Error(ExitCode::usage,
                    fmt::format("--focus-distance {} needs --aperture greater than 0", *settings.focus_distance));
    }
}

/// A test of a disc in cells needs a degree of freedom in its innermost ring.
void check_cells(const EstimatorRow& estimator, std::uint32_t sectors) {
    static_assert(MAX_SECTORS == 12);
    if (estimator.statistic == Statistic::tally && cells_of_disc(estimator, 1, sectors) < 2 + estimator.fitted) {
        throw Error(ExitCode::usage,
                    fmt::format("--sectors {} leave the test of {} no degree of freedom", sectors, estimator.name));
    }
}

}  // namespace

void check_settings(const Settings& settings) {
    setting::for_each([&](const auto& row) {
        if (const auto* value = setting::given(settings.*row.member))
            check(fmt::format("--{}", row.name), *value, row.values);
    });
    check_cells(find_estimator(settings.estimator), settings.sectors);
    check_lens(settings);
}

Settings resolve_settings(const Settings& settings, const Scene& scene) {
    check_settings(settings);
    Settings resolved = settings;
    const std::size_t index = find_camera(settings.camera, scene);
    const Camera& camera = scene.cameras.at(index);
    resolved.camera = std::to_string(index);
    if (!settings.size) resolved.size = default_size(camera);
    if (settings.fstop && camera.ymag)
        throw Error(ExitCode::usage, "--fstop needs a perspective camera; --aperture tells the diameter");
    return resolved;
}

double lens_diameter(const Settings& settings, const Camera& camera) {
    if (!settings.fstop) return settings.aperture;
    constexpr double half_film = 0.018;  // m, of the longer side
    const auto [width, height] = *settings.size;
    const double longer = std::max(1.0, double(width) / double(height));
    return half_film / (std::tan(0.5 * camera.yfov) * longer) / *settings.fstop;
}

std::vector<Feature> features_of(const Settings& settings) {
    std::vector<Feature> features;
    if (settings.aovs) features.push_back(make_feature(FEATURE_AOVS, "--aovs"));
    if (settings.error) features.push_back(make_feature(FEATURE_ERRORS, "--error"));
    if (settings.caustics) features.push_back(make_feature(FEATURE_SPLIT, "a reference"));
    if (!settings.caustics && settings.direct == direct_sampled)
        features.push_back(make_feature(FEATURE_DIRECT, fmt::format("--direct {}", direct_sampled)));
    return features;
}

std::uint32_t feature_bits(const FlatScene& scene, const Settings& settings) {
    return bits_of(scene.features) | bits_of(features_of(settings));
}

const Camera& camera_of(const Settings& settings, const Scene& scene) {
    std::size_t index = 0;
    std::from_chars(settings.camera.data(), settings.camera.data() + settings.camera.size(), index);
    return scene.cameras.at(index);
}

}  // namespace vkcppm
