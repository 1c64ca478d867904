// A Vulkan layer that makes the device another one, as the environment says, one thing after another with ; between:
//   VKCPPM_FAULT="vkQueueSubmit 3 -4"   the third call of the function and all after it return that VkResult
//   VKCPPM_FAULT="idle"                 what is submitted is done at once, for nothing of it is
//   VKCPPM_FAULT="heap 0 67108864"      every heap of memory has that many bytes
//   VKCPPM_FAULT="full 3 65536"         from the third submission on there is room for so many bytes at once, no more
//   VKCPPM_FAULT="card 0 268435456"     a card of its own: the host sees of its memory a window of so many bytes, or
//                                       with 0 none, and has memory of its own. The first number: bytes of the card's
//                                       memory beside the window; 0: as many as there are
//   VKCPPM_FAULT="stamps 0 36"          time stamps have so many bits and soon begin again at 0; 0: there are none
//   VKCPPM_FAULT="texels 0 65536"       texel buffers hold so many
//   VKCPPM_FAULT="statistics"           no fault: standard error gets what the driver's compiler says of each kernel
// The program under test is the one that users have: it knows nothing of this.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

namespace {

struct Fault {
    std::string what;
    long long first = 1;  // call that fails, or the last submission before memory is full, or bytes
    long long value = 0;  // VkResult, bytes, bits or texels
    int calls = 0;
};

struct Faults {
    std::vector<Fault> all;

    Faults() {
        const char* text = std::getenv("VKCPPM_FAULT");
        std::istringstream parts(text ? text : "");
        for (std::string part; std::getline(parts, part, ';');) {
            Fault fault;
            std::istringstream(part) >> fault.what >> fault.first >> fault.value;
            all.push_back(fault);
        }
    }
    /// The fault of that name, or null.
    Fault* find(const char* what) {
        const auto found = std::find_if(all.begin(), all.end(), [&](const Fault& f) { return f.what == what; });
        return found == all.end() ? nullptr : &*found;
    }
    /// The fault that strikes this call of a function, or null.
    Fault* strikes(const char* function) {
        Fault* fault = find(function);
        return fault && ++fault->calls >= fault->first ? fault : nullptr;
    }
};

Faults faults;
PFN_vkGetInstanceProcAddr next_instance_function = nullptr;  // of the newest instance: all of a process are alike
PFN_vkGetPhysicalDeviceMemoryProperties next_memory_properties = nullptr;
PFN_vkGetPhysicalDeviceProperties next_properties = nullptr;
PFN_vkGetPhysicalDeviceQueueFamilyProperties next_queue_families = nullptr;
struct NextDevice {
    VkDevice device = VK_NULL_HANDLE;
    PFN_vkGetDeviceProcAddr function = nullptr;
};
std::map<void*, NextDevice> devices;  // by what a device, and its queues, begin with
int submissions = 0;

void* key_of(const void* handle) { return *static_cast<void* const*>(handle); }

/// A type of memory of a card: which of the driver's it is, where all are one heap, and how much there is of it.
struct CardType {
    std::uint32_t real = 0;
    VkDeviceSize bytes = 0;
    bool mappable = false;
};
std::map<std::uint32_t, CardType> card_types;
struct CardMemory {
    std::uint32_t type = 0;
    VkDeviceSize bytes = 0;
};
std::map<VkDeviceMemory, CardMemory> card_memory;
std::uint64_t first_stamp = 0;

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
    const auto find = [&](auto& function, const char* name) {
        function =
            reinterpret_cast<std::remove_reference_t<decltype(function)>>(next_instance_function(*instance, name));
    };
    find(next_memory_properties, "vkGetPhysicalDeviceMemoryProperties");
    find(next_properties, "vkGetPhysicalDeviceProperties");
    find(next_queue_families, "vkGetPhysicalDeviceQueueFamilyProperties");
    return result;
}

