#pragma once
// The table of stability cases, which the program prints when it ends: what was tried, how far it came from the easy
// version of the same thing, how far it may, and whether it did.

#include <string>

#include "core/image.h"

namespace vkcppm::test {

/// Adds a row and fails the running test where `error` is above `tolerance` or no number.
void expect_error(const std::string& name, double error, double tolerance);

/// sqrt(sum |a - b|^2 / sum |b|^2) over pixels and channels; 1 where either is not finite. Asserts that sizes agree.
double difference(const Image& a, const Image& b);

/// |mean(a) / mean(b) - 1| of all channels together.
double mean_difference(const Image& a, const Image& b);

/// Every value times `factor`.
Image scaled(Image image, double factor);

}  // namespace vkcppm::test
