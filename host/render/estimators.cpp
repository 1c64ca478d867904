#include "render/estimators.h"

#include <array>
#include <string>
#include <vector>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "shared/estimators.h"

namespace vkcppm {
namespace {

constexpr std::array rows = {
    EstimatorRow{"cppm", ESTIMATOR_CPPM, Statistic::tally, false, 0,
                 "chi-squared test of a uniform density (Lin et al. 2020)"},
    EstimatorRow{"sppm", ESTIMATOR_SPPM, Statistic::none, false, 0, "shared statistics (Hachisuka and Jensen 2009)"},
    EstimatorRow{"sppm-kz", ESTIMATOR_SPPM_KZ, Statistic::none, false, 0,
                 "one schedule for all pixels (Knaus and Zwicker 2011)"},
    EstimatorRow{"appm", ESTIMATOR_APPM, Statistic::derivative, false, 0,
                 "balance of variance and bias (Kaplanyan and Dachsbacher 2013)"},
    EstimatorRow{"cppm-lf", ESTIMATOR_CPPM_LF, Statistic::tally, false, 2,
                 "chi-squared test of a linear density (Lin et al. 2020, supplementary)"},
    EstimatorRow{"cppm-gof", ESTIMATOR_CPPM_GOF, Statistic::tally, false, 0,
                 "chi-squared test of a generalised odd density (the same)"},
    EstimatorRow{"cppm-fold", ESTIMATOR_CPPM_FOLD, Statistic::tally, true, 0,
                 "the hypothesis of cppm-gof by folding, without random flips"},
    EstimatorRow{"cppm-null", ESTIMATOR_CPPM_NULL, Statistic::none, false, 0,
                 "shrinks with every batch, without a test: the ablation"},
    EstimatorRow{"ftest", ESTIMATOR_FTEST, Statistic::contribution, false, 0,
                 "analysis of variance of contributions (after Lin et al. 2025)"},
    EstimatorRow{"ftest-fold", ESTIMATOR_FTEST_FOLD, Statistic::contribution, true, 0, "the same on folded sectors"},
};

}  // namespace

std::uint32_t cells(const EstimatorRow& row, std::uint32_t rings, std::uint32_t sectors) {
    return rings * (row.folded ? sectors / 2 : sectors);
}

std::vector<float> chi_squared_thresholds(const EstimatorRow& row, std::uint32_t rings, std::uint32_t sectors,
                                          double significance) {
    std::vector<float> thresholds;
    if (row.statistic != Statistic::tally) return thresholds;
    for (std::uint32_t m = 1; m <= rings; ++m) {
        const boost::math::chi_squared distribution(double(cells(row, m, sectors) - 1 - row.fitted));
        thresholds.push_back(float(quantile(complement(distribution, significance))));
    }
    return thresholds;
}

std::vector<float> f_thresholds(const EstimatorRow& row, std::uint32_t rings, std::uint32_t sectors,
                                double significance) {
    std::vector<float> thresholds;
    if (row.statistic != Statistic::contribution) return thresholds;
    for (std::uint32_t m = 1; m <= rings; ++m) {
        const double n = cells(row, m, sectors);
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

std::uint32_t tally_rows(const EstimatorRow& row, std::uint32_t rings, std::uint32_t sectors) {
    return row.statistic == Statistic::tally ? cells(row, rings, sectors) : 0;
}

std::uint32_t moment_rows(const EstimatorRow& row, std::uint32_t rings, std::uint32_t sectors) {
    switch (row.statistic) {
        case Statistic::derivative: return APPM_MOMENTS;
        case Statistic::contribution: return 3 * cells(row, rings, sectors) + 2 * rings;
        default: return 0;
    }
}

std::span<const EstimatorRow> estimators() { return rows; }

const EstimatorRow& find_estimator(std::string_view name) {
    std::vector<std::string_view> names;
    for (const EstimatorRow& row : rows) {
        if (row.name == name) return row;
        names.push_back(row.name);
    }
    throw Error(ExitCode::usage, fmt::format("--estimator '{}' is none of {}", name, fmt::join(names, ", ")));
}

}  // namespace vkcppm
