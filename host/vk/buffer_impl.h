#pragma once
// What the other files of host/vk need to know of a Buffer.

#include "vk/buffer.h"
#include "vk/device_impl.h"

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
    bool cached = false;          // what is mapped is read as fast as any memory of the host

    ~Impl() {
        if (memory) device->impl().allocated -= bytes;
    }
};

}  // namespace vkcppm
