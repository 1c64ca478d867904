#include "render/estimators.h"

#include <string>
#include <vector>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"

namespace vkcppm {

std::uint32_t cells_of_disc(const EstimatorRow& row, std::uint32_t rings, std::uint32_t sectors) {
    return rings * (row.folded ? sectors / 2 : sectors);
}

std::vector<float> chi_squared_thresholds(const EstimatorRow& row, std::uint32_t rings, std::uint32_t sectors,
                                          double significance) {
    std::vector<float> thresholds;
    if (row.statistic != Statistic::tally) return thresholds;
    for (std::uint32_t m = 1; m <= rings; ++m) {
        const boost::math::chi_squared distribution(double(cells_of_disc(row, m, sectors) - 1 - row.fitted));
        thresholds.push_back(float(quantile(complement(distribution, significance))));
    }
    return thresholds;
}

std::vector<float> f_thresholds(const EstimatorRow& row, std::uint32_t rings, std::uint32_t sectors,
                                double significance) {
    std::vector<float> thresholds;
    if (row.statistic != Statistic::contribution) return thresholds;
    for (std::uint32_t m = 1; m <= rings; ++m) {
        const double n = cells_of_disc(row, m, sectors);
        // Infinitely many samples: chi-squared over its degrees of freedom.
        const boost::math::chi_squared limit(n - 1.0);
        thresholds.push_back(float(quantile(complement(limit, significance)) / (n - 1.0)));
        for (int i = 1; i < F_QUANTILES; ++i) {
            const double samples_less_one = 2.0 * double(F_QUANTILES - 1) / double(i);
            const boost::math::fisher_f distribution(n - 1.0, n * samples_less_one);
            thresholds.push_back(float(quantile(complement(distribution, significance))));
        }
    }
    return thresholds;
}

namespace {

/// Rows of the tally and of the moments.
struct Kept {
    std::uint32_t tally = 0;
    std::uint32_t moments = 0;
};

Kept kept(const EstimatorRow& row, std::uint32_t rings, std::uint32_t sectors) {
    const std::uint32_t disc_cells = cells_of_disc(row, rings, sectors);
    Kept kept;
    // clang-format off
#define IN_TALLY(rows) kept.tally = rows;
#define IN_MOMENTS(rows) kept.moments = rows;
#define CASE(name) case Statistic::name: { KEEPS_##name(IN_TALLY, IN_MOMENTS, disc_cells, rings) break; }
    switch (row.statistic) { STATISTICS(CASE) }
#undef CASE
#undef IN_MOMENTS
#undef IN_TALLY
    // clang-format on
    return kept;
}

}  // namespace

std::uint32_t tally_rows(const EstimatorRow& row, std::uint32_t rings, std::uint32_t sectors) {
    return kept(row, rings, sectors).tally;
}

std::uint32_t moment_rows(const EstimatorRow& row, std::uint32_t rings, std::uint32_t sectors) {
    return kept(row, rings, sectors).moments;
}

const EstimatorRow& find_estimator(std::string_view name) {
    std::vector<std::string_view> names;
    for (const EstimatorRow& row : estimator_rows) {
        if (row.name == name) return row;
        names.push_back(row.name);
    }
    throw Error(ExitCode::usage, fmt::format("--estimator '{}' is none of {}", name, fmt::join(names, ", ")));
}

}  // namespace vkcppm
