// A directional light on a plane: irradiance is uniform, every estimate is unbiased, and the mean squared error is
// variance alone. It falls as n^-s with the exponent that each rule of the radius implies.

#include <cmath>

#include "render/estimators.h"
#include "support/device/rig.h"
#include "support/names.h"
#include "support/scenes/scenes.h"

namespace vkcppm::test {
namespace {

struct Expected {
    const char* estimator;
    double slope;
    const char* why;
};

// Tolerance of a fitted slope: neighbouring discs share photons, so that the mean squared error of the picture has a
// standard error of about 8 %, over a factor of 64 in iterations: slopes of several seeds differ by 0.02.
constexpr double slope_tolerance = 0.1;

class Slope : public GpuTest, public testing::WithParamInterface<Expected> {};

double fitted_slope(const std::vector<double>& x, const std::vector<double>& y) {
    double mx = 0, my = 0, xx = 0, xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        mx += std::log(x[i]) / double(x.size());
        my += std::log(y[i]) / double(x.size());
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (std::log(x[i]) - mx) * (std::log(x[i]) - mx);
        xy += (std::log(x[i]) - mx) * (std::log(y[i]) - my);
    }
    return xy / xx;
}

TEST_P(Slope, OfTheMeanSquaredErrorOverIterations) {
    const Scene scene = project_scene("directional_plane");
    Settings settings;
    settings.estimator = GetParam().estimator;
    settings.size = Extent{48, 48};
    settings.direct = direct_gathered;  // of photons alone
    settings.photons = 16384;
    Rig run(scene, settings, plain_device());
    // rho/pi E cos(theta), the green channel of scenes/directional_plane.expect.json.
    const double truth = 0.3325667;
    std::vector<double> iterations, errors;
    for (std::uint32_t n = 8; n <= 512; n *= 2) {
        run.integrator.run(n - run.integrator.completed());
        double sum = 0.0;
        for (const glm::vec3& rgb : run.integrator.resolve().rgb) sum += (rgb.y - truth) * (rgb.y - truth);
        iterations.push_back(n);
        errors.push_back(sum / (48.0 * 48.0));
    }
    const double slope = fitted_slope(iterations, errors);
    std::string table;
    for (std::size_t i = 0; i < iterations.size(); ++i) {
        table += "\n" + std::to_string(iterations[i]) + " iterations: mse " + std::to_string(errors[i]);
    }
    EXPECT_NEAR(slope, GetParam().slope, slope_tolerance) << GetParam().why << table;
    RecordProperty("slope", std::to_string(slope));
}

INSTANTIATE_TEST_SUITE_P(
    All, Slope,
    testing::Values(Expected{"sppm", -2.0 / 3.0, "R^2 ~ n^(alpha-1): variance ~ n^-alpha"},
                    Expected{"sppm-kz", -2.0 / 3.0, "R^2 ~ n^(alpha-1): variance ~ n^-alpha"},
                    Expected{"cppm", -0.9, "most radii stay: variance ~ n^-1, less the false rejections"},
                    Expected{"cppm-lf", -0.9, "the same"}, Expected{"cppm-gof", -0.9, "the same"},
                    Expected{"cppm-fold", -0.9, "the same"}, Expected{"ftest", -0.9, "the same"},
                    Expected{"ftest-fold", -0.9, "the same"},
                    Expected{"appm", -2.0 / 3.0, "R ~ n^(-1/6) where nothing curves: variance ~ n^(-2/3)"},
                    Expected{"cppm-null", -0.45, "R^2 ~ n^-0.55 at k 0.8 and beta 1.2: variance ~ n^-0.45"}),
    [](const auto& info) { return identifier(info.param.estimator); });

}  // namespace
}  // namespace vkcppm::test
