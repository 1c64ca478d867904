#include "study/batch_mean.h"

#include <cassert>

namespace vkcppm {

BatchMean::BatchMean(Extent extent) : mean_(extent.pixels(), glm::dvec3(0.0)), squares_(mean_) {}

void BatchMean::add(const std::vector<glm::dvec3>& batch) {
    assert(batch.size() == mean_.size());
    ++count_;
    for (std::size_t i = 0; i < mean_.size(); ++i) {
        const glm::dvec3 before = batch[i] - mean_[i];
        mean_[i] += before / double(count_);
        squares_[i] += before * (batch[i] - mean_[i]);
    }
}

void BatchMean::add(const Image& batch) { add(std::vector<glm::dvec3>(batch.rgb.begin(), batch.rgb.end())); }

glm::dvec3 BatchMean::squared_error(std::size_t pixel) const {
    if (count_ < 2) return glm::dvec3(0.0);
    return squares_[pixel] / (double(count_ - 1) * double(count_));
}

}  // namespace vkcppm
