#include "vk/device.h"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/process.h"
#include "shared/types.h"
#include "vk/binding.h"
#include "vk/device_impl.h"
#include "vk/reconvergence.h"

namespace vkcppm {
namespace {

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";
/// What all features of one member look like, those of extensions that the headers do not know, too.
struct PromiseFeature {
    VkStructureType type{};
    void* next = nullptr;
    VkBool32 on = false;
};

constexpr const char* portability_subset = "VK_KHR_portability_subset";  // its macro is in vulkan_beta.h alone

bool has(const std::vector<vk::ExtensionProperties>& extensions, const char* name) {
    return std::ranges::any_of(extensions, [&](const auto& e) { return std::strcmp(e.extensionName, name) == 0; });
}

vk::raii::Instance make_instance(const vk::raii::Context& context, bool validate) {
    vk::ApplicationInfo application("vkcppm", 1, nullptr, 0, VK_API_VERSION_1_2);
    std::vector<const char*> layers, extensions;
    const vk::ValidationFeatureEnableEXT enable = vk::ValidationFeatureEnableEXT::eSynchronizationValidation;
    const vk::ValidationFeaturesEXT features(enable);
    vk::InstanceCreateInfo info({}, &application);
    const auto offered = context.enumerateInstanceExtensionProperties();
    if (validate) {
        layers.push_back(validation_layer);
        info.pNext = &features;
    }
    if (validate || has(offered, VK_EXT_DEBUG_UTILS_EXTENSION_NAME)) {
        extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    }
    // Without it drivers over another interface, such as MoltenVK, are not listed.
    if (has(offered, VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME)) {
        extensions.push_back(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);
        info.flags |= vk::InstanceCreateFlagBits::eEnumeratePortabilityKHR;
    }
    info.setPEnabledLayerNames(layers).setPEnabledExtensionNames(extensions);
    return vk::raii::Instance(context, info);
}

std::string version_text(std::uint32_t version) {
    return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                       VK_API_VERSION_PATCH(version));
}

DeviceType type_of(vk::PhysicalDeviceType type) {
    switch (type) {
        case vk::PhysicalDeviceType::eDiscreteGpu: return DeviceType::discrete;
        case vk::PhysicalDeviceType::eIntegratedGpu: return DeviceType::integrated;
        case vk::PhysicalDeviceType::eVirtualGpu: return DeviceType::virtual_gpu;
        case vk::PhysicalDeviceType::eCpu: return DeviceType::cpu;
        default: return DeviceType::other;
    }
}

/// A queue for kernels, if there is one with time stamps.
std::optional<std::uint32_t> compute_family(const vk::raii::PhysicalDevice& physical) {
    const auto families = physical.getQueueFamilyProperties();
    std::optional<std::uint32_t> first;
    for (std::uint32_t i = 0; i < families.size(); ++i) {
        if (!(families[i].queueFlags & vk::QueueFlagBits::eCompute)) continue;
        if (families[i].timestampValidBits > 0) return i;
        if (!first) first = i;
    }
    return first;
}

/// Heaps and types of memory.
void add_memory(DeviceFacts& facts, const vk::raii::PhysicalDevice& physical) {
    using Memory = vk::MemoryPropertyFlagBits;
    constexpr vk::MemoryPropertyFlags mappable = Memory::eHostVisible | Memory::eHostCoherent;
    constexpr vk::MemoryPropertyFlags known = Memory::eDeviceLocal | mappable | Memory::eHostCached;
    const auto memory = physical.getMemoryProperties();
    for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i) {
        // The memory of software Vulkan is the host's, but Mesa 22.3 says that of every machine.
        constexpr std::uint64_t said_of_all = std::uint64_t(2) << 30;
        const std::uint64_t said = memory.memoryHeaps[i].size;
        facts.heaps.push_back(facts.type == DeviceType::cpu && said == said_of_all ? total_memory() : said);
    }
    for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
        const vk::MemoryPropertyFlags has = memory.memoryTypes[i].propertyFlags;
        facts.memory.push_back({.heap = memory.memoryTypes[i].heapIndex,
                                .device_local = bool(has & Memory::eDeviceLocal),
                                .mappable = (has & mappable) == mappable,
                                .cached = bool(has & Memory::eHostCached),
                                .special = bool(has & ~known)});
    }
}

