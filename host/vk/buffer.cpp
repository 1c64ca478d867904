#include "vk/buffer.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <initializer_list>

#include <fmt/format.h>

#include "vk/buffer_impl.h"

namespace vkcppm {
namespace {

using Memory = vk::MemoryPropertyFlagBits;

constexpr vk::MemoryPropertyFlags mappable = Memory::eHostVisible | Memory::eHostCoherent;
/// Memory that is mapped but not cached is read some tens of MB a second where it lies on a card: beyond so many bytes,
/// a copy on the device is faster.
constexpr std::size_t read_uncached = 4096;

vk::BufferUsageFlags usage_of(Access access) {
    using Usage = vk::BufferUsageFlagBits;
    const vk::BufferUsageFlags transfer = Usage::eTransferSrc | Usage::eTransferDst;
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

/// Some drivers, lavapipe for one, promise more memory than there is, and the system ends the program that believes
/// them.
void check_heap(const Buffer::Impl& buffer) {
    const Device::Impl& device = buffer.device->impl();
    if (buffer.bytes <= device.info.memory_bytes - std::min(device.info.memory_bytes, device.allocated)) return;
    throw Error(ExitCode::out_of_device_memory,
                fmt::format("buffer '{}' needs {} bytes beside {} in use, the memory of the device '{}' has {}",
                            buffer.name, buffer.bytes, device.allocated, device.info.name, device.info.memory_bytes));
}

struct Allocation {
    vk::raii::DeviceMemory memory;
    vk::MemoryPropertyFlags properties;
};

/// Memory for `buffer` with the properties of the first wish that can be had: a type of memory may be absent, or full
/// long before the others, as the window is through which the host sees the memory of some cards.
Allocation allocate(Device::Impl& device, const vk::raii::Buffer& buffer,
                    std::initializer_list<vk::MemoryPropertyFlags> wishes) {
    const vk::MemoryPropertyFlags known = Memory::eDeviceLocal | mappable | Memory::eHostCached;  // others are special
    const auto needed = buffer.getMemoryRequirements();
    std::uint32_t untried = needed.memoryTypeBits;
    std::optional<vk::OutOfDeviceMemoryError> full;
    for (const vk::MemoryPropertyFlags wish : wishes) {
        for (std::uint32_t i = 0; i < device.memory.memoryTypeCount; ++i) {
            const vk::MemoryPropertyFlags properties = device.memory.memoryTypes[i].propertyFlags;
            if (!(untried >> i & 1) || (properties & wish) != wish || (properties & ~known)) continue;
            untried &= ~(1u << i);
            try {
                return {vk::raii::DeviceMemory(*device.device, vk::MemoryAllocateInfo(needed.size, i)), properties};
            } catch (const vk::OutOfDeviceMemoryError& error) {
                full = error;
            }
        }
    }
    if (full) throw *full;
    throw Error(ExitCode::internal, "the device has no memory type for buffers");
}

/// A mapped buffer for one transfer. `before` and `after` run with its memory; `copy` records the transfer.
template <typename Before, typename Copy, typename After>
void through_staging(Device& device, std::uint64_t bytes, std::initializer_list<vk::MemoryPropertyFlags> wishes,
                     Before before, Copy copy, After after) {
    guarded("copying through a staging buffer", [&] {
        auto& impl = device.impl();
        vk::raii::Buffer staging(*impl.device, vk::BufferCreateInfo({}, bytes,
                                                                    vk::BufferUsageFlagBits::eTransferSrc |
                                                                        vk::BufferUsageFlagBits::eTransferDst));
        const Allocation allocation = allocate(impl, staging, wishes);
        staging.bindMemory(*allocation.memory, 0);
        auto* mapped = static_cast<std::byte*>(allocation.memory.mapMemory(0, bytes));
        before(mapped);
        run_once(device, "copying through a staging buffer",
                 [&](vk::raii::CommandBuffer& commands) { copy(commands, *staging); });
        after(mapped);
    });
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
    check_heap(impl);
    guarded(fmt::format("allocating buffer '{}' of {} bytes ({} bytes are allocated)", impl.name, impl.bytes,
                        gpu.allocated),
            [&] {
                impl.buffer.emplace(*gpu.device, vk::BufferCreateInfo({}, impl.bytes, usage_of(impl.access)));
                Allocation allocation =
                    allocate(gpu, *impl.buffer, {Memory::eDeviceLocal | mappable, Memory::eDeviceLocal});
                impl.memory.emplace(std::move(allocation.memory));
                gpu.allocated += impl.bytes;
                gpu.peak = std::max(gpu.peak, gpu.allocated);
                impl.buffer->bindMemory(**impl.memory, 0);
                name_object(gpu, *impl.buffer, impl.name);
                if ((allocation.properties & mappable) == mappable) {
                    impl.mapped = static_cast<std::byte*>(impl.memory->mapMemory(0, VK_WHOLE_SIZE));
                    impl.cached = bool(allocation.properties & Memory::eHostCached);
                }
                if (const auto format = texel_format(impl.access)) {
                    impl.view.emplace(*gpu.device,
                                      vk::BufferViewCreateInfo({}, **impl.buffer, *format, 0, VK_WHOLE_SIZE));
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
    through_staging(
        *impl_->device, data.size(), {mappable},
        [&](std::byte* memory) { std::memcpy(memory, data.data(), data.size()); },
        [&](vk::raii::CommandBuffer& commands, vk::Buffer staging) {
            commands.copyBuffer(staging, **impl_->buffer, vk::BufferCopy(0, offset, data.size()));
        },
        [](std::byte*) {});
}

void Buffer::read(std::span<std::byte> data, std::uint64_t offset) const {
    assert(offset + data.size() <= impl_->bytes);
    if (data.empty()) return;
    if (impl_->mapped && (impl_->cached || data.size() <= read_uncached)) {
        std::memcpy(data.data(), impl_->mapped + offset, data.size());
        return;
    }
    through_staging(
        *impl_->device, data.size(), {mappable | Memory::eHostCached, mappable}, [](std::byte*) {},
        [&](vk::raii::CommandBuffer& commands, vk::Buffer staging) {
            commands.copyBuffer(**impl_->buffer, staging, vk::BufferCopy(offset, 0, data.size()));
        },
        [&](const std::byte* memory) { std::memcpy(data.data(), memory, data.size()); });
}

}  // namespace vkcppm
