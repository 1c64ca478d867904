#include "render/sums.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

namespace vkcppm {
namespace {

/// Of a pixel's sum; 0 where noise has left it below, and what is no number as it is.
double mean_of(double sum, std::uint32_t iterations) {
    const double mean = sum / double(std::max(iterations, 1u));
    return mean < 0.0 ? 0.0 : mean;
}

}  // namespace

Image picture_of(const IterationSums& sums) {
    Image image{sums.extent, {}};
    image.rgb.reserve(sums.film.size());
    for (const glm::dvec3& sum : sums.film) {
        image.rgb.emplace_back(mean_of(sum.x, sums.iterations), mean_of(sum.y, sums.iterations),
                               mean_of(sum.z, sums.iterations));
    }
    return image;
}

std::map<std::string, std::vector<float>> surface_channels(const IterationSums& sums, double scale) {
    std::map<std::string, std::vector<float>> channels;
    const auto add = [&](const std::string& name, const auto& value) {
        std::vector<float>& channel = channels[name];
        channel.reserve(sums.surfaces.size());
        for (const SurfaceSums& sum : sums.surfaces) channel.push_back(float(value(sum)));
    };
    using Sums = const SurfaceSums&;
    add("ppm.radius", [&](Sums s) { return std::sqrt(double(s.radius2)) / scale; });
    add("ppm.photons", [](Sums s) { return s.photons; });
    add("ppm.batch", [](Sums s) { return s.batch; });
    add("ppm.rejections", [](Sums s) { return s.rejections; });
    add("ppm.statistic", [](Sums s) { return s.statistic; });
    add("ppm.iterations", [](Sums s) { return s.seen; });
    const auto mean = [](double sum, Sums s) { return s.hits > 0.0 ? sum / s.hits : 0.0; };
    add("Z", [&](Sums s) { return mean(s.depth, s) / scale; });
    const double iterations = std::max(1u, sums.iterations);
    add("A", [&](Sums s) { return std::min(1.0, s.hits / iterations); });
    for (int c = 0; c < 3; ++c) {
        const std::string colour(1, "RGB"[c]);
        add("Albedo." + colour, [&](Sums s) { return mean(s.albedo[c], s); });
        add(std::string("N.") + "XYZ"[c], [&](Sums s) { return mean(s.normal[c], s); });
        const auto layer = [&](Sums s, std::uint32_t l) { return s.layer[l][c] / iterations; };
        for (std::uint32_t l = 0; l < LAYERS; ++l) {
            add(fmt::format("{}.{}", layer_names[l], colour), [&](Sums s) { return layer(s, l); });
        }
        std::vector<float>& rest = channels[fmt::format("{}.{}", layer_names[LAYERS], colour)];
        for (std::size_t i = 0; i < sums.surfaces.size(); ++i) {
            double left = mean_of(sums.film[i][c], sums.iterations);
            for (std::uint32_t l = 0; l < LAYERS; ++l) left -= layer(sums.surfaces[i], l);
            rest.push_back(float(left));
        }
    }
    return channels;
}

}  // namespace vkcppm
