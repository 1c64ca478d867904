#pragma once
// The family of estimators: the rows of shaders/shared/estimators.h, and how their tests are calibrated.

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "shared/estimators.h"

namespace vkcppm {

/// What an estimator keeps of a pixel besides PixelState, and how its radii go on after a pilot.
// clang-format off
#define ENUMERATOR(name) name,
enum class Statistic { STATISTICS(ENUMERATOR) };
enum class Later { LATER(ENUMERATOR) };
#undef ENUMERATOR
// clang-format on

struct EstimatorRow {
    std::string_view name;  // as --estimator takes it
    Statistic statistic;
    bool folded;               // opposite sectors are one cell
    std::uint32_t fitted;      // parameters of the density that are fitted before a chi-squared test
    Later later;               // how radii go on after a pilot
    std::string_view summary;  // one line for --help and the README
};

/// All of them, the default one first.
// clang-format off
#define ESTIMATOR_ROW(name, statistic, folded, fitted, later, summary) \
    EstimatorRow{name, Statistic::statistic, folded, fitted, Later::later, summary},
inline constexpr std::array estimator_rows = {ESTIMATORS(ESTIMATOR_ROW)};
#undef ESTIMATOR_ROW
// clang-format on

/// Cells of the disc of the first `rings` rings of n_s = `sectors` sectors.
std::uint32_t cells_of_disc(const EstimatorRow& row, std::uint32_t rings, std::uint32_t sectors);

/// Thresholds of the test by Boost's quantiles: [rings] for chi-squared, empty for others.
std::vector<float> chi_squared_thresholds(const EstimatorRow& row, std::uint32_t rings, std::uint32_t sectors,
                                          double significance);

/// [rings x F_QUANTILES] thresholds of the F-test, uniform in 1 / (m - 1) over [0, 1/2] for m samples; empty for
/// others.
std::vector<float> f_thresholds(const EstimatorRow& row, std::uint32_t rings, std::uint32_t sectors,
                                double significance);

/// Counters a pixel in the tally, and floats a pixel in the moments.
std::uint32_t tally_rows(const EstimatorRow& row, std::uint32_t rings, std::uint32_t sectors);
std::uint32_t moment_rows(const EstimatorRow& row, std::uint32_t rings, std::uint32_t sectors);

inline std::span<const EstimatorRow> estimators() { return estimator_rows; }

/// The row of that name. Throws Error(usage) that lists the names.
const EstimatorRow& find_estimator(std::string_view name);

}  // namespace vkcppm
