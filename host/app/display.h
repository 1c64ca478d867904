#pragma once
// Exposure and curve of a command's pictures.

#include <filesystem>
#include <string>

#include "app/options.h"
#include "core/display.h"
#include "core/image.h"

namespace vkcppm {

/// What was asked for; an automatic exposure is that of `image`, to a hundredth of a stop, and is told in a line that
/// begins with `what` unless `quiet`.
Display display_of(const DisplayOptions& options, const Image& image, const std::string& what, bool quiet);

/// Warns where more than 1 % of the pixels of `image` are clipped in `file`, and names the exposure that clips fewer.
void warn_of_clipping(const std::filesystem::path& file, const Image& image, const Display& display);

}  // namespace vkcppm
