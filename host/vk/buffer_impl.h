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
    std::uint32_t heap = 0;
    std::byte* mapped = nullptr;  // null where the host goes through staging copies
    bool cached = false;          // what is mapped is read as fast as any memory of the host

    ~Impl() {
        if (!memory) return;
        device->impl().allocated -= bytes;
        device->impl().heap_in_use[heap] -= bytes;
    }
};

}  // namespace vkcppm
