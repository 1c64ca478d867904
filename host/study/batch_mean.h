#pragma once
// Mean and standard error of a picture from independent batches of it.

#include <cstddef>
#include <vector>

#include <glm/vec3.hpp>

#include "core/image.h"

namespace vkcppm {

class BatchMean {
public:
    explicit BatchMean(Extent extent);

    /// One more batch, of the same size of picture and as many samples as the others.
    void add(const std::vector<glm::dvec3>& batch);
    void add(const Image& batch);

    std::size_t batches() const { return count_; }

    /// [P] Mean of the batches; 0 without any.
    const std::vector<glm::dvec3>& mean() const { return mean_; }

    /// Squared standard error of the mean at a pixel; 0 with fewer than two batches.
    glm::dvec3 squared_error(std::size_t pixel) const;

private:
    std::size_t count_ = 0;
    std::vector<glm::dvec3> mean_;
    std::vector<glm::dvec3> squares_;  // sum of squared deviations from the mean (Welford 1962)
};

}  // namespace vkcppm
