#pragma once
// OpenEXR files: float channels with text attributes.

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/image.h"

namespace vkcppm {

/// Float channels of one size by name; each [height x width], row-major, first row on top.
struct ExrChannels {
    Extent extent;
    std::map<std::string, std::vector<float>> values;
};

/// Name and text, in any order: the file sorts them.
using ExrAttributes = std::vector<std::pair<std::string, std::string>>;

/// The channels R, G and B of `image`.
ExrChannels to_channels(const Image& image);

/// How a number is stored: as it is, or rounded to the nearest half float, 11 bits of at most 65,504, which a number
/// beyond becomes, while what is infinite stays so.
enum class ExrDepth { full, half };

/// How many numbers are beyond the half floats.
std::size_t beyond_halves(const ExrChannels& channels);

/// Writes scan lines with ZIP compression and the chromaticities of Rec. 709. The same arguments give the same bytes.
/// The file is written whole or not at all (write_file). Throws Error(cannot_write).
void write_exr(const std::filesystem::path& file, const ExrChannels& channels, const ExrAttributes& attributes = {},
               ExrDepth depth = ExrDepth::full);
void write_exr(const std::filesystem::path& file, const Image& image, const ExrAttributes& attributes = {});

/// Pixels a picture may have; its three floats a pixel take 1.5 GiB then.
inline constexpr std::uint64_t most_exr_pixels = std::uint64_t(1) << 27;

/// Reads R, G and B, float or half, scan lines or tiles; without them those of the one layer that has some, or of
/// Blender's picture (ViewLayer.Combined.R), or Y for grey. Where the file states other primaries than Rec. 709 has, it
/// is converted to these. The picture is the display window; what the data window does not cover is black. Throws
/// Error: no_input where the file is missing, bad_input where it is not such a picture or has more than `most_pixels`
/// pixels.
Image read_exr(const std::filesystem::path& file, std::uint64_t most_pixels = most_exr_pixels);

/// The channels whose names begin with `prefix`, windows as in read_exr; none where there are none. Throws like
/// read_exr.
ExrChannels read_exr_channels(const std::filesystem::path& file, std::string_view prefix);

/// The text attributes of a file, sorted by name. Throws like read_exr.
ExrAttributes read_exr_attributes(const std::filesystem::path& file);

}  // namespace vkcppm
