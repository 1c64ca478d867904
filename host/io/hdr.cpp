#include "io/hdr.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"

namespace vkcppm {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

/// Reads a picture from front to back.
class HdrReader {
public:
    HdrReader(std::span<const std::uint8_t> bytes, const std::filesystem::path& file)
        : rest_(bytes), file_(file.string()) {}

    Image read(std::size_t most_pixels) {
        const glm::dvec3 exposure = read_header();
        const auto [rows, columns] = read_size(most_pixels);
        Image image{{columns.length, rows.length}, {}};
        if (rows.name == 'X') std::swap(image.extent.width, image.extent.height);
        image.rgb.resize(image.extent.pixels());
        std::vector<Rgbe> row(columns.length);
        for (row_ = 0; row_ < rows.length; ++row_) {
            read_row(row);
            for (std::uint32_t i = 0; i < columns.length; ++i) {
                std::uint32_t x = columns.place(i), y = rows.place(row_);
                if (rows.name == 'X') std::swap(x, y);
                image.rgb[std::size_t(y) * image.extent.width + x] = radiance(row[i]) / exposure;
            }
        }
        return image;
    }

private:
    [[noreturn]] void fail(const std::string& reason) const {
        throw Error(ExitCode::bad_input, fmt::format("{}: cannot read this Radiance picture: {}", file_, reason));
    }

    [[noreturn]] void fail_in_row(const std::string& reason) const { fail(fmt::format("row {} {}", row_, reason)); }

    /// Up to the next line feed, which is taken as well.
    std::string take_line() {
        const auto end = std::find(rest_.begin(), rest_.end(), '\n');
        if (end == rest_.end()) fail("its header has no end");
        const std::string line(rest_.begin(), end);
        rest_ = {end + 1, rest_.end()};
        return line;
    }

    std::uint8_t take_byte() {
        if (rest_.empty()) fail_in_row("is cut short");
        const std::uint8_t byte = rest_.front();
        rest_ = rest_.subspan(1);
        return byte;
    }

    /// A piece of the header, short enough for a message.
    static std::string shown(std::string_view text) {
        constexpr std::size_t longest = 60;
        return std::string(text.substr(0, longest)) + (text.size() > longest ? "..." : "");
    }

