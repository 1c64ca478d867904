#include "scene/gltf/file.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>
#include <span>

#include "core/ending.h"
#include "core/fnv1a.h"
#include "scene/bad_scene.h"
#include "scene/gltf/meshopt.h"
#include "scene/gltf/schema.h"
#include "scene/gltf/resource.h"
#include "scene/gltf/uri.h"

namespace vkcppm {

namespace {

using nlohmann::json;

constexpr int max_json_depth = 64;  // nlohmann and tinygltf recurse over the tree

void check_size(std::size_t size, std::string_view object, const std::string& file) {
    if (size <= max_gltf_bytes) return;
    bad_scene(file, object, fmt::to_string(size), fmt::format("the limit is {} bytes", max_gltf_bytes));
}

/// What a file holds before its JSON is parsed: views into its bytes.
struct Container {
    std::span<const std::uint8_t> json;
    std::optional<std::span<const std::uint8_t>> binary;  // the BIN chunk of a .glb
};

std::uint32_t read_u32(std::span<const std::uint8_t> bytes, std::size_t offset) {
    return std::uint32_t(bytes[offset]) | std::uint32_t(bytes[offset + 1]) << 8 |
           std::uint32_t(bytes[offset + 2]) << 16 | std::uint32_t(bytes[offset + 3]) << 24;
}

/// Splits a .glb (glTF 2.0, section 4: 12 bytes of header, then chunks of 8 bytes and their data).
Container split_glb(std::span<const std::uint8_t> bytes, const std::string& file) {
    constexpr std::size_t header_size = 12, chunk_header_size = 8;
    constexpr std::uint32_t json_type = 0x4e4f534a, binary_type = 0x004e4942;
    if (bytes.size() < header_size) {
        bad_scene(file, "the size of the GLB", fmt::to_string(bytes.size()), "its header alone has 12 bytes");
    }
    if (const std::uint32_t version = read_u32(bytes, 4); version != 2) {
        bad_scene(file, "the GLB version", fmt::to_string(version), "this program reads 2");
    }
    const std::uint32_t length = read_u32(bytes, 8);
    if (length > bytes.size()) {
        bad_scene(file, "the GLB length", fmt::to_string(length), fmt::format("the file has {} bytes", bytes.size()));
    }
    Container container;
    std::size_t offset = header_size, chunk = 0;
    for (; offset < length; ++chunk) {
        const std::string object = fmt::format("GLB chunk {}", chunk);
        if (length - offset < chunk_header_size) {
            bad_scene(file, object, fmt::format("{} bytes", length - offset), "its header has 8");
        }
        const std::uint32_t size = read_u32(bytes, offset), type = read_u32(bytes, offset + 4);
        offset += chunk_header_size;
        if (size > length - offset) {
            bad_scene(file, object + " length", fmt::to_string(size),
                      fmt::format("{} bytes are left", length - offset));
        }
        if ((chunk == 0) != (type == json_type)) {
            bad_scene(file, object + " type", fmt::format("{:#010x}", type),
                      fmt::format("the first chunk, and no other, is JSON ({:#010x})", json_type));
        }
        if (chunk == 0) container.json = bytes.subspan(offset, size);
        if (chunk == 1 && type == binary_type) container.binary = bytes.subspan(offset, size);
        offset += size;
        // Some writers count no padding into a chunk's length, and some of those pad all the same.
        const std::size_t padded = std::min<std::size_t>((offset + 3) / 4 * 4, length);
        const auto is_binary_at = [&](std::size_t next) {
            return length - next >= chunk_header_size && read_u32(bytes, next + 4) == binary_type;
        };
        if (!is_binary_at(offset)) offset = padded;
    }
    if (chunk == 0) bad_scene(file, "the GLB length", fmt::to_string(length), "it has no JSON chunk");
    return container;
}

Container split(std::span<const std::uint8_t> bytes, const std::string& file) {
    const bool is_glb = bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
    return is_glb ? split_glb(bytes, file) : Container{bytes, std::nullopt};
}

/// Limits how deep the brackets nest, before the parse: nlohmann's parser callback could do it, but in quadratic time.
void check_depth(std::span<const std::uint8_t> text, const std::string& file) {
    int depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '"') in_string = !in_string;
        if (in_string) {
            i += text[i] == '\\';  // the escaped character
        } else if (text[i] == '[' || text[i] == '{') {
            if (++depth <= max_json_depth) continue;
            bad_scene(file, "the depth of the JSON", fmt::to_string(depth),
                      fmt::format("the limit is {}", max_json_depth));
        } else if (text[i] == ']' || text[i] == '}') {
            --depth;
        }
    }
}

