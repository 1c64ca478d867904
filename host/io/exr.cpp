#include "io/exr.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>

#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "core/error.h"
#include "io/atomic_file.h"
#include "io/exr_header.h"
#include "core/input_file.h"

namespace vkcppm {
namespace fs = std::filesystem;
namespace {

// All work happens in the calling thread: a picture is small beside its render, and the bytes cannot depend on timing.
constexpr int no_worker_threads = 0;

bool is_beyond_halves(float value) { return std::isfinite(value) && std::abs(value) > HALF_MAX; }

Imath::half to_half(float value) {
    return is_beyond_halves(value) ? Imath::half(std::copysign(HALF_MAX, value)) : Imath::half(value);
}

[[noreturn]] void fail_to_read(const fs::path& file, const std::string& reason) {
    throw Error(ExitCode::bad_input, file.string() + ": cannot read this EXR picture: " + reason);
}

std::int64_t width(const Imath::Box2i& window) { return std::int64_t(window.max.x) - window.min.x + 1; }

std::int64_t height(const Imath::Box2i& window) { return std::int64_t(window.max.y) - window.min.y + 1; }

/// The channels that are red, green and blue: R, G and B, else those of the one layer that has them, or of the one
/// that is Combined, else Y for all.
std::array<std::string, 3> rgb_channels(const Imf::ChannelList& channels, const fs::path& file) {
    const auto of_layer = [](const std::string& prefix) {
        return std::array{prefix + "R", prefix + "G", prefix + "B"};
    };
    const auto has = [&](const std::array<std::string, 3>& names) {
        return std::ranges::all_of(names, [&](const std::string& name) { return channels.findChannel(name); });
    };
    if (has(of_layer(""))) return of_layer("");
    std::vector<std::string> layers;
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
        const std::string name = channel.name();
        if (!name.ends_with(".R")) continue;
        const std::string prefix = name.substr(0, name.size() - 1);
        if (has(of_layer(prefix))) layers.push_back(prefix);
    }
    // Of Blender's layers of passes the picture is that of this name.
    const auto is_picture = [](const std::string& layer) { return ("." + layer).ends_with(".Combined."); };
    if (std::ranges::count_if(layers, is_picture) == 1) layers = {*std::ranges::find_if(layers, is_picture)};
    if (layers.size() == 1) return of_layer(layers.front());
    if (layers.size() > 1) {
        fail_to_read(file, fmt::format("it has {} layers of R, G and B ('{}', '{}', ...), one is read", layers.size(),
                                       layers[0], layers[1]));
    }
    // Beside RY and BY, chroma, Y alone would show a colour picture in grey.
    if (channels.findChannel("Y") && !channels.findChannel("RY") && !channels.findChannel("R")) return {"Y", "Y", "Y"};
    for (const char* name : {"R", "G", "B"}) {
        if (channels.findChannel(name)) continue;
        const std::string one = channels.begin() == channels.end() ? "" : channels.begin().name();
        fail_to_read(file, fmt::format("it has no channel {} in its first part, but '{}'", name, one.substr(0, 40)));
    }
    return {"R", "G", "B"};
}

Extent extent_of(const Imath::Box2i& window) { return {std::uint32_t(width(window)), std::uint32_t(height(window))}; }

/// The pixels of the data window within the display window; zeros where there are none.
template <typename Pixel>
std::vector<Pixel> in_window(const std::vector<Pixel>& pixels, const Imath::Box2i& data, const Imath::Box2i& display) {
    std::vector<Pixel> shown(extent_of(display).pixels(), Pixel(0.0f));
    const int left = std::max(data.min.x, display.min.x);
    const int right = std::min(data.max.x, display.max.x);
    for (int y = std::max(data.min.y, display.min.y); y <= std::min(data.max.y, display.max.y) && left <= right; ++y) {
        const auto from = pixels.begin() + (y - data.min.y) * width(data) + (left - data.min.x);
        std::copy(from, from + (right - left + 1),
                  shown.begin() + (y - display.min.y) * width(display) + (left - display.min.x));
    }
    return shown;
}

ExrChannels read_channels(const fs::path& file, std::string_view prefix) {
    Imf::InputFile input(file.c_str(), no_worker_threads);
    const Imath::Box2i data = input.header().dataWindow();
    const Imath::Box2i display = input.header().displayWindow();
    ExrChannels channels{extent_of(display), {}};
    Imf::FrameBuffer frame;
    const Imf::ChannelList& list = input.header().channels();
    for (auto it = list.begin(); it != list.end(); ++it) {
        if (!std::string_view(it.name()).starts_with(prefix)) continue;
        std::vector<float>& values = channels.values[it.name()];
        values.resize(std::size_t(width(data) * height(data)));
        frame.insert(it.name(), Imf::Slice::Make(Imf::FLOAT, values.data(), data, sizeof(float),
                                                 sizeof(float) * std::size_t(width(data))));
    }
    if (channels.values.empty()) return channels;
    input.setFrameBuffer(frame);
    input.readPixels(data.min.y, data.max.y);
    for (auto& [name, values] : channels.values) values = in_window(values, data, display);
    return channels;
}

glm::dmat3 rgb_to_xyz(const Imf::Chromaticities& primaries) {
    glm::dmat3 columns;
    const auto xyz = [](const Imath::V2f& at) { return glm::dvec3(at.x, at.y, 1.0 - at.x - at.y) / double(at.y); };
    columns[0] = xyz(primaries.red);
    columns[1] = xyz(primaries.green);
    columns[2] = xyz(primaries.blue);
    const glm::dvec3 scale = glm::inverse(columns) * xyz(primaries.white);
    return {columns[0] * scale.r, columns[1] * scale.g, columns[2] * scale.b};
}

/// To linear Rec. 709 from such primaries, white to white by Bradford's cones, as OpenEXR does for ACES (ImfAcesFile).
glm::dmat3 to_rec709(const Imf::Chromaticities& primaries) {
    const glm::dmat3 cones =
        glm::transpose(glm::dmat3(0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296));
    const glm::dmat3 from = rgb_to_xyz(primaries), to = rgb_to_xyz(Imf::Chromaticities());
    const glm::dvec3 white(1.0);
    const glm::dvec3 ratio = (cones * (to * white)) / (cones * (from * white));
    const glm::dmat3 adapted = glm::inverse(cones) * glm::dmat3(ratio.r, 0, 0, 0, ratio.g, 0, 0, 0, ratio.b) * cones;
    return glm::inverse(to) * adapted * from;
}

bool is_rec709(const Imf::Chromaticities& primaries) {
    constexpr float rounding = 2e-3f;  // files state them to three places or so
    const Imf::Chromaticities own;
    const auto is_near = [](const Imath::V2f& a, const Imath::V2f& b) { return a.equalWithAbsError(b, rounding); };
    return is_near(primaries.red, own.red) && is_near(primaries.green, own.green) &&
           is_near(primaries.blue, own.blue) && is_near(primaries.white, own.white);
}

/// Brings what the file states in other primaries to those of Rec. 709.
void convert(std::vector<glm::vec3>& pixels, const Imf::Header& header, const fs::path& file) {
    if (!Imf::hasChromaticities(header) || is_rec709(Imf::chromaticities(header))) return;
    const glm::dmat3 matrix = to_rec709(Imf::chromaticities(header));
    if (!is_finite(glm::vec3(matrix * glm::dvec3(1.0))))
        fail_to_read(file, "its chromaticities are none of a colour space");
    for (glm::vec3& pixel : pixels) {
        if (is_finite(pixel)) pixel = glm::vec3(matrix * glm::dvec3(pixel));
    }
}

Image read_rgb(const fs::path& file) {
    Imf::InputFile input(file.c_str(), no_worker_threads);
    const Imath::Box2i data = input.header().dataWindow();
    const Imath::Box2i display = input.header().displayWindow();
    const std::array<std::string, 3> names = rgb_channels(input.header().channels(), file);
    std::vector<glm::vec3> pixels(std::size_t(width(data) * height(data)));
    const std::size_t pixel_stride = sizeof(glm::vec3);
    const std::size_t row_stride = pixel_stride * std::size_t(width(data));
    Imf::FrameBuffer frame;
    const bool is_grey = names[0] == names[1];
    for (int c = 0; c < (is_grey ? 1 : 3); ++c) {
        frame.insert(names[c], Imf::Slice::Make(Imf::FLOAT, &pixels[0][c], data, pixel_stride, row_stride));
    }
    input.setFrameBuffer(frame);
    input.readPixels(data.min.y, data.max.y);
    if (is_grey) {
        for (glm::vec3& pixel : pixels) pixel = glm::vec3(pixel.r);
    } else {
        convert(pixels, input.header(), file);
    }

    Image image{extent_of(display), in_window(pixels, data, display)};
    return image;
}

ExrAttributes read_attributes(const fs::path& file) {
    ExrAttributes attributes;
    Imf::InputFile input(file.c_str(), no_worker_threads);
    for (auto it = input.header().begin(); it != input.header().end(); ++it) {
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute())) {
            attributes.emplace_back(it.name(), text->value());
        }
    }
    return attributes;
}

