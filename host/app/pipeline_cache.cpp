#include "app/pipeline_cache.h"

#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <iterator>
#include <system_error>

#include <fmt/format.h>

#include "app/version.h"
#include "core/fnv1a.h"
#include "io/atomic_file.h"

namespace vkcppm {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t header_bytes = 32;  // of a cache that holds nothing
constexpr std::string_view mark = "vkcppm pipelines\n";

/// The value of an environment variable where it is an absolute path, as the XDG specification asks for.
std::optional<fs::path> folder_in(const char* variable) {
    const char* value = std::getenv(variable);
    if (!value || !fs::path(value).is_absolute()) return std::nullopt;
    return fs::path(value);
}

}  // namespace

std::optional<fs::path> pipeline_file(const DeviceInfo& info) {
    std::optional<fs::path> folder = folder_in("XDG_CACHE_HOME");
    if (!folder) {
        folder = folder_in("HOME");
        if (!folder) return std::nullopt;
        *folder /= ".cache";
    }
    return *folder / "vkcppm" / fmt::format("{}-{}.pipelines", info.uuid, hash_text(fnv1a_of(info.driver + version())));
}

std::string sealed(std::span<const std::byte> bytes) {
    const std::string_view body(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::uint64_t hash = fnv1a_of(body);
    std::string text(mark);
    text.append(reinterpret_cast<const char*>(&hash), sizeof(hash));
    return text.append(body);
}

std::optional<std::vector<std::byte>> unsealed(std::string_view text) {
    std::uint64_t hash = 0;
    if (!text.starts_with(mark) || text.size() < mark.size() + sizeof(hash)) return std::nullopt;
    std::memcpy(&hash, text.data() + mark.size(), sizeof(hash));
    const std::string_view body = text.substr(mark.size() + sizeof(hash));
    if (fnv1a_of(body) != hash) return std::nullopt;
    const auto* first = reinterpret_cast<const std::byte*>(body.data());
    return std::vector<std::byte>(first, first + body.size());
}

PipelineCache::PipelineCache(Device& device, bool on) : device_(device) {
    if (!on) return;
    file_ = pipeline_file(device.info());
    if (!file_) return;
    std::ifstream stream(*file_, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    if (const auto bytes = unsealed(text); bytes && device.reuse_pipelines(*bytes)) known_ = *bytes;
}

PipelineCache::~PipelineCache() {
    if (!file_) return;
    try {
        const std::vector<std::byte> bytes = device_.pipelines();
        if (bytes.size() <= header_bytes || bytes == known_) return;
        std::error_code ignored;
        fs::create_directories(file_->parent_path(), ignored);
        write_file(*file_, sealed(bytes));
    } catch (const std::exception&) {
        // The next run compiles again.
    }
}

}  // namespace vkcppm
