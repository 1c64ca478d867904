#include "io/exr_header.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "core/error.h"

namespace vkcppm {
namespace {

// Pixels a byte of the file can stand for: Deflate makes at most 1032 bytes of one, and some of OpenEXR's encodings
// have less than a byte for a pixel before that. An even picture of 16384x8192 pixels takes 120 KB in its best.
constexpr std::uint64_t most_pixels_per_byte = 8192;
constexpr std::uint32_t magic = 20000630;
constexpr std::uint64_t offset_size = 8;                       // of a chunk, in the table behind the headers
constexpr std::uint64_t usual_chunk = std::uint64_t(1) << 26;  // bytes that a chunk may unpack to in any file
constexpr std::size_t longest_name = 255;

/// First and last column and row, both included.
struct Window {
    std::int32_t left, top, right, bottom;
    std::int64_t width() const { return std::int64_t(right) - left + 1; }
    std::int64_t height() const { return std::int64_t(bottom) - top + 1; }
};

struct HeaderPart {
    std::optional<Window> data;
    std::array<std::uint32_t, 2> tile{0, 0};  // width and height; 0: scan lines
    std::uint8_t compression = 0;
    std::uint64_t pixel_bytes = 0;  // of all channels
};

/// Rows that are compressed together.
std::uint64_t rows_a_chunk(std::uint8_t compression) {
    constexpr std::array<std::uint64_t, 10> rows = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};  // none, RLE, ZIPS, ... DWAB
    return compression < rows.size() ? rows[compression] : rows.back();
}

/// Reads the headers from front to back, as OpenEXR does ("OpenEXR File Layout": magic, version, then attributes as
/// name, type, size and data; an empty name ends a part, an empty part the headers of a file of several).
class HeaderReader {
public:
    HeaderReader(const std::filesystem::path& file, std::uint64_t most_pixels)
        : file_(file),
          in_(file, std::ios::binary),
          size_(std::filesystem::file_size(file)),
          most_pixels_(most_pixels) {}

    void check() {
        constexpr std::uint32_t several_parts = 0x1000;
        if (take<std::uint32_t>() != magic) fail("it does not begin as OpenEXR does");
        const auto version = take<std::uint32_t>();
        do {
            check_part();
        } while ((version & several_parts) && in_.peek() != '\0');
    }

private:
    [[noreturn]] void fail(const std::string& reason) const {
        throw Error(ExitCode::bad_input, file_.string() + ": cannot read this EXR picture: " + reason);
    }

    std::uint64_t left() { return size_ - std::min(size_, std::uint64_t(in_.tellg())); }

    template <typename T> T take() {
        T value;
        if (!in_.read(reinterpret_cast<char*>(&value), sizeof value)) fail("its header is cut short");
        return value;
    }

    /// Up to the next zero.
    std::string take_name() {
        std::string name;
        for (char c = take<char>(); c != '\0'; c = take<char>()) {
            if (name.size() == longest_name) {
                fail(fmt::format("a name in its header has more than {} bytes", longest_name));
            }
            name += c >= 0x20 && c < 0x7f ? c : '?';  // it goes into messages
        }
        return name;
    }

    void check_part() {
        HeaderPart part;
        for (std::string name = take_name(); !name.empty(); name = take_name()) {
            const std::string type = take_name();
            const auto size = take<std::int32_t>();
            if (size < 0 || std::uint64_t(size) > left()) {
                fail(fmt::format("attribute '{}' of its header has {} bytes, {} are left", name, size, left()));
            }
            const std::streamoff begin = in_.tellg();
            if (type == "box2i" && name == "dataWindow") {
                part.data = take<Window>();
                check_window("data window", *part.data);
            } else if (type == "box2i" && name == "displayWindow") {
                check_window("display window", take<Window>());
            } else if (type == "tiledesc") {
                part.tile = take<std::array<std::uint32_t, 2>>();
            } else if (type == "compression") {
                part.compression = take<std::uint8_t>();
            }
            in_.seekg(begin);
            if (!skip(type, size, part)) {
                fail(fmt::format("attribute '{}' of its header has {} bytes, which is no {}", name, size, type));
            }
            in_.seekg(begin + size);
        }
        // OpenEXR would take it to be some window, with chunks that nobody has looked at.
        if (!part.data) fail("its header has no data window");
        check_chunks(part);
    }

