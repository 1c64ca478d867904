#pragma once
// What a row of render/settings_table.h says, and the rows as values to go over.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <tuple>

#include "render/settings_members.h"
#include "shared/types.h"

namespace vkcppm {
namespace setting {

/// What a setting decides, from which follows who takes it: vkcppm SCENE, race, reference, and each entrant of a race.
enum class Kind {
    method,     // how photons become radiance: vkcppm SCENE; entrants have their own
    bound,      // where it ends: all three, each of which says in its own words what that means to it
    picture,    // how the picture is made: all three
    paths,      // likewise, and how many paths and how long: entrants may have their own
    view,       // likewise, and what it shows: that of another value is no reference for it
    parameter,  // of the estimators: vkcppm SCENE and race; entrants have their own
    layers,     // what is told besides the picture: vkcppm SCENE and race
    channels,   // likewise: vkcppm SCENE
    internal,   // set by the program alone
};

/// All but the bounds are part of what a render is: a checkpoint of another value cannot be gone on from.
constexpr bool is_identity(Kind kind) { return kind != Kind::bound; }

constexpr bool is_of_reference(Kind kind) {
    return kind == Kind::bound || kind == Kind::picture || kind == Kind::paths || kind == Kind::view;
}

constexpr bool is_of_entrant(Kind kind) { return kind == Kind::parameter || kind == Kind::paths; }

/// Of a value, which tells how it is written.
enum class Unit { count, number, metres, seconds, pixels, camera, name, flag };

/// Values that a setting takes, as the last two words say it; an optional one may be absent as well.
struct Any {};
template <typename T> struct Within {  // low <= value <= high
    T low, high;
};
struct Between {  // low < value < high, as floats, which kernels take it as
    double low, high;
};
template <typename T, std::size_t N> struct OneOf { std::array<T, N> values; };
struct Pixels {  // 1..side wide and high, at most `pixels` in all
    std::uint32_t side;
    std::size_t pixels;
};
struct AnEstimator {};  // a name of render/estimators.h
struct Word {
    const char* name;
    const char* summary;  // one line for --help
};
template <std::size_t N> struct Words { std::array<Word, N> values; };

constexpr Any any() { return {}; }
template <typename T> constexpr Within<T> within(T low, T high) { return {low, high}; }
constexpr Between between(double low, double high) { return {low, high}; }
template <typename T, typename... More> constexpr OneOf<T, 1 + sizeof...(More)> one_of(T first, More... more) {
    return {{first, more...}};
}
constexpr Pixels pixels(std::uint32_t side, std::size_t pixels) { return {side, pixels}; }
constexpr AnEstimator an_estimator() { return {}; }
template <typename... More> constexpr Words<sizeof...(More)> words(More... words) { return {{words...}}; }

inline constexpr double longest = 1e9;  // m, of a lens; one over it is the shortest

template <typename T, typename Values> struct Row {
    const char* name;
    T Settings::*member;
    Kind kind;
    Values values;
    Unit unit;
    const char* help;
};

/// The rows in the order of the table.
inline constexpr std::tuple rows{
#define SETTING(member, type, standard, name, kind, values, unit, help) \
    Row<type, decltype(values)>{name, &Settings::member, Kind::kind, values, Unit::unit, help},
#include "render/settings_table.h"
#undef SETTING
};

/// The value of a member; null where it is absent.
template <typename T> const T* given(const T& value) { return &value; }
template <typename T> const T* given(const std::optional<T>& value) { return value ? &*value : nullptr; }

/// Calls `visit` with each row.
template <typename Visit> constexpr void for_each(const Visit& visit) {
    std::apply([&](const auto&... row) { (visit(row), ...); }, rows);
}

}  // namespace setting
}  // namespace vkcppm
