#pragma once
// The picture that a render is measured against.

#include <filesystem>

#include "core/image.h"

namespace vkcppm {

/// Reads it for pictures of `size`. Throws like read_exr; Error(usage) where its size is another, Error(bad_input)
/// where a pixel is NaN or infinite, with their number and the first of them.
Image read_reference(const std::filesystem::path& file, const Extent& size);

}  // namespace vkcppm