    /// False where a value of that type does not end after `size` bytes: OpenEXR would go on reading where it does.
    bool skip(const std::string& type, std::int32_t size, HeaderPart& part) {
        static const std::map<std::string, std::int32_t> sizes = {{"box2f", 16},
                                                                  {"box2i", 16},
                                                                  {"chromaticities", 32},
                                                                  {"compression", 1},
                                                                  {"deepImageState", 1},
                                                                  {"double", 8},
                                                                  {"envmap", 1},
                                                                  {"float", 4},
                                                                  {"int", 4},
                                                                  {"keycode", 28},
                                                                  {"lineOrder", 1},
                                                                  {"m33d", 72},
                                                                  {"m33f", 36},
                                                                  {"m44d", 128},
                                                                  {"m44f", 64},
                                                                  {"rational", 8},
                                                                  {"tiledesc", 9},
                                                                  {"timecode", 8},
                                                                  {"v2d", 16},
                                                                  {"v2f", 8},
                                                                  {"v2i", 8},
                                                                  {"v3d", 24},
                                                                  {"v3f", 12},
                                                                  {"v3i", 12}};
        if (const auto found = sizes.find(type); found != sizes.end()) return size == found->second;
        if (type == "chlist") return skip_channels(size, part);
        if (type == "floatvector") return size % 4 == 0;
        if (type == "preview") {
            const std::uint64_t width = take<std::uint32_t>(), height = take<std::uint32_t>();
            return width * height < most_pixels_ && 8 + 4 * width * height == std::uint64_t(size);
        }
        if (type == "stringvector") return skip_strings(size);
        // That is of deep pictures, and no end of sizes; a string ends, and so does what OpenEXR does not know.
        return type != "idmanifest";
    }

    bool skip_channels(std::int32_t size, HeaderPart& part) {
        constexpr std::streamoff rest = 12;  // of a channel: linearity, three bytes of nothing, sampling in x and y
        const std::streamoff end = std::streamoff(in_.tellg()) + size;
        while (!take_name().empty()) {
            part.pixel_bytes += take<std::int32_t>() == 1 ? 2 : 4;  // half, or float and integer
            in_.seekg(rest, std::ios::cur);
        }
        return in_.tellg() == end;
    }

    bool skip_strings(std::int32_t size) {
        while (size > 0) {
            const auto length = take<std::int32_t>();
            if (length < 0 || length > size - 4) return false;
            in_.seekg(length, std::ios::cur);
            size -= 4 + length;
        }
        return size == 0;
    }

    void check_window(const char* name, const Window& window) const {
        const std::int64_t width = window.width(), height = window.height();
        if (width <= 0 || height <= 0) fail(fmt::format("its {} is {}x{} pixels", name, width, height));
        const auto most = std::int64_t(std::min(most_pixels_, most_pixels_per_byte * size_));
        if (width > most || height > most || width * height > most) {
            fail(fmt::format("its {} is {}x{} pixels; the limit is {} in all, for its {} bytes", name, width, height,
                             most, size_));
        }
    }

    /// There is an offset in the file for every chunk, a tile or some rows, and OpenEXR has memory for one of them.
    void check_chunks(const HeaderPart& part) const {
        const auto width = std::uint64_t(part.data->width()), height = std::uint64_t(part.data->height());
        const bool is_tiled = part.tile[0] > 0 && part.tile[1] > 0;
        const std::uint64_t columns = is_tiled ? part.tile[0] : width;
        const std::uint64_t rows = is_tiled ? part.tile[1] : rows_a_chunk(part.compression);
        const std::uint64_t chunks = ((width + columns - 1) / columns) * ((height + rows - 1) / rows);
        if (chunks > size_ / offset_size) {
            fail(fmt::format("its {} chunks need more than its {} bytes for their offsets", chunks, size_));
        }
        const std::uint64_t most = usual_chunk + most_pixels_per_byte * size_;
        if (double(columns) * double(rows) * double(part.pixel_bytes) > double(most)) {
            fail(fmt::format("its chunks of {}x{} pixels, {} bytes each, are more than {} bytes", columns, rows,
                             part.pixel_bytes, most));
        }
    }

    std::filesystem::path file_;
    std::ifstream in_;
    std::uint64_t size_;
    std::uint64_t most_pixels_;
};

}  // namespace

void check_exr_header(const std::filesystem::path& file, std::uint64_t most_pixels) {
    HeaderReader(file, most_pixels).check();
}

}  // namespace vkcppm
