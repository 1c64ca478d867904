#pragma once
// What the other files of host/vk need to know of a Buffer.

#include "vk/buffer.h"
#include "vk/vulkan.h"

namespace vkcppm {

struct Buffer::Impl {
    Device* device = nullptr;
    std::string name;
    std::uint64_t bytes = 0;
    Access access = Access::storage;
    std::optional<vk::raii::DeviceMemory> memory;
    std::optional<vk::raii::Buffer> buffer;
    std::optional<vk::raii::BufferView> view;
    std::byte* mapped = nullptr;  // null where the memory is not host visible

    ~Impl() {
        if (memory) device->impl().allocated -= bytes;
    }
};

}  // namespace vkcppm