/// The strongest promise of convergence that the device has a feature for.
Reconvergence promised_by(const vk::raii::PhysicalDevice& physical) {
    const auto extensions = physical.enumerateDeviceExtensionProperties();
    for (const Promise& promise : promises) {
        if (!has(extensions, promise.extension)) continue;
        PromiseFeature feature{VkStructureType(promise.feature_type)};
        VkPhysicalDeviceFeatures2 all{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &feature, {}};
        physical.getDispatcher()->vkGetPhysicalDeviceFeatures2(*physical, &all);
        if (feature.on) return promise.of;
    }
    return Reconvergence::none;
}

DeviceFacts facts_of(const vk::raii::PhysicalDevice& physical) {
    DeviceFacts facts;
    const auto properties = physical.getProperties();
    const auto& limits = properties.limits;
    facts.type = type_of(properties.deviceType);
    facts.version_major = VK_API_VERSION_MAJOR(properties.apiVersion);
    facts.version_minor = VK_API_VERSION_MINOR(properties.apiVersion);
    facts.storage_buffers = std::min(limits.maxPerStageDescriptorStorageBuffers, limits.maxDescriptorSetStorageBuffers);
    facts.texel_buffers = std::min(limits.maxPerStageDescriptorSampledImages, limits.maxDescriptorSetSampledImages);
    facts.uniform_buffers = std::min(limits.maxPerStageDescriptorUniformBuffers, limits.maxDescriptorSetUniformBuffers);
    facts.resources = limits.maxPerStageResources;
    facts.group_invocations = std::min(limits.maxComputeWorkGroupInvocations, limits.maxComputeWorkGroupSize[0]);
    facts.push_constant_bytes = limits.maxPushConstantsSize;
    facts.texels = limits.maxTexelBufferElements;
    facts.storage_bytes = limits.maxStorageBufferRange;
    facts.uniform_bytes = limits.maxUniformBufferRange;
    facts.computes = compute_family(physical).has_value();
    add_memory(facts, physical);
    if (properties.apiVersion < VK_API_VERSION_1_2) return facts;  // it knows nothing of what follows
    const auto features = physical.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features>();
    facts.scalar_block_layout = features.get<vk::PhysicalDeviceVulkan12Features>().scalarBlockLayout;
    const auto chain = physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceSubgroupProperties,
                                               vk::PhysicalDeviceDriverProperties>();
    const auto& subgroup = chain.get<vk::PhysicalDeviceSubgroupProperties>();
    facts.ballots = (subgroup.supportedStages & vk::ShaderStageFlagBits::eCompute) &&
                    (subgroup.supportedOperations & vk::SubgroupFeatureFlagBits::eBallot);
    facts.subgroup_size = subgroup.subgroupSize;
    facts.llvmpipe = chain.get<vk::PhysicalDeviceDriverProperties>().driverID == vk::DriverId::eMesaLlvmpipe;
    facts.reconvergence = promised_by(physical);
    return facts;
}

std::string uuid_text(const vk::ArrayWrapper1D<uint8_t, VK_UUID_SIZE>& uuid) {
    std::string text;
    for (std::size_t i = 0; i < VK_UUID_SIZE; ++i) {
        if (i == 4 || i == 6 || i == 8 || i == 10) text += '-';
        text += fmt::format("{:02x}", uuid[i]);
    }
    return text;
}

/// A physical device, what it says of itself and how it is driven.
struct Found {
    vk::raii::PhysicalDevice physical;
    DeviceFacts facts;
    DevicePolicy policy;
    DeviceInfo info;
};

Found describe(vk::raii::PhysicalDevice physical, std::uint32_t index, std::optional<Way> way) {
    const auto chain = physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceIDProperties,
                                               vk::PhysicalDeviceDriverProperties>();
    const auto& properties = chain.get<vk::PhysicalDeviceProperties2>().properties;
    const auto& driver = chain.get<vk::PhysicalDeviceDriverProperties>();
    DeviceFacts facts = facts_of(physical);
    DevicePolicy policy = policy_of(facts, std::thread::hardware_concurrency(), way);
    DeviceInfo info;
    info.index = index;
    info.name = properties.deviceName.data();
    info.type = facts.type;
    info.driver = fmt::format("{} {}", driver.driverName.data(), driver.driverInfo.data());
    info.api_version = version_text(properties.apiVersion);
    info.uuid = uuid_text(chain.get<vk::PhysicalDeviceIDProperties>().deviceUUID);
    info.memory_bytes = policy.memory_bytes;
    info.unusable = lacking(facts);
    info.policy = text_of(policy);
    return {std::move(physical), std::move(facts), std::move(policy), std::move(info)};
}

