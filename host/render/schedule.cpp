#include "render/schedule.h"

#include <cmath>

#include "render/estimators.h"

namespace vkcppm {

double shrink_exponent(const Settings& settings) {
    switch (find_estimator(settings.estimator).later) {
        case Later::alpha: return 1.0 - settings.alpha;
        // A batch of B beta^j photons takes B beta^j / k^j iterations, after which the area has shrunk by k^j.
        case Later::batches: return std::log(1.0 / settings.k) / std::log(settings.beta / settings.k);
        case Later::third: break;
    }
    return 1.0 / 3.0;
}

double mean_shrink(double exponent, std::uint32_t pilot, std::uint32_t first, std::uint32_t count) {
    const double from = double(first) / pilot, to = (double(first) + count) / pilot, rest = 1.0 - exponent;
    if (rest <= 0.0) return std::log(to / from) / (to - from);
    return (std::pow(to, rest) - std::pow(from, rest)) / (rest * (to - from));
}

}  // namespace vkcppm
