#pragma once
// The mean of a path-traced picture against a number.

#include <cmath>

#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include "oracle/path_tracer.h"

namespace vkcppm::test {

/// The mean of the picture is within four standard errors of `expected`, and those are below `relative` of it.
inline void expect_mean(const oracle::PathTracing& result, const glm::dvec3& expected, double relative) {
    glm::dvec3 mean(0.0), variance(0.0);
    for (std::size_t i = 0; i < result.mean.rgb.size(); ++i) {
        mean += glm::dvec3(result.mean.rgb[i]);
        variance += glm::dvec3(result.standard_error.rgb[i]) * glm::dvec3(result.standard_error.rgb[i]);
    }
    const double pixels = double(result.mean.rgb.size());
    for (int channel = 0; channel < 3; ++channel) {
        const double error = std::sqrt(variance[channel]) / pixels;
        // Radiance is stored in single precision.
        EXPECT_NEAR(mean[channel] / pixels, expected[channel], 4.0 * error + 2e-7 * expected[channel])
            << "channel " << channel << ", standard error " << error;
        EXPECT_LE(error, relative * expected[channel]) << "channel " << channel << ": too noisy to say anything";
    }
}

}  // namespace vkcppm::test