/// All physical devices; none where there is no driver.
std::vector<Found> enumerate(const vk::raii::Instance& instance, std::optional<Way> way) {
    std::vector<Found> found;
    try {
        vk::raii::PhysicalDevices all(instance);
        for (std::uint32_t i = 0; i < all.size(); ++i) found.push_back(describe(std::move(all[i]), i, way));
    } catch (const vk::SystemError&) {
        // A loader without a driver answers with an error: that is a machine without devices.
    }
    return found;
}

/// Of those that can be used the first of the fastest kind, or the end.
std::vector<Found>::iterator best_of(std::vector<Found>& devices) {
    const auto rank = [](const Found& device) { return std::pair(!device.info.unusable.empty(), device.facts.type); };
    const auto best = std::ranges::min_element(devices, {}, rank);
    return best == devices.end() || best->info.unusable.empty() ? best : devices.end();
}

bool matches(const DeviceInfo& info, const std::string& select) {
    if (select.starts_with("uuid:")) return info.uuid == select.substr(5);
    std::uint32_t index = 0;
    const auto [end, error] = std::from_chars(select.data(), select.data() + select.size(), index);
    if (error == std::errc() && end == select.data() + select.size()) return info.index == index;
    return info.name.find(select) != std::string::npos;
}

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    auto& impl = *static_cast<Device::Impl*>(user);
    std::lock_guard lock(impl.messages_mutex);
    impl.messages.emplace_back(data->pMessage);
    return VK_FALSE;
}

}  // namespace

const Device::Impl::Layout& layout_of(Device::Impl& device, const std::vector<std::uint32_t>& used) {
    std::vector<std::uint32_t> bindings = used;
    if (device.policy.one_set) {
        bindings.clear();
        for (const BoundBuffer& row : bound_buffers) {
            const auto binding = std::uint32_t(row.binding);
            if (row.access == Access::uniform || has_storage(row.access)) bindings.push_back(binding);
            if (has_texels(row.access)) bindings.push_back(TEXELS_BINDING + binding);
        }
    }
    const auto found = device.layouts.find(bindings);
    if (found != device.layouts.end()) return found->second;
    std::vector<vk::DescriptorSetLayoutBinding> rows;
    for (const std::uint32_t binding : bindings) {
        const bool uniform = binding < TEXELS_BINDING && bound_buffer(Binding(binding)).access == Access::uniform;
        const vk::DescriptorType type = binding >= TEXELS_BINDING ? vk::DescriptorType::eUniformTexelBuffer
                                        : uniform                 ? vk::DescriptorType::eUniformBuffer
                                                                  : vk::DescriptorType::eStorageBuffer;
        rows.emplace_back(binding, type, 1, vk::ShaderStageFlagBits::eCompute);
    }
    vk::raii::DescriptorSetLayout set(*device.device, vk::DescriptorSetLayoutCreateInfo({}, rows));
    const vk::DescriptorSetLayout sets = *set;
    const vk::PushConstantRange push(vk::ShaderStageFlagBits::eCompute, 0, sizeof(gpu::Launch));
    vk::raii::PipelineLayout pipeline(*device.device, vk::PipelineLayoutCreateInfo({}, sets, push));
    Device::Impl::Layout layout{std::move(rows), std::move(set), std::move(pipeline)};
    return device.layouts.emplace(bindings, std::move(layout)).first->second;
}

void guarded(const std::string& doing, const std::function<void()>& work) {
    try {
        work();
    } catch (const vk::DeviceLostError&) {
        throw Error(ExitCode::device_lost, fmt::format("the device was lost while {}", doing));
    } catch (const vk::OutOfDeviceMemoryError&) {
        throw Error(ExitCode::out_of_device_memory, fmt::format("out of device memory while {}", doing));
    } catch (const vk::OutOfHostMemoryError&) {
        throw Error(ExitCode::out_of_device_memory, fmt::format("out of host memory while {}", doing));
    } catch (const vk::SystemError& error) {
        throw Error(ExitCode::internal, fmt::format("Vulkan failed while {}: {}", doing, error.what()));
    }
}

