#pragma once
// What a failed test leaves so that one can see why: pictures under the build folder.

#include <string>

#include "core/image.h"

namespace vkcppm::test {

/// Writes `got`, `wanted` and their absolute difference, each as .exr and .png, under failure_folder(), named after the
/// running test and `part` of it, and adds a failure that says where. For tests that have failed already.
void leave_pictures(const Image& got, const Image& wanted, const std::string& part = "");

/// Fails the test, with the pictures and the first pixel that differs, unless the two are equal to the bit.
void expect_same_picture(const Image& got, const Image& wanted, const std::string& part = "");

}  // namespace vkcppm::test
