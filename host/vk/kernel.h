#pragma once
// Compute pipelines over the buffers of shaders/shared/buffers.h, and launches of them.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "shared/types.h"
#include "vk/buffer.h"
#include "vk/fold.h"

namespace vkcppm {

class Device;

/// Which buffer stands at which binding, several times over. Their descriptor sets are made at the first launch that
/// needs them. Rebinding needs an idle device.
class Bindings {
public:
    explicit Bindings(Device& device, std::uint32_t sets = 1);
    ~Bindings();
    Bindings(const Bindings&) = delete;
    Bindings& operator=(const Bindings&) = delete;

    std::uint32_t sets() const;

    /// Binds it in every set or in one. Asserts that the buffer was made
    /// for a binding of that access. It must outlive every launch.
    void bind(Binding binding, const Buffer& buffer);
    void bind(Binding binding, const Buffer& buffer, std::uint32_t set);

    struct Impl;
    Impl& impl() const { return *impl_; }

private:
    std::unique_ptr<Impl> impl_;
};

class Kernel {
public:
    /// `spirv` is a module of shaders/kernels or tests/kernels. `specialization` must hold SPEC_WORKGROUP. Compiles it,
    /// folded to that, but where the device has compiled the same before.
    Kernel(Device& device, std::string name, std::span<const std::uint32_t> spirv,
           const Specialization& specialization);
    ~Kernel();
    Kernel(Kernel&&) noexcept;
    Kernel& operator=(Kernel&&) noexcept;

    const std::string& name() const;

    struct Impl;
    const Impl& impl() const { return *impl_; }

private:
    std::unique_ptr<Impl> impl_;
};

/// Device time of one launch of a kernel, by timestamps: from the end of the launch before it, or the begin of all, to
/// its own. Where the device has none: an equal share of the time that the host waited for all.
struct Timing {
    const Kernel* kernel = nullptr;
    double seconds = 0.0;
};

/// A sequence of launches, each after the one before it is done and visible.
class Commands {
public:
    Commands(Device& device, const Bindings& bindings);
    ~Commands();
    Commands(const Commands&) = delete;
    Commands& operator=(const Commands&) = delete;

    /// Launches that follow are with the first set of buffers, until use() names another.
    void begin();
    void use(std::uint32_t set);
    /// At least `invocations` invocations in whole work groups, folded into y beyond the device's limit of x.
    void launch(const Kernel& kernel, std::uint64_t invocations, const gpu::Launch& push);
    /// As many work groups as three words of `groups` from byte `offset` say when it is due, none where the first is 0.
    void launch_indirect(const Kernel& kernel, const Buffer& groups, std::uint64_t offset, const gpu::Launch& push);
    /// Submits what was recorded since begin() and waits for it: every launch in order. Throws Error(device_lost).
    std::vector<Timing> finish();

private:
    template <typename Dispatch> void record(const Kernel& kernel, const gpu::Launch& push, Dispatch dispatch);
    void stamp();
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vkcppm