    double take_factor(std::string_view& text) const {
        text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
        double factor = 0.0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), factor);
        if (error != std::errc() || !(factor > 0.0) || !std::isfinite(factor)) {
            fail(fmt::format("'{}' in its header is not a factor greater than 0", shown(text)));
        }
        text.remove_prefix(std::size_t(end - text.data()));
        return factor;
    }

    /// Everything before the size; returns what the pixels are to be divided by.
    glm::dvec3 read_header() {
        if (!take_line().starts_with("#?")) fail("it does not begin with #?");
        glm::dvec3 exposure(1.0);
        for (std::string line = take_line(); !line.empty() && line != "\r"; line = take_line()) {
            std::string_view text = line;
            const std::size_t equals = text.find('=');
            const std::string_view name = text.substr(0, equals);
            text.remove_prefix(equals == text.npos ? text.size() : equals + 1);
            if (name == "FORMAT" && !text.starts_with("32-bit_rle_rgbe")) {
                fail(fmt::format("its FORMAT is {}; this program reads 32-bit_rle_rgbe", shown(text)));
            } else if (name == "EXPOSURE") {
                exposure *= take_factor(text);
            } else if (name == "COLORCORR") {
                for (int c = 0; c < 3; ++c) exposure[c] *= take_factor(text);
            }
        }
        return exposure;
    }

    /// One of the two directions of the picture as they are stored.
    struct Axis {
        char name = 'X';        // or 'Y', which points upwards
        bool descends = false;  // from its highest pixel on: "-Y" begins at the top
        std::uint32_t length = 0;

        /// The column, or the row from the top, of the i-th pixel along it.
        std::uint32_t place(std::uint32_t i) const { return (name == 'Y') == descends ? i : length - 1 - i; }
    };

    /// Rows and columns as they are stored: "-Y <height> +X <width>", or any other of the eight orders.
    std::pair<Axis, Axis> read_size(std::size_t most_pixels) {
        const std::string line = take_line();
        const auto take_axis = [&](std::string_view& text, Axis& axis) {
            if (text.size() < 3 || (text[0] != '-' && text[0] != '+') || (text[1] != 'X' && text[1] != 'Y'))
                return false;
            axis.descends = text[0] == '-';
            axis.name = text[1];
            text.remove_prefix(std::min(text.find_first_not_of(' ', 2), text.size()));
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), axis.length);
            text.remove_prefix(std::size_t(end - text.data()));
            text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
            return error == std::errc() && axis.length > 0;
        };
        std::string_view text = line;
        Axis rows, columns;
        if (!take_axis(text, rows) || !take_axis(text, columns) || rows.name == columns.name ||
            !(text.empty() || text == "\r")) {
            fail(fmt::format("its size is '{}'; this program reads -Y HEIGHT +X WIDTH and its like", shown(line)));
        }
        const Extent size{columns.length, rows.length};
        if (size.pixels() > most_pixels) {
            fail(fmt::format("it is {}x{} pixels, more than {} in all; scale it down", size.width, size.height,
                             most_pixels));
        }
        return {rows, columns};
    }

    void read_row(std::vector<Rgbe>& row) {
        // Shorter and longer rows have no marker of the newer encoding: the bytes 2, 2 and the width are a pixel there.
        const bool can_be_new = row.size() >= 8 && row.size() < 32768 && rest_.size() >= 4;
        if (can_be_new && rest_[0] == 2 && rest_[1] == 2 && rest_[2] < 128) {
            const std::size_t width = rest_[2] * 256u + rest_[3];
            if (width != row.size()) {
                fail_in_row(fmt::format("has {} columns, the picture {}", width, row.size()));
            }
            rest_ = rest_.subspan(4);
            for (int channel = 0; channel < 4; ++channel) read_channel(row, channel);
        } else {
            read_pixels(row);
        }
    }

    /// The newer encoding: every channel by itself, runs of equal bytes or bytes as they are.
    void read_channel(std::vector<Rgbe>& row, int channel) {
        for (std::size_t x = 0; x < row.size();) {
            const std::uint8_t code = take_byte();
            const bool is_run = code > 128;
            const std::size_t count = is_run ? code - 128u : code;
            if (count == 0 || count > row.size() - x) {
                fail_in_row(fmt::format("has a run of {} at column {} of {}", count, x, row.size()));
            }
            std::uint8_t value = is_run ? take_byte() : 0;
            for (const std::size_t end = x + count; x < end; ++x) row[x][channel] = is_run ? value : take_byte();
        }
    }

    /// Flat, or the older encoding: the mantissas 1, 1, 1 repeat the pixel before as often as the exponent says, and
    /// such pixels in a row are the digits of one number to the base 256, the lowest first.
    void read_pixels(std::vector<Rgbe>& row) {
        int shift = 0;
        for (std::size_t x = 0; x < row.size();) {
            const Rgbe pixel{take_byte(), take_byte(), take_byte(), take_byte()};
            if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
                row[x++] = pixel;
                shift = 0;
                continue;
            }
            const std::size_t count = shift < 32 ? std::size_t(pixel[3]) << shift : row.size() + 1;
            if (x == 0 || count > row.size() - x) {
                fail_in_row(fmt::format("repeats a pixel {} times at column {} of {}", count, x, row.size()));
            }
            std::fill_n(row.begin() + std::ptrdiff_t(x), count, Rgbe(row[x - 1]));
            x += count;
            shift += 8;
        }
    }

    /// mantissa / 256 * 2^(exponent - 128). Radiance itself adds half a step to the mantissa; other readers do not, and
    /// without it 1 stays 1.
    static glm::dvec3 radiance(const Rgbe& pixel) {
        if (pixel[3] == 0) return glm::dvec3(0.0);
        return std::ldexp(1.0, pixel[3] - 136) * glm::dvec3(pixel[0], pixel[1], pixel[2]);
    }

    std::span<const std::uint8_t> rest_;
    std::string file_;
    std::uint32_t row_ = 0;
};

}  // namespace

Image decode_hdr(std::span<const std::uint8_t> bytes, const std::filesystem::path& file, std::size_t most_pixels) {
    return HdrReader(bytes, file).read(most_pixels);
}

}  // namespace vkcppm