void run_once(Device& device, const std::string& doing, const std::function<void(vk::raii::CommandBuffer&)>& record) {
    guarded(doing, [&] {
        auto& impl = device.impl();
        auto& commands = *impl.transfers;
        commands.reset();
        commands.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
        record(commands);
        using Stage = vk::PipelineStageFlagBits;
        using Access = vk::AccessFlagBits;
        const vk::MemoryBarrier barrier(Access::eTransferWrite, Access::eHostRead | Access::eUniformRead |
                                                                    Access::eShaderRead | Access::eShaderWrite |
                                                                    Access::eIndirectCommandRead |
                                                                    Access::eTransferRead | Access::eTransferWrite);
        commands.pipelineBarrier(Stage::eTransfer,
                                 Stage::eHost | Stage::eComputeShader | Stage::eDrawIndirect | Stage::eTransfer, {},
                                 barrier, {}, {});
        commands.end();
        const vk::CommandBuffer raw = *commands;
        impl.queue->submit(vk::SubmitInfo({}, {}, raw), **impl.transferred);
        if (impl.device->waitForFences(**impl.transferred, true, UINT64_MAX) != vk::Result::eSuccess) {
            throw Error(ExitCode::device_lost, fmt::format("the device did not finish while {}", doing));
        }
        impl.device->resetFences(**impl.transferred);
    });
}

VulkanInfo vulkan_info() {
    VulkanInfo info;
    try {
        const vk::raii::Context context;
        info.loader = version_text(context.enumerateInstanceVersion());
        info.has_validation_layer = std::ranges::any_of(
            context.enumerateInstanceLayerProperties(),
            [](const vk::LayerProperties& layer) { return std::strcmp(layer.layerName, validation_layer) == 0; });
    } catch (const std::exception&) {
        // No Vulkan loader.
    }
    return info;
}

std::vector<DeviceInfo> list_devices() {
    std::vector<DeviceInfo> list;
    const std::optional<Way> way = asked_way();
    try {
        vk::raii::Context context;
        const vk::raii::Instance instance = make_instance(context, false);
        std::vector<Found> devices = enumerate(instance, way);
        if (const auto best = best_of(devices); best != devices.end()) best->info.first_choice = true;
        for (const Found& device : devices) list.push_back(device.info);
    } catch (const std::exception&) {
        // No Vulkan loader: no devices.
    }
    return list;
}

