#pragma once
// Radiance as a screen shows it: exposure, and a curve that brings what is brighter than white below it.

#include <string_view>

#include <glm/vec3.hpp>

#include "core/image.h"

namespace vkcppm {

enum class ToneMap { none, reinhard, aces, agx };

struct Display {
    ToneMap tone_map = ToneMap::none;
    double exposure = 0.0;  // stops
};

/// "none", "reinhard", "aces" or "agx".
std::string_view name_of(ToneMap tone_map);

/// Y of linear Rec. 709 (ITU-R BT.709), W m^-2 sr^-1.
double luminance(const glm::dvec3& rgb);

/// ACES's filmic curve as Narkowicz fitted it ("ACES Filmic Tone Mapping Curve", 2016), with the factor 0.6 that he
/// gives to undo its exposure: linear x >= 0 to linear light of the screen, 0..1.03.
double aces_curve(double x);

/// `radiance` times 2^exposure through the curve: linear light of the screen, 0 is black and 1 is white; what is above
/// it is clipped by whoever encodes it. Negative radiance and NaN are black.
///   none      as it is
///   reinhard  over 1 + its luminance (Reinhard et al. 2002, eq. 3)
///   aces      aces_curve of each channel
///   agx       Sobotka's AgX without a look, by Wrensch's polynomial ("Minimal AgX Implementation", 2023), whose
///             display has a gamma of 2.2
glm::dvec3 shown(const glm::dvec3& radiance, const Display& display);

/// The exposure at which the median luminance of the pixels that are not black is 0.18, middle grey; 0 where all are.
double automatic_exposure(const Image& image);

/// The share of the pixels (0..1) that are brighter than the curve can tell apart: a channel is above white or, by agx,
/// above the 4.03 stops over 1 at which its curve ends. Those with NaN are not.
double clipped_share(const Image& image, const Display& display);

/// The largest exposure, to a hundredth of a stop, at or below display.exposure by which no more than `share` of the
/// pixels are clipped; -128 where there is none.
double exposure_without_clipping(const Image& image, const Display& display, double share);

}  // namespace vkcppm
