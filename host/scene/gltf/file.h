#pragma once
// A .gltf or .glb file with the buffers it names: bytes and checked JSON, before any meaning.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace vkcppm {

/// Of the file, of its buffers together, of all that they expand to, and of an image.
constexpr std::size_t max_gltf_bytes = std::size_t(1) << 32;

struct GltfBuffer {
    std::size_t size = 0;                                    // byteLength
    std::shared_ptr<const std::vector<std::uint8_t>> bytes;  // [size] or more; null where there is no such data
    std::string absent;  // why there is none: an error once something is read from it
};

struct GltfFile {
    std::string name;                          // the path as given, for messages
    std::filesystem::path root;                // canonical; what it names by URI must lie below
    nlohmann::json document;                   // passed check_gltf_schema
    std::vector<GltfBuffer> buffers;           // as in the document
    std::size_t bytes = 0;                     // of the file and of the external buffers that were read
    std::uint64_t hash = 0;                    // FNV-1a of the file's bytes, then of each external buffer's
    std::vector<std::filesystem::path> files;  // itself and all that it names, whether they are there and read or not
    std::vector<std::size_t> decoded;          // of the document's last accessors, which Draco filled: the file's own
};

/// Reads the file, tells .gltf from .glb by its first bytes, and resolves every buffer: data URI, file below `root` (by
/// default: default_root()), or the binary chunk. What no mesh needs, such as an animation's data, may be absent.
/// Throws Error: no_input where the file or the root is missing or unreadable, else bad_input.
GltfFile read_gltf_file(const std::filesystem::path& path,
                        const std::optional<std::filesystem::path>& root = std::nullopt);

/// Whether the file says that it means nothing without the extension.
bool requires_extension(const GltfFile& file, const char* extension);

}  // namespace vkcppm
