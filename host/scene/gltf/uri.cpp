#include "scene/gltf/uri.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <string>

namespace vkcppm {

namespace {

/// The six bits of a base64 digit, or -1. Also of the alphabet for URLs and file names (RFC 4648, section 5).
int base64_digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+' || c == '-') return 62;
    if (c == '/' || c == '_') return 63;
    return -1;
}

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\f' || c == '\r'; }

/// Spaces and ends of lines, by which some programs break long texts, count for nothing.
std::optional<std::vector<std::uint8_t>> decode_base64(std::string text) {
    std::erase_if(text, is_space);
    for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) text.pop_back();
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

/// A percent sign before anything but two digits stands for itself, as in a URL of a browser: file names have some.
std::string percent_decode(std::string_view text) {
    std::string decoded;
    decoded.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        unsigned value = 0;
        const std::string_view digits = text.substr(i + 1, text[i] == '%' ? 2 : 0);
        const auto end = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16).ptr;
        const bool is_escape = digits.size() == 2 && end == digits.data() + 2;
        decoded += is_escape ? char(value) : text[i];
        i += is_escape ? 2 : 0;
    }
    return decoded;
}

/// Whether they are the same but for capitals. word: in small letters.
bool is_word(std::string_view text, std::string_view word) {
    return std::ranges::equal(text, word, {}, [](char c) { return char(std::tolower(static_cast<unsigned char>(c))); });
}

/// The relative path that `name` is, below `folder`; none where it is none.
std::optional<std::filesystem::path> below(const std::filesystem::path& folder, const std::string& name) {
    if (name.empty() || name.find('\0') != std::string::npos) return std::nullopt;
    const auto path = std::filesystem::path(name).lexically_normal();
    if (path.is_absolute()) return std::nullopt;
    return folder / path;
}

}  // namespace

bool is_data_uri(std::string_view uri) { return is_word(uri.substr(0, 5), "data:"); }

std::optional<std::vector<std::uint8_t>> decode_data_uri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos) return std::nullopt;
    constexpr std::string_view base64 = ";base64";
    const std::string_view type = uri.substr(0, comma);
    std::string data = percent_decode(uri.substr(comma + 1));
    if (type.size() >= base64.size() && is_word(type.substr(type.size() - base64.size()), base64)) {
        return decode_base64(std::move(data));
    }
    return std::vector<std::uint8_t>(data.begin(), data.end());
}

std::optional<std::filesystem::path> resolve_uri(const std::filesystem::path& folder, std::string_view uri) {
    const std::size_t colon = uri.find_first_of(":/");
    if (colon != std::string_view::npos && uri[colon] == ':') return std::nullopt;  // a scheme such as http:
    std::string separated(uri);
    std::ranges::replace(separated, '\\', '/');  // of programs on Windows
    const auto decoded = below(folder, percent_decode(separated)), as_written = below(folder, separated);
    // Some programs call the file itself by the encoded name.
    std::error_code error;
    const bool is_as_written = decoded && as_written && !std::filesystem::exists(*decoded, error) &&
                               std::filesystem::exists(*as_written, error);
    return is_as_written ? as_written : decoded;
}

}  // namespace vkcppm