Device::Device(const Options& options) : impl_(std::make_unique<Impl>()) {
    Impl& impl = *impl_;
    const std::optional<Way> way = asked_way();
    try {
        impl.instance.emplace(make_instance(impl.context, options.validate));
    } catch (const vk::LayerNotPresentError&) {
        throw Error(ExitCode::no_device,
                    fmt::format("validation was asked for but {} is not installed", validation_layer));
    } catch (const vk::SystemError& error) {
        throw Error(ExitCode::no_device, fmt::format("no Vulkan instance: {}; {}", error.what(), driver_advice));
    }
    if (options.validate) {
        using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
        using Type = vk::DebugUtilsMessageTypeFlagBitsEXT;
        impl.messenger.emplace(*impl.instance, vk::DebugUtilsMessengerCreateInfoEXT(
                                                   {}, Severity::eWarning | Severity::eError,
                                                   Type::eValidation | Type::ePerformance, on_message, &impl));
    }

    auto devices = enumerate(*impl.instance, way);
    std::vector<std::string> names;
    for (const Found& device : devices) {
        const DeviceInfo& info = device.info;
        names.push_back(info.unusable.empty()
                            ? fmt::format("{} '{}'", info.index, info.name)
                            : fmt::format("{} '{}' (unusable: {})", info.index, info.name, info.unusable));
    }
    std::erase_if(
        devices, [&](const Found& device) { return !options.select.empty() && !matches(device.info, options.select); });
    const auto best = best_of(devices);
    if (best == devices.end()) {
        const std::string wanted = options.select.empty() ? "" : fmt::format(" that matches '{}'", options.select);
        throw Error(ExitCode::no_device, fmt::format("no usable Vulkan device{}; there are: {}", wanted,
                                                     names.empty() ? fmt::format("none; {}", driver_advice)
                                                                   : fmt::format("{}", fmt::join(names, ", "))));
    }
    impl.physical.emplace(std::move(best->physical));
    impl.info = best->info;
    impl.facts = best->facts;
    impl.policy = best->policy;
    impl.limits = impl.physical->getProperties().limits;
    impl.heap_in_use.resize(impl.facts.heaps.size());

    guarded("creating the device", [&] {
        const std::uint32_t family = *compute_family(*impl.physical);
        impl.stamp_bits = impl.physical->getQueueFamilyProperties()[family].timestampValidBits;
        const float priority = 1.0f;
        const vk::DeviceQueueCreateInfo queue({}, family, 1, &priority);
        vk::PhysicalDeviceVulkan12Features features;
        features.scalarBlockLayout = true;
        std::vector<const char*> extensions;  // a driver that has this one wants it asked for
        if (has(impl.physical->enumerateDeviceExtensionProperties(), portability_subset)) {
            extensions.push_back(portability_subset);
        }
        PromiseFeature feature{};
        for (const Promise& promise : promises) {
            if (promise.of != impl.policy.reconvergence) continue;
            feature = {VkStructureType(promise.feature_type), nullptr, true};
            features.pNext = &feature;
            extensions.push_back(promise.extension);
        }
        // Lanes that are switched off may fetch a texel behind the end. A load from storage may not, but for this.
        vk::PhysicalDeviceFeatures core;
        core.robustBufferAccess = impl.policy.texels_as_storage;
        vk::DeviceCreateInfo info({}, queue, {}, extensions, &core);
        info.pNext = &features;
        impl.device.emplace(*impl.physical, info);
        impl.queue.emplace(*impl.device, family, 0);
        impl.pool.emplace(*impl.device,
                          vk::CommandPoolCreateInfo(vk::CommandPoolCreateFlagBits::eResetCommandBuffer, family));
        vk::raii::CommandBuffers buffers(*impl.device, {**impl.pool, vk::CommandBufferLevel::ePrimary, 1});
        impl.transfers.emplace(std::move(buffers.front()));
        impl.transferred.emplace(*impl.device, vk::FenceCreateInfo());
        impl.pipelines.emplace(*impl.device, vk::PipelineCacheCreateInfo());
    });
}

Device::~Device() = default;

const DeviceInfo& Device::info() const { return impl_->info; }

std::vector<std::string> Device::validation_messages() const {
    std::lock_guard lock(impl_->messages_mutex);
    return impl_->messages;
}

bool Device::validating() const { return impl_->messenger.has_value(); }

const DevicePolicy& Device::policy() const { return impl_->policy; }

std::uint64_t Device::largest_buffer(Access access) const {
    const DeviceFacts& facts = impl_->facts;
    std::uint64_t bytes = std::numeric_limits<std::uint64_t>::max();
    if (access == Access::uniform) bytes = facts.uniform_bytes;
    const bool as_storage = policy().texels_as_storage;
    if (has_storage(access) || (has_texels(access) && as_storage)) bytes = facts.storage_bytes;
    if (has_texels(access) && !as_storage) bytes = std::min(bytes, facts.texels * texel_bytes(access));
    return bytes;
}

bool Device::reuse_pipelines(std::span<const std::byte> data) {
    // Drivers should look themselves, and some crash.
    VkPipelineCacheHeaderVersionOne header{};
    if (data.size() < sizeof(header)) return false;
    std::memcpy(&header, data.data(), sizeof(header));
    assert(impl_->made.empty());
    const auto properties = impl_->physical->getProperties();
    const bool ours = header.headerSize == sizeof(header) &&
                      header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE &&
                      header.vendorID == properties.vendorID && header.deviceID == properties.deviceID &&
                      std::ranges::equal(header.pipelineCacheUUID, properties.pipelineCacheUUID);
    if (!ours) return false;
    guarded("reading pipelines of an earlier run", [&] {
        impl_->pipelines.emplace(*impl_->device, vk::PipelineCacheCreateInfo({}, data.size(), data.data()));
    });
    return true;
}

std::vector<std::byte> Device::pipelines() const {
    std::vector<std::uint8_t> data;
    guarded("asking for pipelines", [&] { data = impl_->pipelines->getData(); });
    const auto bytes = std::as_bytes(std::span(data));
    return {bytes.begin(), bytes.end()};
}

std::uint64_t Device::allocated_bytes() const { return impl_->allocated; }
std::uint64_t Device::peak_bytes() const { return impl_->peak; }

}  // namespace vkcppm
