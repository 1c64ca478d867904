#pragma once
// Whole files as strings, and what is in a folder.

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

namespace vkcppm::test {

/// The bytes of a file; empty where it cannot be read.
inline std::string read_bytes(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

inline std::set<std::string> names_in(const std::filesystem::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        names.insert(entry.path().filename().string());
    }
    return names;
}

}  // namespace vkcppm::test
