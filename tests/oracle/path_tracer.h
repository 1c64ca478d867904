#pragma once
// Unidirectional path tracing of a Scene: the second opinion on a whole picture.

#include <cstddef>
#include <cstdint>

#include <glm/vec2.hpp>

#include "core/image.h"
#include "oracle/intersect.h"
#include "scene/scene.h"

namespace vkcppm::oracle {

struct PathTracerSettings {
    Extent size;
    std::uint32_t samples = 64;    // paths a pixel, >= 2
    std::uint32_t max_depth = 64;  // bounces
    std::uint64_t seed = 1;
    std::size_t camera = 0;       // into Scene::cameras
    double aperture = 0.0;        // m, diameter of the lens; 0: a pinhole
    double focus_distance = 1.0;  // m along the camera's axis to the plane that is sharp
};

struct PathTracing {
    Image mean;            // radiance, box filter
    Image standard_error;  // of the mean, a pixel and channel
};

/// The ray of `camera` through film position (x, y) in pixels, (0, 0) the upper left corner of a picture of that size.
Ray camera_ray(const Camera& camera, const Extent& size, double x, double y);

/// The same through a point of a thin lens, in m from its centre along the camera's x and y: all rays of a film
/// position meet on the plane at `focus_distance`.
Ray lens_ray(const Camera& camera, const Extent& size, double x, double y, const glm::dvec2& lens,
             double focus_distance);

/// At every surface with a lobe that is no delta, one point on the emissive triangles and one direction to the
/// environment are sampled, each combined with what the next bounce meets by the balance heuristic (Veach and Guibas
/// 1995), and every punctual light is sampled. All glass blocks these connections, thin or solid: what comes through it
/// is found by the bounces that meet an emitter. So light of a punctual light through glass or off a mirror is missing:
/// no path tracer finds it. Runs on all cores; the same seed gives the same bits.
///
/// Radiance is not scaled by the squared index: paths start and end in air. Paths remember the volumes that they are
/// in; the innermost absorbs. Alpha is a coin for paths and a factor for connections. An unlit surface is seen by the
/// camera and by way of delta lobes, and ends every path. A path that first goes through a dispersive surface draws one
/// wavelength there, for Snell's law at once and for all indices from then on.
PathTracing path_trace(const Scene& scene, const PathTracerSettings& settings);

}  // namespace vkcppm::oracle
