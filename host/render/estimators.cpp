#include "render/estimators.h"

#include <array>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "shared/estimators.h"

namespace vkcppm {
namespace {

constexpr std::array rows = {
    EstimatorRow{"cppm", ESTIMATOR_CPPM, true, "chi-squared test of a uniform photon density (Lin et al. 2020)"},
    EstimatorRow{"sppm", ESTIMATOR_SPPM, false, "shared statistics (Hachisuka and Jensen 2009)"},
    EstimatorRow{"sppm-kz", ESTIMATOR_SPPM_KZ, false, "one schedule for all pixels (Knaus and Zwicker 2011)"},
};

}  // namespace

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