VkResult create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                       const VkAllocationCallbacks* allocator, VkDevice* device) {
    const auto* link = take_link<VkLayerDeviceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    const PFN_vkGetDeviceProcAddr function = link->pfnNextGetDeviceProcAddr;
    const auto create =
        reinterpret_cast<PFN_vkCreateDevice>(link->pfnNextGetInstanceProcAddr(VK_NULL_HANDLE, "vkCreateDevice"));
    VkDeviceCreateInfo real = *info;
    std::vector<const char*> extensions(info->ppEnabledExtensionNames,
                                        info->ppEnabledExtensionNames + info->enabledExtensionCount);
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR statistics{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR, const_cast<void*>(info->pNext),
        VK_TRUE};
    if (faults.find("statistics")) {
        extensions.push_back(VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);
        real.enabledExtensionCount = std::uint32_t(extensions.size());
        real.ppEnabledExtensionNames = extensions.data();
        real.pNext = &statistics;
    }
    const VkResult result = create(physical, &real, allocator, device);
    if (result == VK_SUCCESS) devices[key_of(*device)] = {*device, function};
    return result;
}

/// The driver's function of that name, for a device or one of its queues.
template <typename Function> Function next(const void* handle, const char* name) {
    const NextDevice& of = devices.at(key_of(handle));
    return reinterpret_cast<Function>(of.function(of.device, name));
}

VkResult queue_submit(VkQueue queue, std::uint32_t count, const VkSubmitInfo* submits, VkFence fence) {
    ++submissions;
    if (const Fault* fault = faults.strikes("vkQueueSubmit")) return VkResult(fault->value);
    if (faults.find("idle")) count = 0;
    return next<PFN_vkQueueSubmit>(queue, "vkQueueSubmit")(queue, count, submits, fence);
}

VkResult wait_for_fences(VkDevice device, std::uint32_t count, const VkFence* fences, VkBool32 all,
                         std::uint64_t time) {
    const VkResult result = next<PFN_vkWaitForFences>(device, "vkWaitForFences")(device, count, fences, all, time);
    const Fault* fault = faults.strikes("vkWaitForFences");
    return fault ? VkResult(fault->value) : result;
}