json parse_json(std::span<const std::uint8_t> text, const std::string& file) {
    check_depth(text, file);
    try {
        return json::parse(text.begin(), text.end());
    } catch (const json::exception& error) {
        std::string reason = error.what();
        for (char& c : reason) {
            if (std::iscntrl(static_cast<unsigned char>(c))) c = ' ';
        }
        constexpr std::size_t beginning = 200, end = 60;  // between lies what was read last, up to the whole file
        if (reason.size() > beginning + end) reason.replace(beginning, reason.size() - beginning - end, " ... ");
        bad_scene(file, "the file", "not glTF", reason);
    }
}

/// Refuses a scene in the format of another program, by its first bytes or its ending, with a word on what to do.
void check_foreign(std::span<const std::uint8_t> bytes, const std::filesystem::path& path) {
    struct Format {
        std::string_view ending, magic, name;
    };
    static constexpr Format formats[] = {
        {".blend", "BLENDER", "a file of Blender"},
        {".fbx", "Kaydara FBX", "FBX"},
        {".usdc", "PXR-USDC", "USD"},
        {".usda", "#usda", "USD"},
        {".usd", "", "USD"},
        {".usdz", "", "USD"},
        {".obj", "", "Wavefront OBJ"},
        {".dae", "", "COLLADA"},
        {".ply", "ply\n", "PLY"},
        {".stl", "", "STL"},
        {".abc", "Ogawa", "Alembic"},
        {".3ds", "", "3DS"},
    };
    const std::string ending = ending_of(path);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const bool begins_like_gltf = text.starts_with("glTF") || text.substr(0, 16).find('{') != text.npos;
    for (const Format& format : formats) {
        const bool is_it = !format.magic.empty() && text.starts_with(format.magic);
        if (!is_it && (ending != format.ending || begins_like_gltf)) continue;
        bad_scene(path.string(), "the file", std::string(format.name),
                  "this program reads glTF 2.0: export it as .glb (in Blender: File > Export > glTF 2.0)");
    }
}

void check_version(const json& document, const std::string& file) {
    if (!document.is_object()) bad_scene(file, "the JSON", json_text(document), "it must be an object");
    const json asset = document.value("asset", json());
    const json version = asset.is_object() ? asset.value("version", json()) : json();
    if (!version.is_string()) {
        bad_scene(file, "asset.version", version.is_null() ? "missing" : json_text(version), "glTF requires \"2.0\"");
    }
    if (!version.get_ref<const std::string&>().starts_with("2.")) {
        bad_scene(file, "asset.version", json_text(version), "this program reads \"2.0\"");
    }
    if (const json minimum = asset.value("minVersion", json("2.0")); minimum != "2.0") {
        bad_scene(file, "asset.minVersion", json_text(minimum), "this program reads \"2.0\"");
    }
}

/// Reads the bytes of buffers, those of a file that several buffers name once for all.
class BufferReader {
public:
    BufferReader(const json& buffers, std::optional<std::span<const std::uint8_t>> binary, GltfFile& file)
        : buffers_(buffers), binary_(binary), file_(file) {
        for (const json& buffer : buffers) {
            if (!buffer.contains("uri")) continue;
            std::size_t& needed = needed_[buffer["uri"].get_ref<const std::string&>()];
            needed = std::max(needed, buffer["byteLength"].get<std::size_t>());
        }
    }

    /// The bytes that buffers[i] names, byteLength or as many as there are; null, and why, where there are none at all.
    /// An external file's go into the file's hash as well.
    std::shared_ptr<const Bytes> read(std::size_t i, std::string& why) {
        const json& buffer = buffers_[i];
        if (const auto uri = buffer.find("uri"); uri != buffer.end()) {
            return read_named(uri->get_ref<const std::string&>(), i, why);
        }
        const char* extension = meshopt_extension(buffer);
        if (extension && buffer["extensions"][extension].value("fallback", false)) {
            why = fmt::format("it is a fallback for programs without {}, and holds nothing", extension);
            return nullptr;
        }
        if (i == 0 && binary_) return std::make_shared<const Bytes>(binary_->begin(), binary_->end());
        why = "it has no uri, and the file no binary chunk for it";
        return nullptr;
    }

private:
    std::shared_ptr<const Bytes> read_named(const std::string& uri, std::size_t i, std::string& why) {
        std::shared_ptr<const Bytes>& known = read_[uri];
        if (known) return known;
        std::optional<Bytes> bytes =
            read_uri(uri, needed_[uri], fmt::format("buffers[{}].uri", i), file_.name, file_.root, file_.hash, why);
        if (!bytes) return nullptr;
        if (!is_data_uri(uri)) file_.bytes += bytes->size();
        return known = std::make_shared<const Bytes>(std::move(*bytes));
    }

