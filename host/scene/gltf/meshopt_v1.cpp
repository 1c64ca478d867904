#include "scene/gltf/meshopt_v1.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <vector>

namespace vkcppm {

namespace {

constexpr std::uint8_t version_1 = 0xa1;
constexpr std::size_t group_size = 16;          // elements whose deltas are stored alike
constexpr std::size_t most_block_bytes = 8192;  // of decoded elements
constexpr std::size_t most_block_elements = 256;
constexpr std::size_t least_tail = 24;  // bytes

/// Reads a stream from front to back.
class Stream {
public:
    explicit Stream(std::span<const std::uint8_t> rest) : rest_(rest) {}

    /// The next `count` bytes; none where there are fewer, and from then on.
    std::span<const std::uint8_t> take(std::size_t count) {
        if (count > rest_.size()) {
            is_short_ = true;
            return {};
        }
        const auto taken = rest_.first(count);
        rest_ = rest_.subspan(count);
        return taken;
    }

    bool is_short() const { return is_short_; }
    bool is_empty() const { return rest_.empty(); }

private:
    std::span<const std::uint8_t> rest_;
    bool is_short_ = false;
};

using Group = std::array<std::uint8_t, group_size>;

/// 16 deltas of so many bits: 0, 1, 2, 4 or 8. Of fewer than 8 all ones stand for a byte that comes after the group.
bool read_group(Stream& stream, unsigned bits, Group& deltas) {
    deltas.fill(0);
    if (bits == 0) return true;
    const auto packed = stream.take(group_size * bits / 8);
    if (packed.empty()) return false;
    if (bits == 8) {
        std::ranges::copy(packed, deltas.begin());
        return true;
    }
    const unsigned escape = (1u << bits) - 1;
    for (std::size_t i = 0; i < group_size; ++i) {
        const unsigned at = unsigned(i) * bits % 8;
        // From the highest bit downwards, but single bits from the lowest upwards.
        const unsigned shift = bits == 1 ? at : 8 - bits - at;
        const unsigned value = packed[i * bits / 8] >> shift & escape;
        if (value == escape) {
            const auto whole = stream.take(1);
            if (whole.empty()) return false;
            deltas[i] = whole[0];
        } else {
            deltas[i] = std::uint8_t(value);
        }
    }
    return true;
}

/// The deltas of one byte of `count` elements, as its control mode says.
bool read_deltas(Stream& stream, unsigned mode, std::size_t count, std::span<std::uint8_t> deltas) {
    if (mode == 2) {
        std::ranges::fill(deltas, 0);
        return true;
    }
    if (mode == 3) {
        const auto plain = stream.take(count);
        std::ranges::copy(plain, deltas.begin());
        return plain.size() == count;
    }
    static constexpr unsigned widths[2][4] = {{0, 1, 2, 4}, {1, 2, 4, 8}};
    const std::size_t groups = (count + group_size - 1) / group_size;
    const auto header = stream.take((groups + 3) / 4);
    if (header.empty()) return false;
    for (std::size_t g = 0; g < groups; ++g) {
        Group group;
        if (!read_group(stream, widths[mode][header[g / 4] >> g % 4 * 2 & 3], group)) return false;
        const std::size_t first = g * group_size;
        std::copy_n(group.begin(), std::min(group_size, count - first), deltas.begin() + std::ptrdiff_t(first));
    }
    return true;
}

template <typename Word> Word unzigzag(Word v) { return Word((v & 1) != 0 ? ~(v >> 1) : v >> 1); }

/// What follows `before`, four bytes, by the deltas of a channel of that mode.
std::uint32_t follow(std::uint8_t mode, std::uint32_t before, std::uint32_t delta) {
    if ((mode & 15) == 2) return before ^ std::rotl(delta, mode >> 4);
    const unsigned width = mode == 0 ? 8 : 16;
    const std::uint32_t mask = (1u << width) - 1;
    std::uint32_t after = 0;
    for (unsigned at = 0; at < 32; at += width) {
        const std::uint32_t v = delta >> at & mask;
        const std::uint32_t step = mode == 0 ? unzigzag(std::uint8_t(v)) : unzigzag(std::uint16_t(v));
        after |= (((before >> at) + step) & mask) << at;
    }
    return after;
}

std::uint32_t read_word(const std::uint8_t* bytes) {
    return bytes[0] | std::uint32_t(bytes[1]) << 8 | std::uint32_t(bytes[2]) << 16 | std::uint32_t(bytes[3]) << 24;
}

template <typename Component> void decode_colors(std::span<std::uint8_t> elements) {
    using Signed = std::make_signed_t<Component>;
    for (std::size_t i = 0; i + 4 * sizeof(Component) <= elements.size(); i += 4 * sizeof(Component)) {
        std::array<Component, 4> in;
        std::memcpy(in.data(), &elements[i], sizeof in);
        // The highest bit of alpha tells how many bits each component has.
        const int most = (1 << std::bit_width(in[3])) - 1;
        const int y = in[0], co = Signed(in[1]), cg = Signed(in[2]);
        const int a = in[3] & most >> 1;
        const double scale = most > 0 ? double(std::numeric_limits<Component>::max()) / most : 0.0;
        const auto encoded = [&](int v) {
            return Component(std::lround(std::clamp(v * scale, 0.0, double(std::numeric_limits<Component>::max()))));
        };
        const std::array<Component, 4> out = {encoded(y + co - cg), encoded(y + cg), encoded(y - co - cg),
                                              encoded(a << 1 | (a & 1))};
        std::memcpy(&elements[i], out.data(), sizeof out);
    }
}

}  // namespace

bool is_meshopt_v1(std::span<const std::uint8_t> encoded) { return !encoded.empty() && encoded[0] == version_1; }

bool decode_meshopt_v1(std::span<const std::uint8_t> encoded, std::size_t stride, std::span<std::uint8_t> elements) {
    const std::size_t count = elements.size() / stride, channels = stride / 4;
    const std::size_t tail = std::max(stride + channels, least_tail);
    if (!is_meshopt_v1(encoded) || encoded.size() < 1 + tail) return false;
    const std::span<const std::uint8_t> modes = encoded.last(channels);
    std::vector<std::uint8_t> before(stride);  // the element before the next
    std::ranges::copy(encoded.last(stride + channels).first(stride), before.begin());
    for (const std::uint8_t mode : modes) {
        if ((mode & 15) > 2 || ((mode & 15) < 2 && mode > 15)) return false;
    }
    Stream stream(encoded.subspan(1, encoded.size() - 1 - tail));
    const std::size_t most = std::min(most_block_bytes / stride & ~(group_size - 1), most_block_elements);
    std::array<std::array<std::uint8_t, most_block_elements>, 4> deltas;
    for (std::size_t first = 0; first < count; first += most) {
        const std::size_t block = std::min(most, count - first);
        const auto control = stream.take(channels);
        if (control.empty()) return false;
        for (std::size_t channel = 0; channel < channels; ++channel) {
            for (std::size_t b = 0; b < 4; ++b) {
                const auto bytes = std::span(deltas[b]).first(block);
                if (!read_deltas(stream, control[channel] >> 2 * b & 3, block, bytes)) return false;
            }
            std::uint32_t word = read_word(&before[4 * channel]);
            for (std::size_t i = 0; i < block; ++i) {
                const std::array<std::uint8_t, 4> delta = {deltas[0][i], deltas[1][i], deltas[2][i], deltas[3][i]};
                word = follow(modes[channel], word, read_word(delta.data()));
                for (std::size_t b = 0; b < 4; ++b) {
                    elements[(first + i) * stride + 4 * channel + b] = std::uint8_t(word >> 8 * b);
                }
            }
        }
        std::copy_n(elements.begin() + std::ptrdiff_t((first + block - 1) * stride), stride, before.begin());
    }
    return !stream.is_short() && stream.is_empty();
}

void decode_meshopt_colors(std::span<std::uint8_t> elements, std::size_t stride) {
    if (stride == 4) decode_colors<std::uint8_t>(elements);
    if (stride == 8) decode_colors<std::uint16_t>(elements);
}

}  // namespace vkcppm
