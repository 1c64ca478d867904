// Every estimator on every synthetic field: mean squared error after 1,000 iterations, printed as a Markdown table
// beside the values of an earlier simulation without the renderer; and how often cppm rejects a uniform field. By hand:
//   cmake --build build --target bench_fields && build/tests/bench_fields [--iterations N] [--side PIXELS]
// Fixed seeds; an estimator's column meets the same photons as another's, but for appm, which looks further.

#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "render/estimators.h"
#include "support/device/synthetic_field.h"

using namespace vkcppm;
using namespace vkcppm::test;

namespace {

/// (field, estimator) -> mean squared error at 1,000 iterations, 400 pixels, by the earlier simulation.
const std::map<std::pair<std::string_view, std::string_view>, double> simulated = {
    {{"uniform", "sppm"}, 9.8e-4},
    {{"uniform", "sppm-kz"}, 6.6e-4},
    {{"uniform", "cppm"}, 1.8e-4},
    {{"uniform", "cppm-fold"}, 1.8e-4},
    {{"uniform", "ftest"}, 1.9e-4},
    {{"uniform", "ftest-fold"}, 1.9e-4},
    {{"uniform", "appm"}, 1.3e-3},
    {{"linear", "sppm"}, 1.1e-3},
    {{"linear", "sppm-kz"}, 7.2e-4},
    {{"linear", "cppm"}, 1.9e-3},
    {{"linear", "cppm-fold"}, 1.9e-4},
    {{"linear", "ftest"}, 1.7e-3},
    {{"linear", "ftest-fold"}, 1.9e-4},
    {{"linear", "cppm-lf"}, 2.2e-4},
    {{"linear", "cppm-gof"}, 2.4e-4},
    {{"gauss", "sppm"}, 8.4e-3},
    {{"gauss", "sppm-kz"}, 2.1e-2},
    {{"gauss", "cppm"}, 1.9e-2},
    {{"gauss", "cppm-fold"}, 1.7e-2},
    {{"gauss", "ftest"}, 2.0e-2},
    {{"gauss", "ftest-fold"}, 1.7e-2},
    {{"gauss", "appm"}, 4.6e-3},
    {{"edge", "sppm"}, 1.3e-3},
    {{"edge", "sppm-kz"}, 4.0e-3},
    {{"edge", "cppm"}, 1.9e-3},
    {{"edge", "cppm-fold"}, 2.4e-3},
    {{"edge", "ftest"}, 1.8e-3},
    {{"edge", "ftest-fold"}, 2.5e-3},
    {{"edge", "cppm-lf"}, 2.6e-3},
    {{"edge", "cppm-gof"}, 3.5e-3},
    {{"edge", "appm"}, 3.0e-3},
    {{"ridge", "sppm"}, 1.6e-1},
    {{"ridge", "sppm-kz"}, 2.3e-1},
    {{"ridge", "cppm"}, 8.4e-2},
    {{"ridge", "cppm-fold"}, 7.5e-2},
    {{"ridge", "ftest"}, 8.4e-2},
    {{"ridge", "ftest-fold"}, 7.3e-2},
    {{"ridge", "appm"}, 5.0e-2},
    {{"sine", "sppm"}, 9.7e-4},
    {{"sine", "sppm-kz"}, 6.8e-4},
    {{"sine", "cppm"}, 3.1e-3},
    {{"sine", "cppm-fold"}, 1.8e-4},
    {{"sine", "ftest"}, 3.1e-3},
    {{"sine", "ftest-fold"}, 2.0e-4},
    {{"sine", "cppm-gof"}, 1.9e-4},
    {{"uniform-clustered", "sppm"}, 3.0e-3},
    {{"uniform-clustered", "sppm-kz"}, 2.1e-3},
    {{"uniform-clustered", "cppm"}, 1.4e-2},
    {{"uniform-clustered", "cppm-fold"}, 1.1e-2},
    {{"uniform-clustered", "ftest"}, 6.8e-4},
    {{"uniform-clustered", "ftest-fold"}, 6.3e-4},
    {{"edge-clustered", "sppm"}, 4.4e-3},
    {{"edge-clustered", "sppm-kz"}, 6.4e-3},
    {{"edge-clustered", "cppm"}, 1.2e-2},
    {{"edge-clustered", "cppm-fold"}, 9.8e-3},
    {{"edge-clustered", "ftest"}, 5.8e-3},
    {{"edge-clustered", "ftest-fold"}, 9.7e-3},
    {{"flux-gradient", "sppm"}, 1.3e-2},
    {{"flux-gradient", "sppm-kz"}, 1.8e-2},
    {{"flux-gradient", "cppm"}, 8.2e-2},
    {{"flux-gradient", "cppm-fold"}, 8.2e-2},
    {{"flux-gradient", "ftest"}, 1.8e-2},
    {{"flux-gradient", "ftest-fold"}, 1.6e-2},
    {{"heavy-tailed", "sppm"}, 5.3e-3},
    {{"heavy-tailed", "sppm-kz"}, 3.6e-3},
    {{"heavy-tailed", "cppm"}, 1.4e-3},
    {{"heavy-tailed", "cppm-fold"}, 1.2e-3},
    {{"heavy-tailed", "ftest"}, 9.3e-4},
    {{"heavy-tailed", "ftest-fold"}, 1.1e-3},
};

SyntheticField make_field(Device& device, std::string_view estimator, const Field& field, std::uint32_t side) {
    Settings settings;
    settings.estimator = estimator;
    return SyntheticField(device, settings, field, side, 10.0, 1);
}

double mean_squared_error(SyntheticField& field) {
    double sum = 0.0;
    for (const double estimate : field.estimates()) sum += (estimate - 1.0) * (estimate - 1.0);
    return sum / double(field.pixels());
}

double mean_area(SyntheticField& field) {
    double sum = 0.0;
    for (const gpu::PixelState& state : field.states()) sum += state.radius2 / field.first_radius2();
    return sum / double(field.pixels());
}

void print_errors(Device& device, std::uint32_t iterations, std::uint32_t side) {
    fmt::print(
        "Mean squared error, {} iterations, {} pixels (simulated without the renderer: 1,000 and 400); below it "
        "the mean of R^2 / R_1^2.\n\n| field |",
        iterations, side * side);
    for (const EstimatorRow& row : estimators()) fmt::print(" {} |", row.name);
    fmt::print("\n|---|");
    for (std::size_t i = 0; i < estimators().size(); ++i) fmt::print("---|");
    fmt::print("\n");
    for (const Field& field : fields()) {
        fmt::print("| {} |", field.name);
        std::string areas;
        for (const EstimatorRow& row : estimators()) {
            SyntheticField pixels = make_field(device, row.name, field, side);
            pixels.run(iterations);
            const auto known = simulated.find({field.name, row.name});
            fmt::print(" {:.1e}{} |", mean_squared_error(pixels),
                       known == simulated.end() ? "" : fmt::format(" ({:.1e})", known->second));
            std::fflush(stdout);
            areas += fmt::format(" {:.3f} |", mean_area(pixels));
        }
        fmt::print("\n| |{}\n", areas);
    }
}

void print_false_rejections(Device& device) {
    constexpr std::uint32_t side = 64;
    SyntheticField field = make_field(device, "cppm", find_field("uniform"), side);
    fmt::print(
        "\nFalse rejections of cppm on the uniform field, {} pixels.\n\n"
        "| iterations | at least one (simulated) | mean number | mean R^2 / R_1^2 |\n|---|---|---|---|\n",
        side * side);
    std::uint32_t done = 0;
    for (const auto& [iterations, share] : {std::pair{10u, 18}, {100u, 39}, {1000u, 55}}) {
        field.run(iterations - done);
        done = iterations;
        double number = 0.0;
        for (const gpu::PixelState& state : field.states()) number += double(state.rejections) / double(field.pixels());
        fmt::print("| {} | {:.1f} % ({} %) | {:.2f} | {:.3f} |\n", iterations, 100.0 * field.rejected(), share, number,
                   mean_area(field));
    }
}

void print_fields() {
    fmt::print("\n| field | lengths in R_1, ten photons in a first disc where f = 1 |\n|---|---|\n");
    for (const Field& field : fields()) fmt::print("| {} | {} |\n", field.name, field.formula);
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("The estimators on synthetic fields");
    std::uint32_t iterations = 1000, side = 20;
    app.add_option("--iterations", iterations)->check(CLI::Range(1, 100000));
    app.add_option("--side", side)->check(CLI::Range(1, 256));
    CLI11_PARSE(app, argc, argv);
    Device device(Device::Options{.select = "", .validate = false});
    print_errors(device, iterations, side);
    print_false_rejections(device);
    print_fields();
}
