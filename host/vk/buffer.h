#pragma once
// Device memory with a name. Data goes in and out by value; through a staging copy where the memory is not mapped, or
// slow to read. Sizes of data are the program's own, so that one that does not fit asserts: what a file says of a size
// is looked at by its reader (Integrator::restore).

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "vk/binding.h"

namespace vkcppm {

class Device;

class Buffer {
public:
    /// A buffer for that binding: at least `bytes` bytes of zeros (an empty buffer holds 16) in the device's memory,
    /// mapped where the host sees it and there is room. Throws Error(out_of_device_memory) with the name, the size and
    /// the limit where it is larger than the device allows or than there is memory for.
    Buffer(Device& device, Binding binding, std::uint64_t bytes);
    ~Buffer();
    Buffer(Buffer&&) noexcept;
    Buffer& operator=(Buffer&&) noexcept;

    std::uint64_t bytes() const;

    /// Writes `data` from byte `offset` on. Asserts that it fits. The device must be idle.
    template <typename T> void upload(std::span<const T> data, std::uint64_t offset = 0) {
        write(std::as_bytes(data), offset);
    }
    template <typename T> void upload(const std::vector<T>& data) { upload(std::span<const T>(data)); }
    template <typename T> void upload_value(const T& value) { write(std::as_bytes(std::span<const T>(&value, 1)), 0); }

    /// Reads `count` values from byte `offset` on. Asserts that there are as many. The device must be idle.
    template <typename T> std::vector<T> download(std::size_t count, std::uint64_t offset = 0) const {
        std::vector<T> data(count);
        download_to(std::span<T>(data), offset);
        return data;
    }
    template <typename T> void download_to(std::span<T> data, std::uint64_t offset = 0) const {
        read(std::as_writable_bytes(data), offset);
    }
    template <typename T> T download_value() const { return download<T>(1).front(); }

    struct Impl;
    const Impl& impl() const { return *impl_; }

private:
    void write(std::span<const std::byte> data, std::uint64_t offset);
    void read(std::span<std::byte> data, std::uint64_t offset) const;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vkcppm
