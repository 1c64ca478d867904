#pragma once
// A race that nobody ran, for tests of what is made of one.

#include <cmath>
#include <string>
#include <vector>

#include "study/race.h"

namespace vkcppm::test {

/// Entrants of these names on 8x6 pixels, two seeds: errors fall as iterations^(-2/3), from a first one that grows from
/// entrant to entrant; pixel i is nearest in entrant i modulo their number.
inline RaceResult made_up_race(const std::vector<std::string>& names) {
    RaceResult result;
    result.seeds = {7, 8};
    for (std::size_t e = 0; e < names.size(); ++e) {
        RaceRun run;
        run.entrant.name = names[e];
        run.entrant.settings.estimator = names[e].substr(0, names[e].find(':'));
        run.entrant.settings.size = Extent{8, 6};
        run.entrant.settings.iterations = 64;
        run.entrant.settings.photons = 65536;  // counted by who runs one
        for (std::size_t s = 0; s < result.seeds.size(); ++s) {
            Curve curve;
            for (std::uint64_t n = 1; n <= 64; n *= 2) {
                CurvePoint point{n, 0.01 * double(n) * double(e + 1), {}};
                const double error = (0.01 + 0.005 * double(e) + 0.001 * double(s)) * std::pow(double(n), -2.0 / 3.0);
                for (Measure Comparison::*measure : {&Comparison::mse, &Comparison::rmse, &Comparison::relmse,
                                                     &Comparison::smape, &Comparison::srgb_mse}) {
                    point.error.*measure = {error, 0.9 * error};
                }
                curve.push_back(point);
            }
            run.curves.push_back(curve);
            Report report;
            report.iterations = 64;
            report.device = "a <device> & more";
            report.passes = {{"eye", 64, 0.1}, {"scan_sums", 64, 0.2}, {"gather", 64, 0.3}};
            run.reports.push_back(report);
        }
        run.image = {{8, 6}, std::vector<glm::vec3>(48, glm::vec3(0.25f * float(e + 1)))};
        run.radius.assign(48, 0.1f * float(e + 1));
        for (std::size_t i = 0; i < 48; ++i) run.squared_error.push_back(i % names.size() == e ? 0.5 : 1.0);
        result.runs.push_back(run);
    }
    return result;
}

}  // namespace vkcppm::test
