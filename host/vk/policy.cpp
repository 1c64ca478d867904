#include "vk/policy.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "shared/types.h"
#include "vk/binding.h"

namespace vkcppm {
namespace {

constexpr const char* way_variable = "VKCPPM_POLICY";
constexpr const char* way_names[] = {"cpu", "gpu"};  // in the order of Way

/// The table of cells and light paths of a render at its defaults, `counters`, is 1.3 million texels.
constexpr std::uint64_t least_texels = 1u << 21;
constexpr std::uint64_t least_storage_bytes = 1u << 27;
constexpr std::uint32_t largest_group = 128;  // of forms_for() in host/render/kernel_choice.cpp

std::uint32_t bound(bool (*has)(Access)) {
    return std::uint32_t(std::ranges::count_if(bound_buffers, has, &BoundBuffer::access));
}

bool has_room_for_all(const DeviceFacts& facts) {
    const std::uint32_t storage = bound(has_storage), texels = bound(has_texels);
    return facts.storage_buffers >= storage && facts.texel_buffers >= texels &&
           facts.resources >= storage + texels + kernel_needs.uniform;
}

bool has_too_few_texels(const DeviceFacts& facts) {
    return facts.texels < least_texels || facts.texel_buffers < kernel_needs.texels;
}

std::uint64_t heap_bytes(const DeviceFacts& facts, std::uint32_t type) {
    return facts.heaps.at(facts.memory.at(type).heap);
}

/// Types of memory by how well they suit, the larger heap first among equals. rank: less is better, none: not at all.
template <typename Rank> std::vector<std::uint32_t> memory_by(const DeviceFacts& facts, Rank rank) {
    std::vector<std::uint32_t> types;
    for (std::uint32_t i = 0; i < facts.memory.size(); ++i) {
        if (!facts.memory[i].special && rank(facts.memory[i])) types.push_back(i);
    }
    std::ranges::stable_sort(types, [&](std::uint32_t a, std::uint32_t b) {
        const int left = *rank(facts.memory[a]), right = *rank(facts.memory[b]);
        return left != right ? left < right : heap_bytes(facts, a) > heap_bytes(facts, b);
    });
    return types;
}

/// True where the host sees the largest heap of the device's own: software Vulkan, integrated devices, and cards all of
/// whose memory is behind the window (resizable BAR). Of the others the window is some 256 MiB.
bool sees_the_largest_heap(const DeviceFacts& facts) {
    std::uint64_t largest = 0, seen = 0;
    for (std::uint32_t i = 0; i < facts.memory.size(); ++i) {
        const MemoryType& type = facts.memory[i];
        if (type.special || !type.device_local) continue;
        largest = std::max(largest, heap_bytes(facts, i));
        if (type.mappable) seen = std::max(seen, heap_bytes(facts, i));
    }
    return seen == largest && seen > 0;
}

}  // namespace

const char* name_of(DeviceType type) {
    constexpr const char* names[] = {"discrete", "integrated", "virtual", "other", "cpu"};
    return names[std::size_t(type)];
}

// All that is needed, each with what needs it.
std::string lacking(const DeviceFacts& facts) {
    const std::array version{facts.version_major, facts.version_minor};
    if (version < std::array{1u, 2u}) return "Vulkan 1.2 is needed";
    // Structs stand in buffers as the host has them.
    if (!facts.scalar_block_layout) return "scalarBlockLayout is needed";
    // The traversal goes on while any lane of a SIMD group needs it.
    if (!facts.ballots) return "subgroup ballots in compute shaders are needed";
    if (!facts.computes) return "a compute queue is needed";
    const bool as_storage = has_too_few_texels(facts);
    const std::uint32_t storage = as_storage ? kernel_needs.as_storage : kernel_needs.storage;
    if (facts.storage_buffers < storage) {
        const std::string why = as_storage ? fmt::format(", as {} texels in each of {} buffers are too few",
                                                         facts.texels, facts.texel_buffers)
                                           : "";
        return fmt::format("{} storage buffers a stage, {} are needed{}", facts.storage_buffers, storage, why);
    }
    if (facts.uniform_buffers < kernel_needs.uniform) {
        return fmt::format("{} uniform buffers a stage, {} are needed", facts.uniform_buffers, kernel_needs.uniform);
    }
    const std::uint32_t all = storage + kernel_needs.uniform + (as_storage ? 0 : kernel_needs.texels);
    if (facts.resources < all) return fmt::format("{} resources a stage, {} are needed", facts.resources, all);
    if (facts.storage_bytes < least_storage_bytes) {
        return fmt::format("{} bytes in a storage buffer, {} are needed", facts.storage_bytes, least_storage_bytes);
    }
    if (facts.uniform_bytes < sizeof(gpu::Params)) {
        return fmt::format("{} bytes in a uniform buffer, {} are needed", facts.uniform_bytes, sizeof(gpu::Params));
    }
    if (facts.group_invocations < largest_group) {
        return fmt::format("work groups of {}, {} are needed", facts.group_invocations, largest_group);
    }
    if (facts.push_constant_bytes < sizeof(gpu::Launch)) {
        return fmt::format("{} bytes of push constants, {} are needed", facts.push_constant_bytes, sizeof(gpu::Launch));
    }
    return "";
}

DevicePolicy policy_of(const DeviceFacts& facts, std::uint32_t threads, std::optional<Way> forced) {
    DevicePolicy policy;
    const bool is_cpu = facts.type == DeviceType::cpu;
    policy.way = forced.value_or(is_cpu ? Way::cpu : Way::gpu);
    policy.forced = forced.has_value();
    const bool cpu = policy.way == Way::cpu;

    policy.texels_as_storage = has_too_few_texels(facts);
    policy.closes_loops = policy.texels_as_storage;
    policy.one_set = !policy.texels_as_storage && has_room_for_all(facts);
    policy.maps_buffers = forced ? cpu : sees_the_largest_heap(facts);
    policy.buffer_memory = memory_by(facts, [&](const MemoryType& type) -> std::optional<int> {
        if (type.device_local) return type.mappable == policy.maps_buffers ? 0 : 1;
        // An integrated device reads the host's memory as it reads what is called its own, which may be little.
        if (type.mappable && facts.type == DeviceType::integrated) return 2;
        return std::nullopt;
    });
    policy.staging_memory = memory_by(facts, [](const MemoryType& type) -> std::optional<int> {
        if (!type.mappable) return std::nullopt;
        return (type.cached ? 0 : 2) + (type.device_local ? 1 : 0);
    });
    std::set<std::uint32_t> heaps;
    for (const std::uint32_t type : policy.buffer_memory) heaps.insert(facts.memory[type].heap);
    for (const std::uint32_t heap : heaps) policy.memory_bytes += facts.heaps.at(heap);
    policy.memory_of_host = is_cpu;

    // On a processor few, so that none is idle for long while the last of its SIMD group ends; enough work groups for
    // every core. On a card as many as are resident at once, for which every one has room for its photons.
    const bool large = facts.type == DeviceType::discrete || facts.type == DeviceType::cpu;
    policy.busy_lanes = cpu ? 512 * std::max(1u, threads) : large ? 1u << 17 : 1u << 15;
    policy.sort_run = cpu ? 128 : 32;
    policy.most_sort_lanes = cpu ? 1u << 12 : 1u << 14;
    policy.tries_forms = !cpu;
    // llvmpipe was measured without: its lanes are one vector, and the tests count the paths.
    if (!facts.llvmpipe) policy.reconvergence = facts.reconvergence;
    policy.deals_paths = policy.reconvergence != Reconvergence::none || (facts.llvmpipe && cpu);
    // llvmpipe of Mesa 22.3 ends every loop, in silence, once the loops of a SIMD group have made 65,535 trips in all.
    // A group's trips are at most the sum over its lanes; a kernel may overdraw its budget by a few hundred.
    // Elsewhere: counters of 16 bits of the gather never overflow in a dispatch.
    policy.step_budget = facts.llvmpipe ? 65535 / facts.subgroup_size - 1024 : 65535 - 1024;
    return policy;
}

std::string text_of(const DevicePolicy& policy) {
    return fmt::format("{}{}: buffers {}{}, {} lanes, {}, {} steps", way_names[std::size_t(policy.way)],
                       policy.forced ? fmt::format(" ({})", way_variable) : "",
                       policy.maps_buffers ? "mapped" : "through staging copies",
                       policy.texels_as_storage ? ", texels as storage" : "", policy.busy_lanes,
                       policy.tries_forms ? "forms of kernels tried" : "one form of kernels", policy.step_budget);
}

std::optional<Way> asked_way() {
    const char* value = std::getenv(way_variable);
    if (!value || !*value) return std::nullopt;
    const auto* found = std::ranges::find(way_names, std::string(value));
    if (found != std::end(way_names)) return Way(found - std::begin(way_names));
    throw Error(ExitCode::usage, fmt::format("{} is '{}'; it is cpu or gpu", way_variable, value));
}

}  // namespace vkcppm
