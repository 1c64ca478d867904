#pragma once
// What iterations add up to, and the picture and its channels as their mean: of a render, or of parts of one.

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "core/image.h"
#include "render/error_estimate.h"
#include "shared/types.h"

namespace vkcppm {

/// Of a pixel, where the settings ask for further channels.
struct SurfaceSums {
    glm::dvec3 albedo{0.0};
    glm::dvec3 normal{0.0};
    double depth = 0.0;  // along the camera's axis, frame units
    double hits = 0.0;   // iterations in which it met a surface, which the sums above are over
    glm::dvec3 layer[LAYERS] = {};
    double seen = 0.0;     // iterations in which it gathered
    double photons = 0.0;  // that it has accepted
    // Not sums: as the last iteration has left them.
    float radius2 = 0.0f;  // frame units squared
    float batch = 0.0f;
    float rejections = 0.0f;
    float statistic = 0.0f;
};

struct IterationSums {
    Extent extent;
    std::uint32_t iterations = 0;
    std::vector<glm::dvec3> film;       // [P] radiance
    std::vector<SurfaceSums> surfaces;  // [P], or none
    ErrorSums errors;                   // where they are estimated; groups without an iteration are empty
};

/// The mean, 0 where noise has left it below (shaders/kernels/resolve.comp).
Image picture_of(const IterationSums& sums);

/// Of the layers LAYER_*, and of what is left of the picture.
inline constexpr std::array<const char*, LAYERS + 1> layer_names = {"direct", "caustic", "rest"};

/// Channels [P] of the surfaces: ppm.radius (m), ppm.photons, ppm.batch, ppm.rejections, ppm.statistic (over its
/// threshold), ppm.iterations, Z (m), Albedo.R/G/B, N.X/Y/Z, A, and the layers direct, caustic and rest. scale: frame
/// units a metre.
std::map<std::string, std::vector<float>> surface_channels(const IterationSums& sums, double scale);

}  // namespace vkcppm