    const json& buffers_;
    std::optional<std::span<const std::uint8_t>> binary_;
    GltfFile& file_;
    std::map<std::string_view, std::size_t> needed_;  // the largest byteLength of a uri
    std::map<std::string_view, std::shared_ptr<const Bytes>> read_;
};

std::filesystem::path canonical_folder(const std::filesystem::path& folder) {
    std::error_code error;
    const std::filesystem::path canonical = std::filesystem::canonical(folder, error);
    if (error || !std::filesystem::is_directory(canonical, error)) {
        throw Error(ExitCode::no_input, fmt::format("--root {}: no such folder", folder.string()));
    }
    return canonical;
}

/// The file itself and those that its buffers and images name.
std::vector<std::filesystem::path> named_files(const json& document, const std::filesystem::path& path) {
    std::vector<std::filesystem::path> files{path};
    for (const char* array : {"buffers", "images"}) {
        for (const json& element : document.value(array, json::array())) {
            const std::string uri = element.value("uri", "");
            if (is_data_uri(uri)) continue;
            if (const auto file = resolve_uri(path.parent_path(), uri)) files.push_back(*file);
        }
    }
    return files;
}

}  // namespace

GltfFile read_gltf_file(const std::filesystem::path& path, const std::optional<std::filesystem::path>& root) {
    GltfFile file;
    file.name = path.string();
    file.hash = fnv1a_start;
    std::string why;
    const std::optional<Bytes> bytes = read_bytes(path, max_gltf_bytes + 1, why);
    if (!bytes) throw Error(ExitCode::no_input, fmt::format("{}: {}", file.name, why));
    file.root = root ? canonical_folder(*root) : default_root(path);
    check_size(bytes->size(), "the size of the file", file.name);
    file.hash = fnv1a(*bytes, file.hash);
    file.bytes = bytes->size();

    check_foreign(*bytes, path);
    const Container container = split(*bytes, file.name);
    file.document = parse_json(container.json, file.name);
    check_version(file.document, file.name);
    if (const auto missing = unsupported_extensions(file.document, "extensionsRequired", file.name); !missing.empty()) {
        const bool is_basisu = std::ranges::find(missing, "\"KHR_texture_basisu\"") != missing.end();
        bad_scene(
            file.name, "extensionsRequired", fmt::format("{}", fmt::join(missing, ", ")),
            is_basisu ? "this program lacks it: export its textures as PNG, JPEG or WebP" : "this program lacks it");
    }
    check_gltf_schema(file.document, file.name);

    file.files = named_files(file.document, path);
    const json buffers = file.document.value("buffers", json::array());
    BufferReader reader(buffers, container.binary, file);
    std::size_t total_size = 0;
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        GltfBuffer& buffer = file.buffers.emplace_back();
        buffer.size = buffers[i]["byteLength"].get<std::size_t>();
        total_size += buffer.size;
        check_size(total_size, "the byteLength of the buffers together", file.name);
        // One without bytes is there, whatever its uri is: of an empty one exporters write "data:".
        buffer.bytes = buffer.size == 0 ? std::make_shared<const Bytes>() : reader.read(i, buffer.absent);
        if (buffer.bytes && buffer.size > buffer.bytes->size()) {
            bad_scene(file.name, fmt::format("buffers[{}].byteLength", i), fmt::to_string(buffer.size),
                      fmt::format("its data has {} bytes", buffer.bytes->size()));
        }
    }
    return file;
}

bool requires_extension(const GltfFile& file, const char* extension) {
    const json required = file.document.value("extensionsRequired", json::array());
    return std::ranges::find(required, extension) != required.end();
}

}  // namespace vkcppm
