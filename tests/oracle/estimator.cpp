#include "oracle/estimator.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/quadrature/gauss.hpp>

namespace vkcppm::oracle {
namespace {

using std::numbers::pi;

double chi_squared_p_value(double statistic, double degrees_of_freedom) {
    return cdf(complement(boost::math::chi_squared(degrees_of_freedom), statistic));
}

/// The decision of Algorithm 1 (Lin et al. 2020) when `p_value(m)` tests the disc of the m innermost rings.
Decision decide(std::uint32_t rings, double total, double batch, const TestParameters& parameters,
                const std::function<double(std::uint32_t)>& p_value) {
    const auto passes = [&](std::uint32_t inner) { return p_value(inner) > parameters.significance; };
    if (total < batch || passes(rings)) {
        return {};
    }
    for (std::uint32_t inner = rings - 1; inner >= 1; --inner) {
        if (passes(inner)) {
            return {double(inner) / rings, true, parameters.beta};
        }
    }
    return {parameters.k, true, parameters.beta};
}

/// Integrals of x and y over each cell of the unit disc: how the probability of a cell grows with k1 and k2.
struct Moments {
    std::vector<double> x, y;
};

Moments integrate_moments(const Cells& cells) {
    using Rule = boost::math::quadrature::gauss<double, 20>;
    Moments moments;
    for (std::uint32_t ring = 0; ring < cells.rings; ++ring) {
        const double inner = std::sqrt(double(ring) / cells.rings), outer = std::sqrt((ring + 1.0) / cells.rings);
        for (std::uint32_t sector = 0; sector < cells.sectors; ++sector) {
            const double from = 2.0 * pi * sector / cells.sectors, to = 2.0 * pi * (sector + 1.0) / cells.sectors;
            const auto over_cell = [&](auto component) {
                return Rule::integrate(
                    [&](double angle) {
                        return Rule::integrate([&](double r) { return r * component(angle) * r; }, inner, outer);
                    },
                    from, to);
            };
            moments.x.push_back(over_cell([](double angle) { return std::cos(angle); }));
            moments.y.push_back(over_cell([](double angle) { return std::sin(angle); }));
        }
    }
    return moments;
}

/// The quadrature is done once a thread and shape: 10^5 states share a few shapes.
const Moments& cell_moments(const Cells& cells) {
    thread_local std::map<std::pair<std::uint32_t, std::uint32_t>, Moments> known;
    const auto [place, fresh] = known.try_emplace({cells.rings, cells.sectors});
    if (fresh) place->second = integrate_moments(cells);
    return place->second;
}

}  // namespace

SppmUpdate sppm_update(double count, double found, double alpha) {
    if (found == 0.0) {
        return {1.0, count};
    }
    return {(count + alpha * found) / (count + found), count + alpha * found};
}

double sppm_kz_area_factor(std::uint64_t iteration, double alpha) {
    assert(iteration >= 1);
    return (iteration + alpha) / (iteration + 1.0);
}

double constant_p_value(std::span<const std::uint32_t> tallies, const Cells& cells) {
    const auto disc = tallies.first(std::size_t(cells.rings) * cells.sectors);
    const double total = std::accumulate(disc.begin(), disc.end(), 0.0);
    if (total == 0.0) return 1.0;
    const double expected = total / disc.size();
    double statistic = 0.0;
    for (const double observed : disc) {
        statistic += (observed - expected) * (observed - expected) / expected;
    }
    return chi_squared_p_value(statistic, disc.size() - 1.0);
}

std::vector<double> linear_cell_probabilities(const Cells& cells, double k1, double k2) {
    const Moments& moments = cell_moments(cells);
    std::vector<double> probabilities;
    for (std::size_t i = 0; i < moments.x.size(); ++i) {
        probabilities.push_back(k1 * moments.x[i] + k2 * moments.y[i] + 1.0 / moments.x.size());
    }
    return probabilities;
}

double linear_p_value(std::span<const std::uint32_t> tallies, const Cells& cells) {
    const auto disc = tallies.first(std::size_t(cells.rings) * cells.sectors);
    const double total = std::accumulate(disc.begin(), disc.end(), 0.0);
    if (total == 0.0) return 1.0;
    // Least squares of O/S against p: the two regressors are orthogonal to each other and to the constant.
    const Moments& moments = cell_moments(cells);
    const auto slope = [&](const std::vector<double>& regressor) {
        return std::inner_product(disc.begin(), disc.end(), regressor.begin(), 0.0) /
               (total * std::inner_product(regressor.begin(), regressor.end(), regressor.begin(), 0.0));
    };
    double k1 = slope(moments.x), k2 = slope(moments.y);
    // A density of at least zero on the rim of the unit disc: |k| <= 1/pi (supplement, equations (12) to (15)).
    if (const double steepness = std::hypot(k1, k2) * pi; steepness > 1.0) {
        k1 /= steepness;
        k2 /= steepness;
    }
    double statistic = 0.0;
    const auto probabilities = linear_cell_probabilities(cells, k1, k2);
    for (std::size_t i = 0; i < disc.size(); ++i) {
        const double expected = total * std::max(probabilities[i], 1e-6 / disc.size());
        statistic += (disc[i] - expected) * (disc[i] - expected) / expected;
    }
    return chi_squared_p_value(statistic, disc.size() - 3.0);
}

std::vector<std::uint32_t> fold(std::span<const std::uint32_t> tallies, const Cells& cells) {
    assert(cells.sectors % 2 == 0 && tallies.size() == std::size_t(cells.rings) * cells.sectors);
    const std::uint32_t half = cells.sectors / 2;
    std::vector<std::uint32_t> folded(std::size_t(cells.rings) * half, 0);
    for (std::size_t i = 0; i < tallies.size(); ++i) {
        folded[i / cells.sectors * half + i % half] += tallies[i];
    }
    return folded;
}

Decision cppm_update(std::span<const std::uint32_t> tallies, const Cells& cells, double total, double batch,
                     const TestParameters& parameters) {
    return decide(cells.rings, total, batch, parameters, [&](std::uint32_t rings) {
        return constant_p_value(tallies, {rings, cells.sectors});
    });
}

Decision cppm_lf_update(std::span<const std::uint32_t> tallies, const Cells& cells, double total, double batch,
                        const TestParameters& parameters) {
    return decide(cells.rings, total, batch, parameters, [&](std::uint32_t rings) {
        return linear_p_value(tallies, {rings, cells.sectors});
    });
}

Decision cppm_fold_update(std::span<const std::uint32_t> tallies, const Cells& cells, double total, double batch,
                          const TestParameters& parameters) {
    return cppm_update(fold(tallies, cells), {cells.rings, cells.sectors / 2}, total, batch, parameters);
}

Decision cppm_null_update(double total, double batch, const TestParameters& parameters) {
    if (total < batch) {
        return {};
    }
    return {parameters.k, true, parameters.beta};
}

double f_test_p_value(const FTestState& state, const Cells& cells) {
    const std::span<const double> sums(state.sums.data(), std::size_t(cells.rings) * cells.sectors);
    const double samples = state.samples, groups = sums.size();
    if (samples < 3.0) return 1.0;
    const double mean = std::accumulate(sums.begin(), sums.end(), 0.0) / (samples * groups);
    double between = 0.0;
    double within = std::accumulate(state.squares.begin(), state.squares.begin() + cells.rings, 0.0);
    for (const double sum : sums) {
        between += samples * (sum / samples - mean) * (sum / samples - mean);
        within -= sum * sum / samples;
    }
    // Below the rounding of the sums themselves a difference is none.
    const double rounding = 1e-13 * std::accumulate(state.squares.begin(), state.squares.begin() + cells.rings, 0.0);
    if (between <= rounding) return 1.0;
    if (within <= rounding) return 0.0;
    const double within_freedom = groups * (samples - 1.0);
    const double statistic = (between / (groups - 1.0)) / (within / within_freedom);
    return cdf(complement(boost::math::fisher_f(groups - 1.0, within_freedom), statistic));
}

Decision f_test_update(const FTestState& state, const Cells& cells, double total, double batch,
                       const TestParameters& parameters) {
    return decide(cells.rings, total, batch, parameters, [&](std::uint32_t rings) {
        return f_test_p_value(state, {rings, cells.sectors});
    });
}

const Kernel box_kernel{[](double t) { return t < 1.0 ? 1.0 / pi : 0.0; }, 1.0 / 4.0, 1.0 / pi};
const Kernel cone_kernel{[](double t) { return t < 1.0 ? 3.0 / pi * (1.0 - t) : 0.0; }, 3.0 / 20.0, 3.0 / (2.0 * pi)};
const Kernel epanechnikov_kernel{[](double t) { return t < 1.0 ? 2.0 / pi * (1.0 - t * t) : 0.0; }, 1.0 / 6.0,
                                 4.0 / (3.0 * pi)};
const Kernel biweight_kernel{[](double t) { return t < 1.0 ? 3.0 / pi * std::pow(1.0 - t * t, 2) : 0.0; }, 1.0 / 8.0,
                             9.0 / (5.0 * pi)};
const Kernel smootherstep_kernel{
    [](double t) { return t < 1.0 ? 7.0 / (2.0 * pi) * (1.0 + t * t * t * (-10.0 + t * (15.0 - 6.0 * t))) : 0.0; },
    5.0 / 48.0, 287.0 / (132.0 * pi)};

double laplacian_stencil(double x, double y, double r) {
    const auto at = [&](double dx, double dy) {
        return smootherstep_kernel.value(std::hypot(x + dx, y + dy) / r) / (r * r);
    };
    return (at(r, 0.0) + at(-r, 0.0) + at(0.0, r) + at(0.0, -r) - 4.0 * at(0.0, 0.0)) / (r * r);
}

double appm_pilot_radius(double first_radius, std::uint64_t iteration, double c) {
    return c * first_radius * std::pow(double(iteration), -1.0 / 8.0);
}

double appm_optimal_radius(const Kernel& kernel, double second_moment, double laplacian, double paths) {
    return std::pow(2.0 * kernel.roughness * second_moment / (paths * std::pow(kernel.second_moment * laplacian, 2)),
                    1.0 / 6.0);
}

double appm_radius(const AppmState& state, const Kernel& kernel, double paths_per_iteration, double low, double high,
                   double least_laplacian_squared) {
    if (state.photons < 10.0) return state.first_radius;
    const double n = double(state.iterations);
    const double laplacian = std::sqrt(std::max(std::pow(state.sum_laplacian / n, 2), least_laplacian_squared));
    const double optimal = appm_optimal_radius(kernel, state.sum_second_moment / n, laplacian, n * paths_per_iteration);
    const double shrink = std::pow(n, -1.0 / 6.0);
    return std::clamp(optimal, low * state.first_radius * shrink, high * state.first_radius * shrink);
}

}  // namespace vkcppm::oracle
