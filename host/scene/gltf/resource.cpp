#include "scene/gltf/resource.h"

#include <algorithm>
#include <fstream>

#include <nlohmann/json.hpp>

#include "core/fnv1a.h"
#include "core/input_file.h"
#include "scene/bad_scene.h"
#include "scene/gltf/schema.h"
#include "scene/gltf/uri.h"

namespace vkcppm {

std::optional<Bytes> read_bytes(const std::filesystem::path& path, std::size_t limit, std::string& why) {
    if (const auto reason = why_unreadable(path)) {
        why = *reason;
        return std::nullopt;
    }
    std::ifstream stream(path, std::ios::binary | std::ios::ate);
    Bytes bytes(stream ? std::min(std::size_t(stream.tellg()), limit) : 0);
    stream.seekg(0);
    if (!stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()))) {
        why = "cannot be read";
        return std::nullopt;
    }
    return bytes;
}

namespace {

/// Whether a file, or where it would be, is below `root` once symbolic links are followed: an archive may bring some.
bool is_inside(const std::filesystem::path& path, const std::filesystem::path& root) {
    std::error_code error;
    const std::filesystem::path target = std::filesystem::weakly_canonical(std::filesystem::absolute(path), error);
    if (error) return false;
    return *target.lexically_relative(root).begin() != "..";
}

}  // namespace

std::filesystem::path default_root(const std::filesystem::path& file) {
    std::error_code error;  // of a pipe, which is no file, as read_bytes says
    return std::filesystem::canonical(std::filesystem::absolute(file), error).parent_path();
}

std::optional<Bytes> read_uri(const std::string& uri, std::size_t limit, const std::string& object,
                              const std::string& file, const std::filesystem::path& root, std::uint64_t& hash,
                              std::string& why) {
    if (is_data_uri(uri)) {
        std::optional<Bytes> bytes = decode_data_uri(uri);
        if (!bytes) {
            bad_scene(file, object, json_text(uri.substr(0, 50)), "its data must be valid base64 or percent-encoded");
        }
        return bytes;
    }
    const std::optional<std::filesystem::path> path = resolve_uri(std::filesystem::path(file).parent_path(), uri);
    std::optional<Bytes> bytes;
    if (!path) {
        why = "not a relative path";
    } else if (!is_inside(*path, root)) {
        why = fmt::format("outside of {}, see --root", root.string());
    } else {
        bytes = read_bytes(*path, limit, why);
    }
    if (bytes) {
        hash = fnv1a(*bytes, hash);
    } else {
        why = fmt::format("{}: {}", json_text(uri), why);
    }
    return bytes;
}

}  // namespace vkcppm
