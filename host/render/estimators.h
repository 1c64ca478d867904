#pragma once
// The family: one row an estimator. The kernels switch on `id` (a specialization constant), nothing else does.

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace vkcppm {

/// What an estimator keeps of a pixel besides PixelState, and how its test is calibrated.
enum class Statistic {
    none,          // a schedule: no test
    tally,         // photons a cell; chi-squared with cells - 1 - fitted degrees of freedom
    derivative,    // APPM_MOMENTS moments
    contribution,  // sums, means and squares of contributions a cell; F(cells - 1, cells (m - 1)) after m samples
};

struct EstimatorRow {
    std::string_view name;  // as --estimator takes it
    std::uint32_t id;       // ESTIMATOR_* of shaders/shared/estimators.h
    Statistic statistic;
    bool folded;               // opposite sectors are one cell
    std::uint32_t fitted;      // parameters of the density that are fitted before a chi-squared test
    std::string_view summary;  // one line for --help and the README
};

/// Cells of the disc of the first `rings` rings of n_s = `sectors` sectors.
std::uint32_t cells(const EstimatorRow& row, std::uint32_t rings, std::uint32_t sectors);

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

/// All estimators, the default one first.
std::span<const EstimatorRow> estimators();

/// The row of that name. Throws Error(usage) that lists the names.
const EstimatorRow& find_estimator(std::string_view name);

}  // namespace vkcppm
