#pragma once
// What a device must have, and how it is driven. Both follow from what its driver says of it, and from nothing else:
// nobody asks elsewhere what kind of device it is. Without Vulkan, so that a table of published limits can stand for
// devices that are not there.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vkcppm {

/// In the order in which they are preferred.
enum class DeviceType { discrete, integrated, virtual_gpu, other, cpu };

/// "discrete", "integrated", "virtual", "other", "cpu".
const char* name_of(DeviceType type);

/// A type of memory as Vulkan numbers them. What is neither device local nor mappable, or has a further property, is
/// not used.
struct MemoryType {
    std::uint32_t heap = 0;
    bool device_local = false;
    bool mappable = false;  // seen by the host, and coherent
    bool cached = false;    // what is mapped of it the host reads as fast as any memory
    bool special = false;   // protected, or allocated late: not for buffers
};

/// What a device promises of lanes that went apart: nothing, that they are together again behind a branch to which all
/// came together, or wherever it looks so in the source (vk/reconvergence.h).
enum class Reconvergence { none, uniform, maximal };

/// What a driver says of a device.
struct DeviceFacts {
    DeviceType type = DeviceType::other;
    std::uint32_t version_major = 1;  // of Vulkan
    std::uint32_t version_minor = 0;
    bool llvmpipe = false;  // by its driver
    bool scalar_block_layout = false;
    bool ballots = false;  // of subgroups, in compute shaders
    std::uint32_t subgroup_size = 1;
    std::uint32_t storage_buffers = 0;  // a stage and set
    std::uint32_t texel_buffers = 0;    // a stage and set
    std::uint32_t uniform_buffers = 0;  // a stage and set
    std::uint32_t resources = 0;        // a stage, of all kinds
    std::uint32_t group_invocations = 0;
    std::uint32_t push_constant_bytes = 0;
    std::uint64_t texels = 0;          // of a texel buffer
    std::uint64_t storage_bytes = 0;   // of a storage buffer
    std::uint64_t uniform_bytes = 0;   // of a uniform buffer
    bool computes = false;             // it has a queue for kernels
    Reconvergence reconvergence{};     // the strongest promise
    std::vector<std::uint64_t> heaps;  // bytes
    std::vector<MemoryType> memory;
};

/// Most buffers that any kernel has of a kind (shaders/shared/buffers.h).
struct KernelNeeds {
    std::uint32_t uniform = 1, storage = 10, texels = 19;
    std::uint32_t as_storage = 27;  // storage, where texels are storage as well
};
inline constexpr KernelNeeds kernel_needs;

/// Why the kernels cannot run on a device, with what they need of it; empty where they can.
std::string lacking(const DeviceFacts& facts);

/// The two ways to drive a device: one whose kernels run on this processor, and one that is a card of its own or like
/// one.
enum class Way { cpu, gpu };

/// How a device is driven. No choice of these changes a bit of a picture.
struct DevicePolicy {
    Way way = Way::gpu;
    bool forced = false;  // by VKCPPM_POLICY

    /// Types of memory in which buffers are tried, one after the other.
    std::vector<std::uint32_t> buffer_memory;
    /// The same of what goes between the host and buffers that are not mapped, in both directions.
    std::vector<std::uint32_t> staging_memory;
    /// Buffers in memory that the host sees are mapped, and written and read without a copy.
    bool maps_buffers = false;
    /// Bytes that buffers can have in all: of the heaps that they are tried in.
    std::uint64_t memory_bytes = 0;
    /// That memory is the host's, and no more of it is there than the host has left.
    bool memory_of_host = false;

    /// Kernels read as storage what they read elsewhere as texels, of which the device allows too few in a buffer or
    /// too few buffers (vk/texels.h).
    bool texels_as_storage = false;

    /// What loops compute is handed on lane by lane (vk/loops.h): asked for where texels are storage, for it is there
    /// that SwiftShader's pictures were wrong without.
    bool closes_loops = false;

    /// One descriptor set has all buffers, else a kernel has one of its own with what it uses. Mesa 22.3's lavapipe
    /// compiles kernels again, for the parameters of the moment, where a set was bound since their last launch: `eye`
    /// takes 1.2 times as long if that is before every launch and not once a submission.
    bool one_set = true;

    /// Invocations that keep the device busy: work with a choice is cut into about as many.
    std::uint32_t busy_lanes = 0;
    /// Photons to be sorted by one invocation, and at most so many invocations, powers of two. A run is gone through
    /// one by one, and every invocation has a histogram.
    std::uint32_t sort_run = 0;
    std::uint32_t most_sort_lanes = 0;
    /// Lanes of the photon pass share the light paths of their SIMD group, which takes that they come together again.
    bool deals_paths = false;
    /// What kernels with ballots ask of the device.
    Reconvergence reconvergence = Reconvergence::none;
    /// Kernels are compiled in several forms of which the fastest is found.
    bool tries_forms = false;
    /// Loop trips that one invocation may make in one dispatch, with certainty within the driver's limits.
    std::uint32_t step_budget = 0;
};

/// threads: of the host. forced: another way than the device's own; only what is fast changes, not what is possible.
DevicePolicy policy_of(const DeviceFacts& facts, std::uint32_t threads, std::optional<Way> forced = std::nullopt);

/// A line that tells it.
std::string text_of(const DevicePolicy& policy);

/// What the environment's VKCPPM_POLICY asks for. Throws Error(usage) where that is no way.
std::optional<Way> asked_way();

}  // namespace vkcppm
