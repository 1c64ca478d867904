#pragma once
// Unidirectional path tracing of a Scene: the second opinion on a whole picture.

#include <cstddef>
#include <cstdint>

#include "core/image.h"
#include "reference/intersect.h"
#include "scene/scene.h"

namespace vkcppm::reference {

struct PathTracerSettings {
    Extent size;
    std::uint32_t samples = 64;            // paths a pixel, >= 2
    std::uint32_t max_depth = 64;          // bounces
    std::uint64_t seed = 1;
    std::size_t camera = 0;                // into Scene::cameras
};

struct PathTracing {
    Image mean;                            // radiance, box filter
    Image standard_error;                  // of the mean, a pixel and channel
};

/// The ray of `camera` through film position (x, y) in pixels, (0, 0) the upper left corner of a picture of that size.
Ray camera_ray(const Camera& camera, const Extent& size, double x, double y);

/// At diffuse surfaces one point on the emissive triangles is sampled and combined with what the next bounce meets by
/// the balance heuristic (Veach and Guibas 1995), and every punctual light is sampled. So light of a punctual light
/// through glass or off a mirror is missing: no path tracer finds it. Throws as scattering() does. Runs on all cores;
/// the same seed gives the same bits.
PathTracing path_trace(const Scene& scene, const PathTracerSettings& settings);

}  // namespace vkcppm::reference
