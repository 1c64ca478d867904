// What each test sees and what it is blind to: one look after thirty iterations of ten photons, at the 5 % level.

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/device/gpu.h"
#include "support/device/synthetic_field.h"
#include "support/names.h"

namespace vkcppm::test {
namespace {

constexpr std::uint32_t side = 32;  // 1,024 pixels: the standard error of a share is at most 0.016

/// Bounds of the share that rejects.
struct Share {
    double low, high;
};

/// The null hypothesis covers the field: 5 %, four standard errors either way.
constexpr Share keeps{0.023, 0.077};

constexpr Share rejects_above(double low) { return {low, 1.0}; }

struct Row {
    std::string field;
    std::map<std::string, Share> shares;  // by estimator
};

std::ostream& operator<<(std::ostream& out, const Row& row) { return out << row.field; }

const std::vector<Row> rows = {
    {"linear",
     {{"cppm", rejects_above(0.98)},
      {"ftest", rejects_above(0.98)},
      {"cppm-lf", keeps},
      {"cppm-gof", keeps},
      {"cppm-fold", keeps},
      {"ftest-fold", keeps}}},
    {"gauss",
     {{"cppm", rejects_above(0.95)},
      {"ftest", rejects_above(0.95)},
      {"cppm-lf", rejects_above(0.95)},
      {"cppm-gof", rejects_above(0.95)},
      {"cppm-fold", rejects_above(0.98)},
      {"ftest-fold", rejects_above(0.97)}}},
    // What is left of an edge by its best linear fit, or once opposite cells are added, is less than the edge.
    {"edge",
     {{"cppm", rejects_above(0.98)},
      {"ftest", rejects_above(0.98)},
      {"cppm-lf", rejects_above(0.6)},
      {"cppm-gof", rejects_above(0.5)},
      {"cppm-fold", rejects_above(0.6)},
      {"ftest-fold", rejects_above(0.6)}}},
    {"ridge",
     {{"cppm", rejects_above(0.85)},
      {"ftest", rejects_above(0.85)},
      {"cppm-lf", rejects_above(0.85)},
      {"cppm-gof", rejects_above(0.85)},
      {"cppm-fold", rejects_above(0.9)},
      {"ftest-fold", rejects_above(0.9)}}},
    {"sine",
     {{"cppm", rejects_above(0.98)},
      {"ftest", rejects_above(0.98)},
      {"cppm-lf", rejects_above(0.68)},
      {"cppm-gof", keeps},
      {"cppm-fold", keeps},
      {"ftest-fold", keeps}}},
    // Chi-squared takes three photons of one path for three observations.
    {"uniform-clustered",
     {{"cppm", rejects_above(0.75)}, {"cppm-fold", rejects_above(0.5)}, {"ftest", keeps}, {"ftest-fold", keeps}}},
    // Counts know nothing of flux.
    {"flux-gradient",
     {{"cppm", keeps},
      {"cppm-lf", keeps},
      {"cppm-gof", keeps},
      {"cppm-fold", keeps},
      {"ftest", rejects_above(0.85)},
      {"ftest-fold", rejects_above(0.92)}}},
    // The analysis of variance is conservative where contributions have heavy tails.
    {"heavy-tailed", {{"cppm", keeps}, {"cppm-fold", keeps}, {"ftest", {0.01, 0.077}}, {"ftest-fold", {0.01, 0.077}}}},
};

class Power : public testing::TestWithParam<Row> {};

TEST_P(Power, EveryTestSeesWhatItsNullHypothesisExcludes) {
    for (const auto& [estimator, share] : GetParam().shares) {
        Settings settings;
        settings.estimator = estimator;
        SyntheticField field(plain_device(), settings, find_field(GetParam().field), side, 10.0, 5);
        field.look_once_after(30);
        EXPECT_GE(field.rejected(), share.low) << estimator << " on " << find_field(GetParam().field).formula;
        EXPECT_LE(field.rejected(), share.high) << estimator << " on " << find_field(GetParam().field).formula;
    }
}

INSTANTIATE_TEST_SUITE_P(Fields, Power, testing::ValuesIn(rows),
                         [](const auto& info) { return identifier(info.param.field); });

// Power of one look at M = 30 and M = 100 photons by simulation on the same fields; folding opposite sectors tests the
// hypothesis of the random flip with more power.
TEST(Folding, HasTheSimulatedPower) {
    struct Case {
        const char* estimator;
        const char* field;
        double at_30, at_100;
    };
    for (const Case& c : {Case{"cppm-gof", "gauss", 0.297, 0.919},
                          {"cppm-fold", "gauss", 0.465, 0.975},
                          {"cppm-gof", "edge", 0.089, 0.247},
                          {"cppm-fold", "edge", 0.129, 0.346},
                          {"cppm-gof", "ridge", 0.308, 0.895},
                          {"cppm-fold", "ridge", 0.455, 0.957}}) {
        Settings settings;
        settings.estimator = c.estimator;
        SyntheticField field(plain_device(), settings, find_field(c.field), 48, 100.0, 6);
        for (const auto& [count, power] : {std::pair{30u, c.at_30}, {100u, c.at_100}}) {
            field.reset(1.0);
            field.run_exact(count);
            // Four standard errors of ours; the simulation's own, of some thousand trials, are smaller.
            const double error = std::sqrt(power * (1.0 - power) / double(field.pixels()));
            EXPECT_NEAR(field.rejected(), power, 4.0 * error) << c.estimator << " on " << c.field << ", M = " << count;
        }
    }
}

}  // namespace
}  // namespace vkcppm::test
