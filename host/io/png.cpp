#include "io/png.h"

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <png.h>

#include "core/error.h"
#include "core/srgb.h"
#include "io/atomic_file.h"

namespace vkcppm {

void write_png(const std::filesystem::path& file, const Image& image, double exposure) {
    const double scale = std::exp2(exposure);
    std::vector<png_byte> encoded;  // [height x width x 3]
    encoded.reserve(image.rgb.size() * 3);
    for (const glm::vec3& pixel : image.rgb) {
        for (int c = 0; c < 3; ++c) {
            encoded.push_back(srgb_byte(scale * double(pixel[c])));
        }
    }

    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = image.extent.width;
    png.height = image.extent.height;
    png.format = PNG_FORMAT_RGB;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
    std::string bytes(size, '\0');
    if (!png_image_write_to_memory(&png, bytes.data(), &size, false, encoded.data(), 0, nullptr)) {
        throw Error(ExitCode::cannot_write, "cannot write " + file.string() + ": " + png.message);
    }
    bytes.resize(size);
    write_file(file, bytes);
}

}  // namespace vkcppm