/// What `read` gives of a file whose header holds; what OpenEXR throws as an Error.
auto checked(const fs::path& file, std::uint64_t most_pixels, const auto& read) {
    require_file(file);
    check_exr_header(file, most_pixels);
    try {
        return read();
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        fail_to_read(file, error.what());
    }
}

}  // namespace

ExrChannels to_channels(const Image& image) {
    ExrChannels channels;
    channels.extent = image.extent;
    for (int c = 0; const char* name : {"R", "G", "B"}) {
        std::vector<float>& values = channels.values[name];
        values.reserve(image.rgb.size());
        for (const glm::vec3& pixel : image.rgb) values.push_back(pixel[c]);
        ++c;
    }
    return channels;
}

std::size_t beyond_halves(const ExrChannels& channels) {
    std::ptrdiff_t count = 0;
    for (const auto& [name, values] : channels.values) count += std::ranges::count_if(values, is_beyond_halves);
    return std::size_t(count);
}

void write_exr(const fs::path& file, const ExrChannels& channels, const ExrAttributes& attributes, ExrDepth depth) {
    const auto [columns, rows] = channels.extent;
    // In memory first: OpenEXR's own file stream does not notice when the last bytes fail to reach the disk.
    Imf::StdOSStream stream;
    try {
        Imf::Header header{int(columns), int(rows)};
        header.compression() = Imf::ZIP_COMPRESSION;
        Imf::addChromaticities(header, Imf::Chromaticities());  // the default is Rec. 709
        for (const auto& [name, text] : attributes) header.insert(name, Imf::StringAttribute(text));
        Imf::FrameBuffer frame;
        std::vector<std::vector<Imath::half>> halves;  // as they are written
        for (const auto& [name, values] : channels.values) {
            assert(values.size() == channels.extent.pixels());
            if (depth == ExrDepth::half) {
                std::ranges::transform(values, std::back_inserter(halves.emplace_back()), to_half);
            }
            const Imf::PixelType type = depth == ExrDepth::half ? Imf::HALF : Imf::FLOAT;
            const std::size_t stride = depth == ExrDepth::half ? sizeof(Imath::half) : sizeof(float);
            const void* data = depth == ExrDepth::half ? static_cast<const void*>(halves.back().data()) : values.data();
            header.channels().insert(name, Imf::Channel(type));
            frame.insert(name, Imf::Slice::Make(type, data, header.dataWindow(), stride, stride * columns));
        }
        Imf::OutputFile output(stream, header, no_worker_threads);
        output.setFrameBuffer(frame);
        output.writePixels(int(rows));
    } catch (const std::exception& error) {
        throw Error(ExitCode::cannot_write, "cannot write " + file.string() + ": " + error.what());
    }
    write_file(file, stream.str());
}

void write_exr(const fs::path& file, const Image& image, const ExrAttributes& attributes) {
    write_exr(file, to_channels(image), attributes);
}

Image read_exr(const fs::path& file, std::uint64_t most_pixels) {
    return checked(file, most_pixels, [&] { return read_rgb(file); });
}

ExrChannels read_exr_channels(const fs::path& file, std::string_view prefix) {
    return checked(file, most_exr_pixels, [&] { return read_channels(file, prefix); });
}

ExrAttributes read_exr_attributes(const fs::path& file) {
    return checked(file, most_exr_pixels, [&] { return read_attributes(file); });
}

}  // namespace vkcppm
