#include "app/option_values.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"

namespace vkcppm {
namespace {

constexpr std::uint32_t most_frame = 1000000;  // half a day of film: more is taken for a slip

/// Reads the number at the start of `text` and removes it; false where there is none or it does not fit.
template <typename Number> bool take_number(std::string_view& text, Number& number) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc()) return false;
    text.remove_prefix(std::size_t(end - text.data()));
    return true;
}

/// Seconds of a time such as 90, 90s, 2m, 1.5h or 500ms; nothing where it is none.
std::optional<double> seconds_of(const std::string& text) {
    constexpr std::pair<std::string_view, double> units[] = {
        {"", 1.0}, {"s", 1.0}, {"ms", 1e-3}, {"m", 60.0}, {"h", 3600.0}};
    std::string_view rest = text;
    double number = 0.0;
    if (!take_number(rest, number)) return std::nullopt;
    for (const auto& [unit, scale] : units) {
        if (rest == unit && std::isfinite(number * scale)) return number * scale;
    }
    return std::nullopt;
}

}  // namespace

void refuse(const std::string& option, const std::string& text, const std::string& wanted) {
    throw Error(ExitCode::usage, fmt::format("{}: '{}' is not {}", option, text, wanted));
}

std::uint32_t parse_whole(const std::string& option, const std::string& text) {
    std::string_view rest = text;
    std::uint32_t number = 0;
    if (!take_number(rest, number) || !rest.empty()) {
        const bool is_large = text.find_first_not_of("0123456789") == std::string::npos && !text.empty();
        refuse(option, text, fmt::format("a whole number{}", is_large ? " below 2^32" : ", such as 64"));
    }
    return number;
}

double parse_real(const std::string& option, const std::string& text) {
    std::string_view rest = text;
    double number = 0.0;
    if (!take_number(rest, number) || !rest.empty() || !std::isfinite(number)) refuse(option, text, "a finite number");
    return number;
}

double parse_factor(const std::string& option, const std::string& text) {
    const double factor = parse_real(option, text);
    if (factor < 0.0 || factor > std::numeric_limits<float>::max()) refuse(option, text, "a number of 0 or more");
    return factor;
}

double parse_rate(const std::string& option, const std::string& text) {
    const double rate = parse_real(option, text);
    if (!(rate > 0.0 && rate <= 1e6)) refuse(option, text, "a number above 0, to 1000000");
    return rate;
}

FrameRange parse_frames(const std::string& option, const std::string& text) {
    std::string_view rest = text;
    FrameRange frames;
    const bool has_first = take_number(rest, frames.first) && rest.starts_with("..");
    if (has_first) rest.remove_prefix(2);
    if (!has_first || !take_number(rest, frames.last) || !rest.empty() || frames.last < frames.first ||
        frames.last > most_frame) {
        refuse(option, text, fmt::format("FIRST..LAST, such as 0..47, the last at most {}", most_frame));
    }
    return frames;
}

Shard parse_shard(const std::string& option, const std::string& text) {
    std::string_view rest = text;
    Shard shard;
    const bool has_number = take_number(rest, shard.number) && rest.starts_with('/');
    if (has_number) rest.remove_prefix(1);
    if (!has_number || !take_number(rest, shard.of) || !rest.empty() || shard.number < 1 || shard.number > shard.of)
        refuse(option, text, "K/N, such as 2/5, K from 1 to N");
    return shard;
}

std::string parse_name(const std::string& option, const std::string& text) {
    if (text.empty()) refuse(option, text, "a name");  // an unset variable of a shell must not mean the default
    return text;
}

std::optional<double> parse_exposure(const std::string& option, const std::string& text) {
    if (text == "auto") return std::nullopt;
    constexpr double most = 128.0;  // stops: any float becomes white or black
    std::string_view rest = text;
    double stops = 0.0;
    if (!take_number(rest, stops) || !rest.empty() || !(std::abs(stops) <= most))
        refuse(option, text, fmt::format("auto or a number from {} to {}", -most, most));
    return stops;
}

ToneMap parse_tone_map(const std::string& option, const std::string& text) {
    for (const ToneMap tone_map : {ToneMap::none, ToneMap::reinhard, ToneMap::aces, ToneMap::agx}) {
        if (text == name_of(tone_map)) return tone_map;
    }
    refuse(option, text, "none, reinhard, aces or agx");
}

PngDepth parse_png_depth(const std::string& option, const std::string& text) {
    if (text != "8" && text != "16") refuse(option, text, "8 or 16");
    return text == "8" ? PngDepth::eight : PngDepth::sixteen;
}

double parse_share(const std::string& option, const std::string& text) {
    std::string_view rest = text;
    double number = 0.0;
    if (!take_number(rest, number) || !std::isfinite(number) || number < 0.0 || (!rest.empty() && rest != "%"))
        refuse(option, text, "a number from 0 up, such as 0.001 or 0.1%");
    return rest.empty() ? number : number / 100.0;
}