VkResult allocate_memory(VkDevice device, const VkMemoryAllocateInfo* info, const VkAllocationCallbacks* allocator,
                         VkDeviceMemory* memory) {
    if (const Fault* fault = faults.strikes("vkAllocateMemory")) return VkResult(fault->value);
    const Fault* full = faults.find("full");
    if (full && submissions >= full->first && info->allocationSize > VkDeviceSize(full->value)) {
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    const auto type = card_types.find(info->memoryTypeIndex);
    VkMemoryAllocateInfo real = *info;
    if (type != card_types.end()) {
        VkDeviceSize in_use = 0;
        for (const auto& [other, card] : card_memory) in_use += card.type == type->first ? card.bytes : 0;
        if (in_use + info->allocationSize > type->second.bytes) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
        real.memoryTypeIndex = type->second.real;
    }
    const VkResult result = next<PFN_vkAllocateMemory>(device, "vkAllocateMemory")(device, &real, allocator, memory);
    if (result == VK_SUCCESS && type != card_types.end()) card_memory[*memory] = {type->first, info->allocationSize};
    return result;
}

void free_memory(VkDevice device, VkDeviceMemory memory, const VkAllocationCallbacks* allocator) {
    card_memory.erase(memory);
    next<PFN_vkFreeMemory>(device, "vkFreeMemory")(device, memory, allocator);
}

VkResult map_memory(VkDevice device, VkDeviceMemory memory, VkDeviceSize offset, VkDeviceSize size,
                    VkMemoryMapFlags flags, void** data) {
    const auto card = card_memory.find(memory);
    if (card != card_memory.end() && !card_types[card->second.type].mappable) return VK_ERROR_MEMORY_MAP_FAILED;
    return next<PFN_vkMapMemory>(device, "vkMapMemory")(device, memory, offset, size, flags, data);
}

void get_buffer_memory_requirements(VkDevice device, VkBuffer buffer, VkMemoryRequirements* needed) {
    next<PFN_vkGetBufferMemoryRequirements>(device, "vkGetBufferMemoryRequirements")(device, buffer, needed);
    const std::uint32_t real = needed->memoryTypeBits;
    for (const auto& [type, card] : card_types) needed->memoryTypeBits |= (real >> card.real & 1) << type;
}

/// A line for each of its executables: its name, and what is counted of it, with ; between.
void print_statistics(VkDevice device, VkPipeline pipeline, const char* name) {
    const VkPipelineInfoKHR of{VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR, nullptr, pipeline};
    const auto executables =
        next<PFN_vkGetPipelineExecutablePropertiesKHR>(device, "vkGetPipelineExecutablePropertiesKHR");
    const auto counted = next<PFN_vkGetPipelineExecutableStatisticsKHR>(device, "vkGetPipelineExecutableStatisticsKHR");
    std::uint32_t count = 0;
    executables(device, &of, &count, nullptr);
    for (std::uint32_t i = 0; i < count; ++i) {
        const VkPipelineExecutableInfoKHR one{VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR, nullptr, pipeline, i};
        std::uint32_t values = 0;
        counted(device, &one, &values, nullptr);
        VkPipelineExecutableStatisticKHR empty{};
        empty.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR;
        std::vector<VkPipelineExecutableStatisticKHR> all(values, empty);
        counted(device, &one, &values, all.data());
        std::ostringstream line;
        line << "statistics of " << name << ":";
        for (const VkPipelineExecutableStatisticKHR& each : all) {
            line << ' ' << each.name << '=';
            each.format == VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_FLOAT64_KHR ? line << each.value.f64
                                                                               : line << each.value.u64;
            line << ';';
        }
        std::cerr << line.str() + '\n';
    }
}

VkResult create_compute_pipelines(VkDevice device, VkPipelineCache cache, std::uint32_t count,
                                  const VkComputePipelineCreateInfo* infos, const VkAllocationCallbacks* allocator,
                                  VkPipeline* pipelines) {
    if (const Fault* fault = faults.strikes("vkCreateComputePipelines")) return VkResult(fault->value);
    std::vector<VkComputePipelineCreateInfo> real(infos, infos + count);
    if (faults.find("statistics")) {
        for (VkComputePipelineCreateInfo& info : real) info.flags |= VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
    }
    return next<PFN_vkCreateComputePipelines>(device, "vkCreateComputePipelines")(device, cache, count, real.data(),
                                                                                  allocator, pipelines);
}

/// The program names each pipeline once it is made.
VkResult set_object_name(VkDevice device, const VkDebugUtilsObjectNameInfoEXT* info) {
    if (faults.find("statistics") && info->objectType == VK_OBJECT_TYPE_PIPELINE) {
        print_statistics(device, VkPipeline(info->objectHandle), info->pObjectName);
    }
    const auto set = next<PFN_vkSetDebugUtilsObjectNameEXT>(device, "vkSetDebugUtilsObjectNameEXT");
    return set ? set(device, info) : VK_SUCCESS;
}

/// Hides from the host the memory that is both the device's and the host's, and adds memory of the host and a window.
void make_card(VkPhysicalDeviceMemoryProperties& memory, const Fault& fault) {
    constexpr VkMemoryPropertyFlags mapped = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    constexpr VkMemoryPropertyFlags local = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    const VkMemoryType* both = std::find_if(
        memory.memoryTypes, memory.memoryTypes + memory.memoryTypeCount,
        [](const VkMemoryType& type) { return (type.propertyFlags & (local | mapped)) == (local | mapped); });
    const auto real = std::uint32_t(both - memory.memoryTypes);
    if (real == memory.memoryTypeCount) return;
    const VkDeviceSize bytes = memory.memoryHeaps[both->heapIndex].size;
    card_types.clear();
    memory.memoryHeapCount = memory.memoryTypeCount = 0;
    const auto add = [&](VkMemoryPropertyFlags properties, VkDeviceSize size) {
        const VkMemoryHeapFlags flags = properties & local ? VK_MEMORY_HEAP_DEVICE_LOCAL_BIT : 0;
        memory.memoryHeaps[memory.memoryHeapCount] = {size, flags};
        card_types[memory.memoryTypeCount] = {real, size, (properties & mapped) != 0};
        memory.memoryTypes[memory.memoryTypeCount++] = {properties, memory.memoryHeapCount++};
    };
    add(local, fault.first > 0 ? VkDeviceSize(fault.first) : bytes);
    add(mapped, bytes);
    add(mapped | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, bytes);
    if (fault.value > 0) add(local | mapped, VkDeviceSize(fault.value));
}

void get_memory_properties(VkPhysicalDevice physical, VkPhysicalDeviceMemoryProperties* memory) {
    next_memory_properties(physical, memory);
    const Fault* heap = faults.find("heap");
    for (std::uint32_t i = 0; heap && i < memory->memoryHeapCount; ++i) {
        memory->memoryHeaps[i].size = VkDeviceSize(heap->value);
    }
    if (const Fault* card = faults.find("card")) make_card(*memory, *card);
}

void get_properties(VkPhysicalDevice physical, VkPhysicalDeviceProperties* properties) {
    next_properties(physical, properties);
    if (const Fault* texels = faults.find("texels")) {
        properties->limits.maxTexelBufferElements = std::uint32_t(texels->value);
    }
}

void get_queue_families(VkPhysicalDevice physical, std::uint32_t* count, VkQueueFamilyProperties* families) {
    next_queue_families(physical, count, families);
    const Fault* stamps = faults.find("stamps");
    for (std::uint32_t i = 0; stamps && families && i < *count; ++i) {
        families[i].timestampValidBits = std::uint32_t(stamps->value);
    }
}

VkResult create_query_pool(VkDevice device, const VkQueryPoolCreateInfo* info, const VkAllocationCallbacks* allocator,
                           VkQueryPool* pool) {
    const Fault* stamps = faults.find("stamps");
    if (stamps && stamps->value == 0) return VK_ERROR_INITIALIZATION_FAILED;
    return next<PFN_vkCreateQueryPool>(device, "vkCreateQueryPool")(device, info, allocator, pool);
}

/// The clock begins again 20 ms after the first stamp.
VkResult get_query_pool_results(VkDevice device, VkQueryPool pool, std::uint32_t first, std::uint32_t count,
                                std::size_t size, void* data, VkDeviceSize stride, VkQueryResultFlags flags) {
    const VkResult result = next<PFN_vkGetQueryPoolResults>(device, "vkGetQueryPoolResults")(device, pool, first, count,
                                                                                             size, data, stride, flags);
    const Fault* stamps = faults.find("stamps");
    auto* values = static_cast<std::uint64_t*>(data);
    if (!stamps || !(flags & VK_QUERY_RESULT_64_BIT) || stride != sizeof(*values)) return result;
    if (first_stamp == 0) first_stamp = values[0];
    const std::uint64_t valid = ~std::uint64_t(0) >> (64 - stamps->value);
    for (std::uint32_t i = 0; i < count; ++i) values[i] = (values[i] - first_stamp - 20'000'000) & valid;
    return result;
}

/// The layer's own function of that name, or null.
PFN_vkVoidFunction own_function(const char* name) {
    const auto is = [&](const char* other) { return std::strcmp(name, other) == 0; };
#define OWN(name, function) \
    if (is(name)) return reinterpret_cast<PFN_vkVoidFunction>(function);
    OWN("vkCreateInstance", create_instance)
    OWN("vkCreateDevice", create_device)
    OWN("vkGetPhysicalDeviceMemoryProperties", get_memory_properties)
    OWN("vkGetPhysicalDeviceProperties", get_properties)
    OWN("vkGetPhysicalDeviceQueueFamilyProperties", get_queue_families)
    OWN("vkQueueSubmit", queue_submit)
    OWN("vkWaitForFences", wait_for_fences)
    OWN("vkAllocateMemory", allocate_memory)
    OWN("vkFreeMemory", free_memory)
    OWN("vkMapMemory", map_memory)
    OWN("vkGetBufferMemoryRequirements", get_buffer_memory_requirements)
    OWN("vkCreateComputePipelines", create_compute_pipelines)
    OWN("vkSetDebugUtilsObjectNameEXT", set_object_name)
    OWN("vkCreateQueryPool", create_query_pool)
    OWN("vkGetQueryPoolResults", get_query_pool_results)
#undef OWN
    return nullptr;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) PFN_vkVoidFunction VKAPI_CALL vkGetDeviceProcAddr(VkDevice device,
                                                                                                    const char* name) {
    if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(vkGetDeviceProcAddr);
    const PFN_vkVoidFunction own = own_function(name);
    return own ? own : devices.at(key_of(device)).function(device, name);
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
