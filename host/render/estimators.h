#pragma once
// The family: one row an estimator. The kernels switch on `id` (a specialization constant), nothing else does.

#include <cstdint>
#include <span>
#include <string_view>

namespace vkcppm {

struct EstimatorRow {
    std::string_view name;     // as --estimator takes it
    std::uint32_t id;          // ESTIMATOR_* of shaders/shared/estimators.h
    bool sectors;              // bins photons into rings and sectors and tests them
    std::string_view summary;  // one line for --help and the README
};

/// All estimators, the default one first.
std::span<const EstimatorRow> estimators();

/// The row of that name. Throws Error(usage) that lists the names.
const EstimatorRow& find_estimator(std::string_view name);

}  // namespace vkcppm
