#include "app/display.h"

#include <cmath>

#include <fmt/format.h>

#include "app/console.h"

namespace vkcppm {
namespace {

constexpr double tolerable_share = 0.01;  // of clipped pixels: lamps and glints are to be white

}  // namespace

Display display_of(const DisplayOptions& options, const Image& image, const std::string& what, bool quiet) {
    if (options.exposure) return {options.tone_map, *options.exposure};
    const double exposure = std::round(100.0 * automatic_exposure(image)) / 100.0;
    if (!quiet) print_message(fmt::format("{}: --exposure {:g} by the median luminance", what, exposure));
    return {options.tone_map, exposure};
}

void warn_of_clipping(const std::filesystem::path& file, const Image& image, const Display& display) {
    const double share = clipped_share(image, display);
    if (share <= tolerable_share) return;
    print_message(fmt::format(
        "warning: {}: {:.1f} % of the pixels are clipped; with --exposure {:g} at most {:g} % were", file.string(),
        100.0 * share, exposure_without_clipping(image, display, tolerable_share), 100.0 * tolerable_share));
}

}  // namespace vkcppm
