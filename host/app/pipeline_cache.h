#pragma once
// Compiled kernels from run to run, for drivers that do not keep them by themselves.

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vk/device.h"

namespace vkcppm {

class PipelineCache {
public:
    /// Hands the device the pipelines that an earlier run left for it and its driver. A file that is absent, damaged or
    /// of another driver is as good as none. Keeps a reference to the device. `on` false: does nothing, here and at the
    /// end.
    PipelineCache(Device& device, bool on);

    /// Writes what the driver would have again, where that is new. A place that takes no file is no error.
    ~PipelineCache();

    PipelineCache(const PipelineCache&) = delete;
    PipelineCache& operator=(const PipelineCache&) = delete;

private:
    Device& device_;
    std::optional<std::filesystem::path> file_;
    std::vector<std::byte> known_;
};

/// The file for that device, its driver and this version: in $XDG_CACHE_HOME/vkcppm, else in $HOME/.cache/vkcppm. None
/// where neither is an absolute path.
std::optional<std::filesystem::path> pipeline_file(const DeviceInfo& info);

/// The bytes behind a mark and their FNV-1a hash, which tell damage.
std::string sealed(std::span<const std::byte> bytes);

/// What was sealed; none where the text is anything else.
std::optional<std::vector<std::byte>> unsealed(std::string_view text);

}  // namespace vkcppm
