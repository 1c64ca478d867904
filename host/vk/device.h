#pragma once
// A Vulkan device with one compute queue, opaque to everything outside host/vk.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "vk/binding.h"
#include "vk/policy.h"

namespace vkcppm {

/// One physical device, as `vkcppm devices` lists it.
struct DeviceInfo {
    std::uint32_t index = 0;
    std::string name;
    DeviceType type = DeviceType::other;
    std::string driver;              // name and version
    std::string api_version;         // "1.3.230"
    std::string uuid;                // 32 hexadecimal digits in 8-4-4-4-12 form
    std::uint64_t memory_bytes = 0;  // that buffers can have; of software Vulkan the host's memory
    std::string unusable;            // empty, or why the device cannot run the kernels
    bool first_choice = false;       // it is used where none is asked for
    std::string policy;              // how it is driven, in a line
};

/// What of Vulkan is installed beside the drivers.
struct VulkanInfo {
    std::string loader;  // version of the loader; empty: there is none
    bool has_validation_layer = false;
};
VulkanInfo vulkan_info();

/// What to install where there is no driver, a line.
inline constexpr const char* driver_advice =
    "install mesa-vulkan-drivers (Debian, Ubuntu, Fedora) or vulkan-swrast (Arch), which need no graphics card";

/// All devices of all drivers, usable or not; empty where there is no Vulkan loader or driver. Throws Error(usage)
/// where VKCPPM_POLICY is no way to drive a device.
std::vector<DeviceInfo> list_devices();

class Device {
public:
    struct Options {
        std::string select;     // name (substring), index or "uuid:..."; empty: the fastest kind that is usable
        bool validate = false;  // load the validation layer with synchronization checks; its errors are collected
        bool cache = true;      // compiled kernels may be kept from run to run (app/pipeline_cache.h)
    };
    /// Throws Error(no_device) where none is usable or none matches, with the devices that there are, and Error(usage)
    /// where VKCPPM_POLICY is no way to drive it.
    explicit Device(const Options& options);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const DeviceInfo& info() const;
    /// Messages of the validation layer so far, errors and warnings; empty where it is not loaded.
    std::vector<std::string> validation_messages() const;
    /// True where the validation layer was asked for and is loaded.
    bool validating() const;
    const DevicePolicy& policy() const;
    /// Bytes of the largest buffer of that access: what is but read as texels may be larger than what is bound as a
    /// storage buffer.
    std::uint64_t largest_buffer(Access access) const;
    /// Bytes of buffers alive now, and at most so far.
    std::uint64_t allocated_bytes() const;
    std::uint64_t peak_bytes() const;

    /// Pipelines as pipelines() gave them in an earlier run: kernels that are among them need not be compiled. False,
    /// and nothing else, where their header is not this device's and this driver's. Before the first kernel.
    bool reuse_pipelines(std::span<const std::byte> data);
    /// What the driver wants to have again: a header of 32 bytes, and behind it what it kept, which may be nothing.
    std::vector<std::byte> pipelines() const;

    struct Impl;
    Impl& impl() { return *impl_; }

private:
    std::unique_ptr<Impl> impl_;
};

}  // namespace vkcppm
