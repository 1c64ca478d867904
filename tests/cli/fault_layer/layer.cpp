// A Vulkan layer that makes the device another one, as the environment says:
//   VKCPPM_FAULT="vkQueueSubmit 3 -4"   the third call of the function and all after it return that VkResult
//   VKCPPM_FAULT="heap 0 67108864"      every heap of memory has that many bytes
//   VKCPPM_FAULT="full 3 65536"         from the third submission on there is room for so many bytes at once, no more
//   VKCPPM_FAULT="window 0 65536"       a card of its own: its memory is not seen by the host, but for a window that is
//                                       full once so many bytes were allocated in it; 0: there is no window
// The program under test is the one that users have: it knows nothing of this.

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <map>
#include <sstream>
#include <string>

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

namespace {

struct Fault {
    std::string function;
    int first = 1;        // call that fails, or the last submission before memory is full
    long long value = 0;  // VkResult, or bytes
    int calls = 0;

    Fault() {
        const char* text = std::getenv("VKCPPM_FAULT");
        std::istringstream(text ? text : "") >> function >> first >> value;
    }
    bool strikes(const char* name) { return function == name && ++calls >= first; }
};

Fault fault;
PFN_vkGetInstanceProcAddr next_instance_function = nullptr;  // of the one instance and the one device
PFN_vkGetDeviceProcAddr next_device_function = nullptr;
PFN_vkGetPhysicalDeviceMemoryProperties next_memory_properties = nullptr;
VkDevice the_device = VK_NULL_HANDLE;
std::map<std::uint32_t, std::uint32_t> real_types;  // memory types of a card of its own to the driver's
std::uint32_t window_types = 0;                     // a bit each
VkDeviceSize in_window = 0;                         // bytes
int submissions = 0;

/// The loader's link to the next layer in the chain of a create info; takes it out of the chain.
template <typename Link, typename Info> auto* take_link(const Info* info, VkStructureType type) {
    auto* link = static_cast<Link*>(const_cast<void*>(info->pNext));
    while (link->sType != type || link->function != VK_LAYER_LINK_INFO) {
        link = static_cast<Link*>(const_cast<void*>(link->pNext));
    }
    auto* found = link->u.pLayerInfo;
    link->u.pLayerInfo = found->pNext;
    return found;
}

VkResult create_instance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
                         VkInstance* instance) {
    next_instance_function = take_link<VkLayerInstanceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO)
                                 ->pfnNextGetInstanceProcAddr;
    const auto create =
        reinterpret_cast<PFN_vkCreateInstance>(next_instance_function(VK_NULL_HANDLE, "vkCreateInstance"));
    const VkResult result = create(info, allocator, instance);
    // Now: once the loader knows this layer's functions it answers with them.
    next_memory_properties = reinterpret_cast<PFN_vkGetPhysicalDeviceMemoryProperties>(
        next_instance_function(*instance, "vkGetPhysicalDeviceMemoryProperties"));
    return result;
}

VkResult create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                       const VkAllocationCallbacks* allocator, VkDevice* device) {
    const auto* link = take_link<VkLayerDeviceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    next_device_function = link->pfnNextGetDeviceProcAddr;
    const auto create =
        reinterpret_cast<PFN_vkCreateDevice>(link->pfnNextGetInstanceProcAddr(VK_NULL_HANDLE, "vkCreateDevice"));
    const VkResult result = create(physical, info, allocator, device);
    the_device = *device;
    return result;
}

template <typename Function> Function next(const char* name) {
    return reinterpret_cast<Function>(next_device_function(the_device, name));
}

VkResult queue_submit(VkQueue queue, std::uint32_t count, const VkSubmitInfo* submits, VkFence fence) {
    ++submissions;
    if (fault.strikes("vkQueueSubmit")) return VkResult(fault.value);
    return next<PFN_vkQueueSubmit>("vkQueueSubmit")(queue, count, submits, fence);
}

VkResult wait_for_fences(VkDevice device, std::uint32_t count, const VkFence* fences, VkBool32 all,
                         std::uint64_t time) {
    const VkResult result = next<PFN_vkWaitForFences>("vkWaitForFences")(device, count, fences, all, time);
    return fault.strikes("vkWaitForFences") ? VkResult(fault.value) : result;
}

