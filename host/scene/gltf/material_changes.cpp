#include "scene/gltf/material_changes.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <charconv>
#include <string_view>
#include <system_error>

#include <fmt/ranges.h>

#include "scene/gltf/choice.h"

namespace vkcppm {

namespace {

using nlohmann::json;

constexpr std::string_view pbr = "pbrMetallicRoughness";

/// A member that can be set. What the readers of a file clamp is refused here: who types it can type it again.
struct Member {
    std::string_view name;
    std::string_view holder;  // the object in the material that has it: pbrMetallicRoughness or an extension; or empty
    std::size_t channels;     // 1: a number, 3: a colour
    double low, high;
};

const std::vector<Member>& members() {
    static const std::vector<Member> all = [] {
        std::vector<Member> table = {
            {"baseColorFactor", pbr, 3, 0.0, 1.0},
            {"metallicFactor", pbr, 1, 0.0, 1.0},
            {"roughnessFactor", pbr, 1, 0.0, 1.0},
            {"emissiveFactor", "", 3, 0.0, 1.0},
            {"emissiveStrength", "KHR_materials_emissive_strength", 1, 0.0, FLT_MAX},
            {"alphaCutoff", "", 1, 0.0, FLT_MAX},
            {"ior", "KHR_materials_ior", 1, 1.0, FLT_MAX},
            {"attenuationDistance", "KHR_materials_volume", 1, FLT_MIN, FLT_MAX},
        };
        // clang-format off
#define EXTENSION(name, ...) { [[maybe_unused]] const char* extension = #name; __VA_ARGS__ }
#define FACTOR(member, json, standard, low, high) table.push_back({json, extension, 1, low, high});
#define COLOR(member, json, standard, high) table.push_back({json, extension, 3, 0.0, high});
#include "scene/material_extensions.h"
        // clang-format on
        return table;
    }();
    return all;
}

/// What a member takes, in words: 0..1, or without a bound that is no more than that of floats.
std::string range_of(const Member& member) {
    const std::string range = member.low == -FLT_MAX   ? "any number"
                              : member.low == FLT_MIN  ? "above 0"
                              : member.high == FLT_MAX ? fmt::format("{} or more", member.low)
                                                       : fmt::format("{}..{}", member.low, member.high);
    return member.channels == 1 ? range : fmt::format("R,G,B of {}", range);
}

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
    throw Error(ExitCode::usage, fmt::format("--set '{}': {}", text, why));
}

const Member& member_named(std::string_view name, const std::string& text) {
    const auto found = std::ranges::find(members(), name, &Member::name);
    if (found != members().end()) return *found;
    std::vector<std::string_view> names;
    for (const Member& member : members()) names.push_back(member.name);
    refuse(text, fmt::format("'{}' is none of {}", name, fmt::join(names, ", ")));
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (std::size_t end = 0; end != text.npos;) {
        end = text.find(separator);
        parts.push_back(text.substr(0, end));
        if (end != text.npos) text.remove_prefix(end + 1);
    }
    return parts;
}

std::vector<double> read_values(std::string_view words, const Member& member, const std::string& text) {
    std::vector<double> values;
    for (const std::string_view word : split(words, ',')) {
        double& value = values.emplace_back();
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        const bool is_number = error == std::errc() && end == word.data() + word.size();
        if (is_number && value >= member.low && value <= member.high) continue;
        refuse(text, fmt::format("{} '{}' is not {}", member.name, words, range_of(member)));
    }
    if (values.size() != member.channels) {
        refuse(text, fmt::format("{} '{}' is not {}", member.name, words, range_of(member)));
    }
    return values;
}

}  // namespace

std::string MaterialChange::text() const {
    std::string text = material;
    for (const auto& [name, numbers] : values) text += fmt::format(":{}={}", name, fmt::join(numbers, ","));
    return text;
}

MaterialChange parse_material_change(const std::string& text) {
    std::vector<std::string_view> parts = split(text, ':');
    // A material's own name may have colons: the assignments are what stands at the end.
    auto first = parts.end();
    while (first != parts.begin() + 1 && (first - 1)->find('=') != std::string_view::npos) --first;
    MaterialChange change{fmt::format("{}", fmt::join(parts.begin(), first, ":")), {}};
    if (change.material.empty() || first == parts.end()) {
        refuse(text, "it is not MATERIAL:member=value[:member=value], such as glass:ior=1.33");
    }
    for (; first != parts.end(); ++first) {
        const std::size_t equals = first->find('=');
        const Member& member = member_named(first->substr(0, equals), text);
        change.values.emplace_back(member.name, read_values(first->substr(equals + 1), member, text));
    }
    return change;
}

std::string material_members(std::size_t width) {
    std::string text;
    std::size_t column = 0;
    for (const Member& member : members()) {
        std::string word = fmt::format("{} ({})", member.name, range_of(member));
        if (&member != &members().back()) word += ',';
        if (column > 0) text += column + 1 + word.size() > width ? '\n' : ' ';
        column = text.ends_with('\n') || text.empty() ? word.size() : column + 1 + word.size();
        text += word;
    }
    return text;
}

void change_materials(GltfFile& file, const std::vector<MaterialChange>& changes) {
    for (const MaterialChange& change : changes) {
        if (!file.document.contains("materials")) file.document["materials"] = json::array();
        json& materials = file.document["materials"];
        const std::size_t chosen = choose("--set", change.material, materials, "materials", file.name);
        for (std::size_t i = 0; i < materials.size(); ++i) {
            if (i != chosen && materials[i].value("name", "") != change.material) continue;
            for (const auto& [name, values] : change.values) {
                const Member& member = *std::ranges::find(members(), name, &Member::name);
                json* holder = &materials[i];
                if (member.holder.starts_with("KHR_")) holder = &(*holder)["extensions"];
                if (!member.holder.empty()) holder = &(*holder)[std::string(member.holder)];
                json value = values.size() == 1 ? json(values.front()) : json(values);
                if (name == "baseColorFactor") {  // its alpha stays what it is
                    value.push_back(holder->value(name, std::array<double, 4>{1.0, 1.0, 1.0, 1.0})[3]);
                }
                (*holder)[name] = std::move(value);
            }
        }
    }
}

}  // namespace vkcppm
