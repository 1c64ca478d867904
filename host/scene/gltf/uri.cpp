#include "scene/gltf/uri.h"

#include <charconv>
#include <string>

namespace vkcppm {

namespace {

/// The six bits of a base64 digit, or -1.
int base64_digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+') return 62;
    if (c == '/') return 63;
    return -1;
}

std::optional<std::vector<std::uint8_t>> decode_base64(std::string_view text) {
    for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) text.remove_suffix(1);
    if (text.size() % 4 == 1) return std::nullopt;  // six bits make no byte
    std::vector<std::uint8_t> bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    int held = 0;
    for (const char c : text) {
        const int digit = base64_digit(c);
        if (digit < 0) return std::nullopt;
        bits = bits << 6 | std::uint32_t(digit);
        held += 6;
        if (held >= 8) {
            held -= 8;
            bytes.push_back(std::uint8_t(bits >> held));
        }
    }
    return bytes;
}

std::optional<std::string> percent_decode(std::string_view text) {
    std::string decoded;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            decoded += text[i];
            continue;
        }
        unsigned value = 0;
        const std::string_view digits = text.substr(i + 1, 2);
        const auto end = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16).ptr;
        if (digits.size() != 2 || end != digits.data() + 2) return std::nullopt;
        decoded += char(value);
        i += 2;
    }
    return decoded;
}

}  // namespace

bool is_data_uri(std::string_view uri) { return uri.starts_with("data:"); }

std::optional<std::vector<std::uint8_t>> decode_data_uri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos) return std::nullopt;
    const std::string_view data = uri.substr(comma + 1);
    if (uri.substr(0, comma).ends_with(";base64")) return decode_base64(data);
    const std::optional<std::string> text = percent_decode(data);
    if (!text) return std::nullopt;
    return std::vector<std::uint8_t>(text->begin(), text->end());
}

std::optional<std::filesystem::path> resolve_uri(const std::filesystem::path& folder, std::string_view uri) {
    const std::size_t colon = uri.find_first_of(":/");
    if (colon != std::string_view::npos && uri[colon] == ':') return std::nullopt;  // a scheme such as http:
    const std::optional<std::string> decoded = percent_decode(uri);
    if (!decoded || decoded->empty() || decoded->find('\0') != std::string::npos) return std::nullopt;
    const auto path = std::filesystem::path(*decoded).lexically_normal();
    if (path.is_absolute()) return std::nullopt;
    return folder / path;
}

}  // namespace vkcppm
