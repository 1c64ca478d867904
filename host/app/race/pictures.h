#pragma once
// A race as pictures.

#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <glm/ext/vector_uint3_sized.hpp>

#include "study/false_colour.h"
#include "core/display.h"
#include "core/image.h"
#include "study/race.h"

namespace vkcppm {

inline constexpr int winner_reach = 4;  // pixels about one that decide who is nearest around it: 9x9

/// What can be seen of an entrant: "picture"; "difference", |x - r|, mean over channels, W m^-2 sr^-1; "radius", m; and
/// where its settings ask for further channels the layers direct, caustic and rest, which sum to the picture.
std::vector<std::string> entrant_views(const Settings& settings);

using EntrantPictures = std::map<std::string, Bitmap>;  // by the view

struct WinnerPicture {
    Bitmap map;                  // entrant_colour of the winner, gray without one
    std::vector<double> shares;  // [entrants] of the pixels
};

struct RacePictures {
    Display display;  // of pictures, not of maps
    Bitmap reference;
    std::vector<EntrantPictures> entrants;  // of the first seed
    ColourScale difference;                 // of all entrants: 0 to the value that 99 % of all pixels do not exceed
    ColourScale radius;                     // of all entrants, logarithmic: from their 0.5 % to their 99.5 % quantile
    WinnerPicture winner;                   // the least squared error, mean over the seeds
    WinnerPicture winner_around;            // the same of the mean over winner_reach about the pixel
};

/// sRGB. Colours that the colour-blind can tell apart and that are seen on white and on black; they repeat after ten.
glm::u8vec3 entrant_colour(std::size_t entrant);

/// display: of pictures, not of maps.
RacePictures race_pictures(const RaceResult& result, const Image& reference, const Display& display);

}  // namespace vkcppm
