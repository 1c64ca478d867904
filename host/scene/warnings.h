#pragma once
// Warnings of a kind become one line, however often they occur.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace vkcppm {

class Warnings {
public:
    /// `kind` says what is odd, `object` where. The first object of a kind is named, the others are counted.
    void add(std::string_view kind, std::string_view object) {
        for (Entry& entry : entries_) {
            if (entry.kind == kind) {
                ++entry.count;
                return;
            }
        }
        entries_.push_back({std::string(kind), std::string(object), 1});
    }

    /// One line a kind, in the order of first occurrence: "<file>: <object> (and <n> more): <kind>".
    std::vector<std::string> lines(std::string_view file) const {
        std::vector<std::string> lines;
        for (const Entry& entry : entries_) {
            const std::string more = entry.count > 1 ? fmt::format(" (and {} more)", entry.count - 1) : "";
            lines.push_back(fmt::format("{}: {}{}: {}", file, entry.object, more, entry.kind));
        }
        return lines;
    }

private:
    struct Entry {
        std::string kind;
        std::string object;
        std::size_t count;
    };
    std::vector<Entry> entries_;  // a handful: every kind is a literal of the loader
};

}  // namespace vkcppm
