#include "app/reference.h"

#include <cmath>
#include <cstddef>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"
#include "io/exr.h"

namespace vkcppm {

Image read_reference(const std::filesystem::path& file, const Extent& size) {
    Image image = read_exr(file);
    if (image.extent != size) {
        throw Error(ExitCode::usage, fmt::format("--reference: {} is {}x{} pixels, the render {}x{}", file.string(),
                                                 image.extent.width, image.extent.height, size.width, size.height));
    }
    std::size_t bad = 0;
    std::optional<std::size_t> first;
    for (std::size_t i = 0; i < image.rgb.size(); ++i) {
        const glm::vec3& pixel = image.rgb[i];
        if (std::isfinite(pixel.r) && std::isfinite(pixel.g) && std::isfinite(pixel.b)) continue;
        if (!first) first = i;
        ++bad;
    }
    if (first) {
        throw Error(ExitCode::bad_input,
                    fmt::format("--reference: {} of {} pixels of {} are NaN or infinite, the first in column {}, "
                                "row {}",
                                bad, image.rgb.size(), file.string(), *first % size.width, *first / size.width));
    }
    return image;
}

}  // namespace vkcppm
