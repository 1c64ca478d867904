#include "app/race/pictures.h"

#include <cmath>

#include <fmt/format.h>

#include "io/png.h"
#include "render/sums.h"
#include "study/winner.h"

namespace vkcppm {
namespace {

constexpr double difference_quantile = 0.99;
constexpr double radius_tail = 0.005;

/// Okabe and Ito 2008 without black and yellow, and others of Tol's schemes (SRON/EPS/TN/09-002).
constexpr std::array<glm::u8vec3, 10> colours = {{{0, 114, 178},
                                                  {213, 94, 0},
                                                  {0, 158, 115},
                                                  {204, 121, 167},
                                                  {230, 159, 0},
                                                  {86, 180, 233},
                                                  {153, 79, 190},
                                                  {153, 153, 51},
                                                  {204, 51, 85},
                                                  {120, 130, 140}}};
constexpr glm::u8vec3 no_winner_colour{200, 200, 200};

WinnerPicture winner_picture(Extent extent, std::span<const std::vector<double>> errors) {
    const std::vector<int> nearest = winners(errors);
    WinnerPicture picture{{extent, {}}, winner_shares(nearest, errors.size())};
    for (const int winner : nearest) {
        picture.map.rgb.push_back(winner == no_winner ? no_winner_colour : entrant_colour(std::size_t(winner)));
    }
    return picture;
}

/// Light of one layer, as the picture has it.
Image layer_of(const RaceRun& run, const char* layer) {
    Image image{run.image.extent, std::vector<glm::vec3>(run.image.rgb.size())};
    for (int c = 0; const char* colour : {"R", "G", "B"}) {
        const std::vector<float>& values = run.aovs.at(fmt::format("{}.{}", layer, colour));
        for (std::size_t i = 0; i < values.size(); ++i) image.rgb[i][c] = values[i];
        ++c;
    }
    return image;
}

}  // namespace

std::vector<std::string> entrant_views(const Settings& settings) {
    std::vector<std::string> views = {"picture", "difference", "radius"};
    if (settings.aovs) views.insert(views.end(), layer_names.begin(), layer_names.end());
    return views;
}

glm::u8vec3 entrant_colour(std::size_t entrant) { return colours[entrant % colours.size()]; }

RacePictures race_pictures(const RaceResult& result, const Image& reference, const Display& display) {
    RacePictures pictures;
    pictures.display = display;
    const Extent extent = reference.extent;
    std::vector<float> all_differences, all_radii;
    std::vector<std::vector<double>> errors, errors_around;  // [entrants][pixels]
    for (const RaceRun& run : result.runs) {
        const std::vector<float> difference = absolute_difference(run.image, reference);
        all_differences.insert(all_differences.end(), difference.begin(), difference.end());
        all_radii.insert(all_radii.end(), run.radius.begin(), run.radius.end());
        errors.push_back(run.squared_error);
        errors_around.push_back(neighbourhood_mean(extent, run.squared_error, winner_reach));
    }
    pictures.difference = {0.0, positive_quantile(all_differences, difference_quantile), false};
    pictures.radius.low = positive_quantile(all_radii, radius_tail);
    pictures.radius.high = positive_quantile(all_radii, 1.0 - radius_tail);
    pictures.radius.logarithmic = true;
    pictures.reference = to_bitmap(reference, display);
    for (const RaceRun& run : result.runs) {
        const std::vector<float> difference = absolute_difference(run.image, reference);
        EntrantPictures& views = pictures.entrants.emplace_back();
        views["picture"] = to_bitmap(run.image, display);
        views["difference"] = false_colours(extent, difference, pictures.difference);
        views["radius"] = false_colours(extent, run.radius, pictures.radius);
        if (!run.entrant.settings.aovs) continue;
        for (const char* layer : layer_names) views[layer] = to_bitmap(layer_of(run, layer), display);
    }
    pictures.winner = winner_picture(extent, errors);
    pictures.winner_around = winner_picture(extent, errors_around);
    return pictures;
}

}  // namespace vkcppm
