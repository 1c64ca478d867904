#pragma once
// Numbers of 16 bits in two bytes of which the first alone is the number in 8 bits.

#include <algorithm>
#include <cstdint>

namespace vkcppm {

/// value = 257 byte + rest: value / 65535 = byte / 255 + rest / 65535.
struct SixteenBits {
    std::uint8_t byte;
    std::int8_t rest;  // -127 to 127
};

/// To the nearest byte. Half-way between two bytes, where the rest is 128 either way, the value is off by 1.
inline SixteenBits split_16_bits(std::uint32_t value) {
    const std::uint32_t byte = (value + 128) / 257;
    return {std::uint8_t(byte), std::int8_t(std::clamp(int(value) - 257 * int(byte), -127, 127))};
}

}  // namespace vkcppm
