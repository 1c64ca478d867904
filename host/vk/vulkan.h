#pragma once
// vulkan.hpp and what only host/vk knows: included by host/vk/*.cpp alone.

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <vulkan/vulkan_raii.hpp>

#include "core/error.h"
#include "vk/device.h"

namespace vkcppm {

struct Device::Impl {
    DeviceInfo info;
    vk::raii::Context context;
    std::optional<vk::raii::Instance> instance;
    std::optional<vk::raii::DebugUtilsMessengerEXT> messenger;
    std::optional<vk::raii::PhysicalDevice> physical;
    std::optional<vk::raii::Device> device;
    std::optional<vk::raii::Queue> queue;
    std::optional<vk::raii::CommandPool> pool;
    std::optional<vk::raii::PipelineCache> pipelines;
    vk::PhysicalDeviceLimits limits;
    vk::PhysicalDeviceMemoryProperties memory;
    std::uint32_t subgroup_size = 1;
    bool loop_limit = false;      // a driver that stops all loops of a SIMD group after 65,535 trips
    std::uint64_t allocated = 0;  // bytes of live buffers
    std::uint64_t peak = 0;
    mutable std::mutex messages_mutex;
    std::vector<std::string> messages;
};

/// Runs `work` and turns Vulkan's exceptions into Error: lost device, memory, anything else internal.
/// `doing` completes the line: "Vulkan failed while <doing>".
void guarded(const std::string& doing, const std::function<void()>& work);

/// Records commands, submits them and waits for the end.
void run_once(Device& device, const std::string& doing, const std::function<void(vk::raii::CommandBuffer&)>& record);

}  // namespace vkcppm
