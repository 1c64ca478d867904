#pragma once
// What the header of an OpenEXR file claims, before OpenEXR believes it.

#include <cstdint>
#include <filesystem>

namespace vkcppm {

/// Checks the sizes in the headers of all parts, which OpenEXR 3.1 takes memory for before it finds that the file is
/// short: attributes must end within the file, windows have at most `most_pixels` pixels and no more than a file of its
/// size can hold, tiles no more than there is room for in its table of offsets.
/// Throws Error(bad_input) with the file, the object, its value and the limit.
void check_exr_header(const std::filesystem::path& file, std::uint64_t most_pixels);

}  // namespace vkcppm
