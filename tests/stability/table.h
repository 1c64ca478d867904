#pragma once
// The table of stability cases, which the program prints when it ends: what was tried, how far it came from the easy
// version of the same thing, how far it may, and whether it did.

#include <string>

#include "core/image.h"

namespace vkcppm::test {

/// Adds a row and fails the running test where `error` is above `tolerance` or no number.
void expect_error(const std::string& name, double error, double tolerance);

/// The same of two pictures, which it leaves where they differ by more: sqrt(sum |got - easy|^2 / sum |easy|^2) over
/// pixels and channels; 1 where either is not finite. Asserts that sizes agree.
void expect_picture(const std::string& name, const Image& got, const Image& easy, double tolerance);

/// |mean(a) / mean(b) - 1| of all channels together.
double mean_difference(const Image& a, const Image& b);

/// Every value times `factor`.
Image scaled(Image image, double factor);

}  // namespace vkcppm::test