Extent parse_size(const std::string& option, const std::string& text) {
    std::string_view rest = text;
    Extent size;
    const bool width = take_number(rest, size.width) && rest.starts_with('x');
    if (width) rest.remove_prefix(1);
    if (!width || !take_number(rest, size.height) || !rest.empty())
        refuse(option, text, "WIDTHxHEIGHT in pixels, such as 512x384");
    return size;
}

ThinGlass parse_thin_glass(const std::string& option, const std::string& text) {
    if (text != "thin" && text != "solid") refuse(option, text, "thin or solid");
    return text == "solid" ? ThinGlass::solid : ThinGlass::thin;
}

PunctualUnits parse_punctual_units(const std::string& option, const std::string& text) {
    for (const PunctualUnits units :
         {PunctualUnits::radiometric, PunctualUnits::photometric, PunctualUnits::by_generator}) {
        if (text == name_of(units)) return units;
    }
    refuse(option, text, "radiometric, photometric or auto");
}

double parse_seconds(const std::string& option, const std::string& text) {
    const std::optional<double> seconds = seconds_of(text);
    if (!seconds || !(*seconds > 0.0))
        refuse(option, text, "a time greater than 0, such as 90, 90s, 2m, 1.5h or 500ms");
    return *seconds;
}

double parse_moment(const std::string& option, const std::string& text) {
    const std::optional<double> seconds = seconds_of(text);
    if (!seconds) refuse(option, text, "a time in seconds, such as 1.5 or 1.5s");
    return *seconds;
}

namespace {

/// NAME=VALUE with a finite value.
std::pair<std::string, double> parse_assignment(const std::string& option, const std::string& text,
                                                const std::string& example) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) refuse(option, text, fmt::format("METRIC=VALUE, such as {}", example));
    std::string_view rest = std::string_view(text).substr(equals + 1);
    double value = 0.0;
    if (!take_number(rest, value) || !rest.empty() || !std::isfinite(value)) value = -1.0;
    return {text.substr(0, equals), value};
}

}  // namespace

LiveAddress parse_live(const std::string& option, const std::string& text) {
    // A host in brackets may have colons, as addresses of version 6 do.
    const bool is_bracketed = text.starts_with('[');
    const std::size_t end = is_bracketed ? text.find(']') : text.find(':');
    const std::string host = text.substr(is_bracketed ? 1 : 0, is_bracketed ? end - 1 : end);
    std::string_view rest = text;
    rest.remove_prefix(end == std::string::npos ? text.size() : end + (is_bracketed ? 1 : 0));
    std::uint16_t port = 14158;  // tev's own
    const bool has_port = rest.starts_with(':');
    if (has_port) rest.remove_prefix(1);
    const bool is_open = is_bracketed && end == std::string::npos;
    if (host.empty() || is_open || (has_port && !take_number(rest, port)) || !rest.empty() || port == 0)
        refuse(option, text, "HOST:PORT, such as localhost:14158");
    return {host, std::to_string(port)};
}

StopAt parse_stop_at(const std::string& option, const std::string& text) {
    const auto [name, value] = parse_assignment(option, text, "relmse_trimmed=0.0035");
    const StopAt result{&find_metric(option, name), value};
    if (!(value > 0.0)) refuse(option, text, "a metric and a finite number greater than 0");
    return result;
}

Target parse_target(const std::string& option, const std::string& text) {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    std::string names;
    for (const EstimatedMeasure& measure : estimated_measures()) {
        if (equals != std::string::npos && measure.name == name) {
            const double value = parse_share(option, text.substr(equals + 1));
            if (!(value > 0.0)) refuse(option, text, "a measure and a number greater than 0");
            return {.measure = &measure, .value = value};
        }
        names += fmt::format("{}{}", names.empty() ? "" : ", ", measure.name);
    }
    refuse(option, text, fmt::format("MEASURE=VALUE of {}, such as relmse_trimmed=0.001 or noise=2%", names));
}

double parse_confidence(const std::string& option, const std::string& text) {
    std::string_view rest = text;
    double percent = 0.0;
    const bool is_number = take_number(rest, percent) && (rest.empty() || rest == "%");
    if (!is_number || !(percent >= 50.0 && percent < 100.0)) refuse(option, text, "percent from 50 to below 100");
    return percent / 100.0;
}

Bound parse_bound(const std::string& option, const std::string& text) {
    const auto [name, value] = parse_assignment(option, text, "flip=0.05");
    if (!is_measure(name))
        throw Error(ExitCode::usage, fmt::format("{}: '{}' is no metric: there are {}", option, name, measure_names()));
    if (!(value >= 0.0)) refuse(option, text, "a metric and a finite number of 0 or more");
    return {name, value};
}

}  // namespace vkcppm