VkResult allocate_memory(VkDevice device, const VkMemoryAllocateInfo* info, const VkAllocationCallbacks* allocator,
                         VkDeviceMemory* memory) {
    if (fault.strikes("vkAllocateMemory")) return VkResult(fault.value);
    if (fault.function == "full" && submissions >= fault.first && info->allocationSize > VkDeviceSize(fault.value)) {
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    if (window_types >> info->memoryTypeIndex & 1) {
        in_window += info->allocationSize;
        if (in_window > VkDeviceSize(fault.value)) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    VkMemoryAllocateInfo real = *info;
    if (const auto type = real_types.find(info->memoryTypeIndex); type != real_types.end()) {
        real.memoryTypeIndex = type->second;
    }
    return next<PFN_vkAllocateMemory>("vkAllocateMemory")(device, &real, allocator, memory);
}

void get_buffer_memory_requirements(VkDevice device, VkBuffer buffer, VkMemoryRequirements* needed) {
    next<PFN_vkGetBufferMemoryRequirements>("vkGetBufferMemoryRequirements")(device, buffer, needed);
    for (const auto& [type, real] : real_types) needed->memoryTypeBits |= (needed->memoryTypeBits >> real & 1) << type;
}

VkResult create_compute_pipelines(VkDevice device, VkPipelineCache cache, std::uint32_t count,
                                  const VkComputePipelineCreateInfo* infos, const VkAllocationCallbacks* allocator,
                                  VkPipeline* pipelines) {
    if (fault.strikes("vkCreateComputePipelines")) return VkResult(fault.value);
    return next<PFN_vkCreateComputePipelines>("vkCreateComputePipelines")(device, cache, count, infos, allocator,
                                                                          pipelines);
}

/// Hides from the host what is both the device's and the host's, and adds a type for the window and one of the host.
void make_card(VkPhysicalDeviceMemoryProperties& memory) {
    constexpr VkMemoryPropertyFlags mapped = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    constexpr VkMemoryPropertyFlags local = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    const std::uint32_t count = memory.memoryTypeCount;
    for (std::uint32_t i = 0; i < count; ++i) {
        VkMemoryType& own = memory.memoryTypes[i];
        if ((own.propertyFlags & (local | mapped)) != (local | mapped)) continue;
        own.propertyFlags = local;
        const auto add = [&](VkMemoryPropertyFlags properties) {
            real_types[memory.memoryTypeCount] = i;
            memory.memoryTypes[memory.memoryTypeCount++] = {properties, own.heapIndex};
        };
        if (fault.value > 0) {
            window_types |= 1u << memory.memoryTypeCount;
            add(local | mapped);
        }
        add(mapped | VK_MEMORY_PROPERTY_HOST_CACHED_BIT);
    }
}

void get_memory_properties(VkPhysicalDevice physical, VkPhysicalDeviceMemoryProperties* memory) {
    next_memory_properties(physical, memory);
    for (std::uint32_t i = 0; fault.function == "heap" && i < memory->memoryHeapCount; ++i) {
        memory->memoryHeaps[i].size = VkDeviceSize(fault.value);
    }
    if (fault.function == "window") make_card(*memory);
}

/// The layer's own function of that name, or null.
PFN_vkVoidFunction own_function(const char* name) {
    const auto is = [&](const char* other) { return std::strcmp(name, other) == 0; };
    if (is("vkCreateInstance")) return reinterpret_cast<PFN_vkVoidFunction>(create_instance);
    if (is("vkCreateDevice")) return reinterpret_cast<PFN_vkVoidFunction>(create_device);
    if (is("vkGetPhysicalDeviceMemoryProperties")) return reinterpret_cast<PFN_vkVoidFunction>(get_memory_properties);
    if (is("vkQueueSubmit")) return reinterpret_cast<PFN_vkVoidFunction>(queue_submit);
    if (is("vkWaitForFences")) return reinterpret_cast<PFN_vkVoidFunction>(wait_for_fences);
    if (is("vkAllocateMemory")) return reinterpret_cast<PFN_vkVoidFunction>(allocate_memory);
    if (is("vkGetBufferMemoryRequirements")) {
        return reinterpret_cast<PFN_vkVoidFunction>(get_buffer_memory_requirements);
    }
    if (is("vkCreateComputePipelines")) return reinterpret_cast<PFN_vkVoidFunction>(create_compute_pipelines);
    return nullptr;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) PFN_vkVoidFunction VKAPI_CALL vkGetDeviceProcAddr(VkDevice device,
                                                                                                    const char* name) {
    if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(vkGetDeviceProcAddr);
    const PFN_vkVoidFunction own = own_function(name);
    return own ? own : next_device_function(device, name);
}

extern "C" __attribute__((visibility("default"))) PFN_vkVoidFunction VKAPI_CALL
vkGetInstanceProcAddr(VkInstance instance, const char* name) {
    if (std::strcmp(name, "vkGetInstanceProcAddr") == 0) {
        return reinterpret_cast<PFN_vkVoidFunction>(vkGetInstanceProcAddr);
    }
    if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(vkGetDeviceProcAddr);
    const PFN_vkVoidFunction own = own_function(name);
    if (own || !next_instance_function) return own;  // the loader asks for some before there is an instance
    return next_instance_function(instance, name);
}
