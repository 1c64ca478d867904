#include "vk/buffer.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>

#include <fmt/format.h>

#include "vk/buffer_impl.h"

namespace vkcppm {
namespace {

/// Memory that is mapped but not cached is read some tens of MB a second where it lies on a card: beyond so many bytes,
/// a copy on the device is faster.
constexpr std::size_t read_uncached = 4096;
constexpr std::uint64_t most_staged = 1u << 24;  // bytes of a copy; more goes in several

vk::BufferUsageFlags usage_of(Access access, bool texels_as_storage) {
    using Usage = vk::BufferUsageFlagBits;
    const vk::BufferUsageFlags transfer = Usage::eTransferSrc | Usage::eTransferDst;
    if (texels_as_storage && has_texels(access)) return transfer | Usage::eStorageBuffer;
    switch (access) {
        case Access::uniform: return transfer | Usage::eUniformBuffer;
        case Access::storage: return transfer | Usage::eStorageBuffer | Usage::eIndirectBuffer;
        case Access::uint_texels:
        case Access::float_texels:
        case Access::word_texels: return transfer | Usage::eUniformTexelBuffer;
        case Access::records:
        case Access::words: return transfer | Usage::eUniformTexelBuffer | Usage::eStorageBuffer;
    }
    return transfer;
}

/// The format of the texels; none where the buffer is not read as texels.
std::optional<vk::Format> texel_format(Access access) {
    switch (access) {
        case Access::uniform:
        case Access::storage: return std::nullopt;
        case Access::uint_texels:
        case Access::records: return vk::Format::eR32G32B32A32Uint;
        case Access::float_texels: return vk::Format::eR32G32B32A32Sfloat;
        case Access::word_texels:
        case Access::words: return vk::Format::eR32Uint;
    }
    return std::nullopt;
}

void check_limits(const Buffer::Impl& buffer) {
    const std::uint64_t most = buffer.device->largest_buffer(buffer.access);
    if (buffer.bytes <= most) return;
    throw Error(ExitCode::out_of_device_memory,
                fmt::format("buffer '{}' needs {} bytes, the device '{}' allows {}", buffer.name, buffer.bytes,
                            buffer.device->info().name, most));
}

/// The types of memory for a buffer in whose heaps so much is left. Some drivers, lavapipe for one, promise more memory
/// than there is, and the system ends the program that believes them.
std::vector<std::uint32_t> types_with_room(const Buffer::Impl& buffer) {
    const Device::Impl& device = buffer.device->impl();
    std::vector<std::uint32_t> types = device.policy.buffer_memory;
    std::erase_if(types, [&](std::uint32_t type) {
        const std::uint32_t heap = device.facts.memory[type].heap;
        const std::uint64_t size = device.facts.heaps[heap];
        return buffer.bytes > size - std::min(size, device.heap_in_use[heap]);
    });
    if (!types.empty()) return types;
    throw Error(ExitCode::out_of_device_memory,
                fmt::format("buffer '{}' needs {} bytes beside {} in use, the memory of the device '{}' has {}",
                            buffer.name, buffer.bytes, device.allocated, device.info.name, device.info.memory_bytes));
}

struct Allocation {
    vk::raii::DeviceMemory memory;
    std::uint32_t type;
};

/// Memory of the first of `types` that can be had: one may be full long before the others, as the window is through
/// which the host sees the memory of some cards.
Allocation allocate(Device::Impl& device, const vk::raii::Buffer& buffer, const std::vector<std::uint32_t>& types) {
    const auto needed = buffer.getMemoryRequirements();
    std::optional<vk::OutOfDeviceMemoryError> full;
    for (const std::uint32_t type : types) {
        if (!(needed.memoryTypeBits >> type & 1)) continue;
        try {
            return {vk::raii::DeviceMemory(*device.device, vk::MemoryAllocateInfo(needed.size, type)), type};
        } catch (const vk::OutOfDeviceMemoryError& error) {
            full = error;
        }
    }
    if (full) throw *full;
    throw Error(ExitCode::internal, "the device has no memory type for buffers");
}

/// The device's staging buffer, with room for so many bytes; it grows, and is kept.
Device::Impl::Staging& staging_for(Device::Impl& device, std::uint64_t bytes) {
    Device::Impl::Staging& staging = device.staging;
    if (staging.bytes >= bytes) return staging;
    staging = {};
    const std::uint64_t size = std::bit_ceil(bytes);
    using Usage = vk::BufferUsageFlagBits;
    vk::raii::Buffer buffer(*device.device, vk::BufferCreateInfo({}, size, Usage::eTransferSrc | Usage::eTransferDst));
    Allocation allocation = allocate(device, buffer, device.policy.staging_memory);
    buffer.bindMemory(*allocation.memory, 0);
    name_object(device, buffer, "staging");
    auto* mapped = static_cast<std::byte*>(allocation.memory.mapMemory(0, VK_WHOLE_SIZE));
    staging.memory.emplace(std::move(allocation.memory));
    staging.buffer.emplace(std::move(buffer));
    staging.mapped = mapped;
    staging.bytes = size;
    return staging;
}

/// Calls copy(staging, from, bytes) for all of `bytes`, a piece at a time.
template <typename Copy> void through_staging(Device& device, std::uint64_t bytes, Copy copy) {
    guarded("copying through a staging buffer", [&] {
        for (std::uint64_t from = 0; from < bytes; from += most_staged) {
            const std::uint64_t piece = std::min(bytes - from, most_staged);
            copy(staging_for(device.impl(), piece), from, piece);
        }
    });
}

/// Copies on the device, and waits for it.
void copy_buffer(Device& device, vk::Buffer from, vk::Buffer to, vk::BufferCopy region) {
    run_once(device, "copying through a staging buffer",
             [&](vk::raii::CommandBuffer& commands) { commands.copyBuffer(from, to, region); });
}

}  // namespace

Buffer::Buffer(Device& device, Binding binding, std::uint64_t bytes) : impl_(std::make_unique<Impl>()) {
    Impl& impl = *impl_;
    auto& gpu = device.impl();
    impl.device = &device;
    impl.name = bound_buffer(binding).name;
    std::ranges::replace(impl.name, '_', ' ');
    impl.bytes = (std::max<std::uint64_t>(bytes, 16) + 15) / 16 * 16;  // whole texels
    impl.access = bound_buffer(binding).access;
    check_limits(impl);
    const std::vector<std::uint32_t> types = types_with_room(impl);
    guarded(
        fmt::format("allocating buffer '{}' of {} bytes ({} bytes are allocated)", impl.name, impl.bytes,
                    gpu.allocated),
        [&] {
            const bool as_storage = gpu.policy.texels_as_storage;
            impl.buffer.emplace(*gpu.device, vk::BufferCreateInfo({}, impl.bytes, usage_of(impl.access, as_storage)));
            Allocation allocation = allocate(gpu, *impl.buffer, types);
            const MemoryType& type = gpu.facts.memory[allocation.type];
            impl.heap = type.heap;
            impl.memory.emplace(std::move(allocation.memory));
            gpu.allocated += impl.bytes;
            gpu.heap_in_use[impl.heap] += impl.bytes;
            gpu.peak = std::max(gpu.peak, gpu.allocated);
            impl.buffer->bindMemory(**impl.memory, 0);
            name_object(gpu, *impl.buffer, impl.name);
            if (gpu.policy.maps_buffers && type.mappable) {
                impl.mapped = static_cast<std::byte*>(impl.memory->mapMemory(0, VK_WHOLE_SIZE));
                impl.cached = type.cached;
            }
            if (const auto format = texel_format(impl.access); format && !as_storage) {
                impl.view.emplace(*gpu.device, vk::BufferViewCreateInfo({}, **impl.buffer, *format, 0, VK_WHOLE_SIZE));
            }
        });
    if (impl.mapped) {
        std::memset(impl.mapped, 0, impl.bytes);
    } else {
        run_once(device, "clearing a buffer",
                 [&](vk::raii::CommandBuffer& commands) { commands.fillBuffer(**impl.buffer, 0, VK_WHOLE_SIZE, 0); });
    }
}

Buffer::~Buffer() = default;
Buffer::Buffer(Buffer&&) noexcept = default;
Buffer& Buffer::operator=(Buffer&&) noexcept = default;

std::uint64_t Buffer::bytes() const { return impl_->bytes; }

void Buffer::write(std::span<const std::byte> data, std::uint64_t offset) {
    assert(offset + data.size() <= impl_->bytes);
    if (data.empty()) return;
    if (impl_->mapped) {
        std::memcpy(impl_->mapped + offset, data.data(), data.size());
        return;
    }
    through_staging(*impl_->device, data.size(), [&](auto& staging, std::uint64_t from, std::uint64_t bytes) {
        std::memcpy(staging.mapped, data.data() + from, bytes);
        copy_buffer(*impl_->device, **staging.buffer, **impl_->buffer, {0, offset + from, bytes});
    });
}

void Buffer::read(std::span<std::byte> data, std::uint64_t offset) const {
    assert(offset + data.size() <= impl_->bytes);
    if (data.empty()) return;
    if (impl_->mapped && (impl_->cached || data.size() <= read_uncached)) {
        std::memcpy(data.data(), impl_->mapped + offset, data.size());
        return;
    }
    through_staging(*impl_->device, data.size(), [&](auto& staging, std::uint64_t from, std::uint64_t bytes) {
        copy_buffer(*impl_->device, **impl_->buffer, **staging.buffer, {offset + from, 0, bytes});
        std::memcpy(data.data() + from, staging.mapped, bytes);
    });
}

}  // namespace vkcppm
