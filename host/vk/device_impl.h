#pragma once
// vulkan.hpp and what the other files of host/vk need to know of a Device: included by host/vk alone.

#include <functional>
#include <map>
#include <memory>
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
    std::optional<vk::raii::CommandBuffer> transfers;  // of run_once()
    std::optional<vk::raii::Fence> transferred;
    /// What goes between the host and buffers that are not mapped.
    struct Staging {
        std::optional<vk::raii::DeviceMemory> memory;
        std::optional<vk::raii::Buffer> buffer;
        std::byte* mapped = nullptr;
        std::uint64_t bytes = 0;
    };
    Staging staging;
    std::optional<vk::raii::PipelineCache> pipelines;
    /// Of a set with what a kernel uses, or with all buffers (DevicePolicy::one_set).
    struct Layout {
        std::vector<vk::DescriptorSetLayoutBinding> bindings;
        vk::raii::DescriptorSetLayout set;
        vk::raii::PipelineLayout pipeline;
    };
    std::map<std::vector<std::uint32_t>, Layout> layouts;  // by its bindings
    struct Pipeline {
        const Layout* layout = nullptr;
        std::optional<vk::raii::Pipeline> pipeline;
    };
    // By the hash of the words and the specialization. Kernels that agree in them share a pipeline: integrators of one
    // scene differ in a few kernels alone.
    std::map<std::pair<std::uint64_t, std::map<std::uint32_t, std::uint32_t>>, std::shared_ptr<Pipeline>> made;
    DeviceFacts facts;
    DevicePolicy policy;
    vk::PhysicalDeviceLimits limits;
    std::uint32_t stamp_bits = 64;           // of time stamps, that count; 0: there are none
    std::uint64_t allocated = 0;             // bytes of live buffers
    std::vector<std::uint64_t> heap_in_use;  // the same of each heap
    std::uint64_t peak = 0;
    mutable std::mutex messages_mutex;
    std::vector<std::string> messages;
};

/// The layout for a kernel with those bindings; made where no kernel had it before.
const Device::Impl::Layout& layout_of(Device::Impl& device, const std::vector<std::uint32_t>& bindings);

/// Runs `work` and turns Vulkan's exceptions into Error: lost device, memory, anything else internal.
/// `doing` completes the line: "Vulkan failed while <doing>".
void guarded(const std::string& doing, const std::function<void()>& work);

/// Records commands, submits them and waits for the end. What they transferred is there for the host, for
/// kernels and for further transfers.
void run_once(Device& device, const std::string& doing, const std::function<void(vk::raii::CommandBuffer&)>& record);

/// Gives a Vulkan object the name by which debuggers, profilers and the validation layer tell it, where
/// VK_EXT_debug_utils is there.
template <typename Object> void name_object(Device::Impl& device, const Object& object, const std::string& name) {
    if (!device.device->getDispatcher()->vkSetDebugUtilsObjectNameEXT) return;
    const auto handle = (std::uint64_t)(typename Object::CType)(*object);  // a pointer, or a number on 32 bits
    device.device->setDebugUtilsObjectNameEXT({Object::objectType, handle, name.c_str()});
}

}  // namespace vkcppm
