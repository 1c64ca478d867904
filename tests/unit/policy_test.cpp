// What a device must have, and how it is driven, by what drivers say of devices: limits that were published
// (gpuinfo.org, as profiles in KhronosGroup/Vulkan-Profiles; Turnip's are its source's), and memory as drivers arrange
// it.

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "support/files/variable.h"
#include "support/thrown.h"
#include "vk/policy.h"

namespace vkcppm {
namespace {

constexpr std::uint64_t mega = 1u << 20, giga = 1u << 30;

struct Published {
    const char* name;
    DeviceType type;
    std::uint32_t version_minor;  // of Vulkan 1
    std::uint32_t storage_buffers, texel_buffers, resources;
    std::uint64_t texels, storage_bytes;
    std::uint32_t subgroup_size, group_invocations, push_constant_bytes;
};

constexpr auto discrete = DeviceType::discrete, integrated = DeviceType::integrated;
constexpr std::uint32_t all = 0xffffffffu;
// clang-format off
const Published published[] = {
    {"NVIDIA RTX 5090, 610.43", discrete, 4, 1048576, 1048576, all, 268435456, all, 32, 1024, 256},
    {"NVIDIA RTX 4070, 551.61", discrete, 3, 1048576, 1048576, all, 134217728, all, 32, 1024, 256},
    {"NVIDIA RTX 2060, 525.47", discrete, 3, 1048576, 1048576, all, 134217728, all, 32, 1024, 256},
    {"NVIDIA GTX 650 Ti, 474.4", discrete, 2, 1048576, 1048576, all, 134217728, all, 32, 1536, 256},
    {"AMD RX 9070 XT, AMD's 2.0.395", discrete, 4, all, all, all, 2147483647, all, 64, 1024, 256},
    {"AMD RX 7800 XT, AMD's 2.0.294", discrete, 3, all, all, all, all, all, 64, 1024, 128},
    {"AMD RX 9070 XT, RADV 26.1", discrete, 4, 8388606, 8388606, 8388606, 536870912, all, 64, 1024, 256},
    {"AMD RX 580, RADV 23.1", discrete, 3, 8388606, 8388606, 8388606, all, all, 64, 1024, 256},
    {"Intel Arc B580, 406.632", discrete, 4, 33554432, 33554432, 33554432, 134217728, 1073741820, 32, 1024, 256},
    {"Intel Arc A770, ANV 26.1", discrete, 4, 33554432, 33554432, 33554432, 134217728, all, 32, 1024, 256},
    {"Intel UHD 620, ANV 23.1", integrated, 3, 65535, 65535, all, 134217728, all, 32, 1024, 128},
    {"Intel HD 520, Intel's 402.1274", integrated, 2, 200, 200, 200, 134217728, all, 32, 1024, 256},
    {"Apple M1, MoltenVK 1.2", integrated, 2, 31, 128, 159, 67108864, all, 32, 1024, 4096},
    {"Apple M5, MoltenVK 1.4", integrated, 4, 31, 256, 287, 134217728, all, 32, 1024, 4096},
    {"Apple M1, KosmicKrisp 26.1", integrated, 3, 1048576, 1048576, all, 268435456, all, 32, 1024, 256},
    {"Adreno 740, Turnip", integrated, 3, 16777215, 16777215, 16777215, 134217728, 134217728, 128, 1024, 256},
};
// clang-format on

/// What is known of that device, and of what is published of none what the specification demands.
DeviceFacts facts_of(const Published& device) {
    DeviceFacts facts;
    facts.type = device.type;
    facts.version_minor = device.version_minor;
    facts.scalar_block_layout = facts.ballots = facts.computes = true;
    facts.subgroup_size = device.subgroup_size;
    facts.storage_buffers = device.storage_buffers;
    facts.texel_buffers = device.texel_buffers;
    facts.uniform_buffers = 12;
    facts.resources = device.resources;
    facts.group_invocations = device.group_invocations;
    facts.push_constant_bytes = device.push_constant_bytes;
    facts.texels = device.texels;
    facts.storage_bytes = device.storage_bytes;
    facts.uniform_bytes = 16384;
    facts.heaps = {8 * giga};
    facts.memory = {{.heap = 0, .device_local = true, .mappable = true}};
    return facts;
}

TEST(Policy, DevicesWithPublishedLimitsAreServed) {
    for (const Published& device : published) {
        const DeviceFacts facts = facts_of(device);
        EXPECT_EQ(lacking(facts), "") << device.name;
        const DevicePolicy policy = policy_of(facts, 8);
        EXPECT_EQ(policy.way, Way::gpu) << device.name;
        EXPECT_TRUE(policy.tries_forms) << device.name;
        EXPECT_EQ(policy.step_budget, 64511u) << device.name;
    }
}

// In a line that holds what there is and what is needed.
TEST(Policy, WhatIsLackingIsSaid) {
    const struct {
        const char* told;
        void (*take)(DeviceFacts&);
    } changes[] = {
        {"Vulkan 1.2", [](auto& f) { f.version_minor = 1; }},
        {"scalarBlockLayout", [](auto& f) { f.scalar_block_layout = false; }},
        {"ballots", [](auto& f) { f.ballots = false; }},
        {"compute queue", [](auto& f) { f.computes = false; }},
        {"8 storage buffers a stage, 10 are needed", [](auto& f) { f.storage_buffers = 8; }},
        {"24 storage buffers a stage, 27 are needed, as 65536 texels in each of 16 buffers are too few",
         [](auto& f) {
             f.storage_buffers = 24;
             f.texel_buffers = 16;
             f.texels = 65536;
         }},
        {"0 uniform buffers a stage, ", [](auto& f) { f.uniform_buffers = 0; }},
        {"24 resources a stage, ", [](auto& f) { f.resources = 24; }},
        {"1024 bytes in a storage buffer, ", [](auto& f) { f.storage_bytes = 1024; }},
        {"64 bytes in a uniform buffer, ", [](auto& f) { f.uniform_bytes = 64; }},
        {"work groups of 64, 128 are needed", [](auto& f) { f.group_invocations = 64; }},
        {"16 bytes of push constants, ", [](auto& f) { f.push_constant_bytes = 16; }},
    };
    for (const auto& change : changes) {
        DeviceFacts facts = facts_of(published[0]);
        change.take(facts);
        EXPECT_NE(lacking(facts).find(change.told), std::string::npos) << change.told << ": " << lacking(facts);
    }
}

// SwiftShader, older Adreno and Mali: 65,536 texels in a buffer, as few as Vulkan permits. And a device with as few
// buffers of them, and one with few storage buffers but texels of all kinds.
TEST(Policy, FewTexelsAreReadAsStorage) {
    DeviceFacts facts = facts_of(published[0]);
    EXPECT_FALSE(policy_of(facts, 8).texels_as_storage);
    EXPECT_TRUE(policy_of(facts, 8).one_set);
    facts.texels = 65536;
    EXPECT_EQ(lacking(facts), "");
    EXPECT_TRUE(policy_of(facts, 8).texels_as_storage);
    facts = facts_of(published[0]);
    facts.texel_buffers = 16;
    EXPECT_EQ(lacking(facts), "");
    EXPECT_TRUE(policy_of(facts, 8).texels_as_storage);
    EXPECT_FALSE(policy_of(facts, 8).one_set);
    facts = facts_of(published[0]);
    facts.storage_buffers = 16;
    EXPECT_EQ(lacking(facts), "");
    EXPECT_FALSE(policy_of(facts, 8).texels_as_storage);
    EXPECT_FALSE(policy_of(facts, 8).one_set);
    facts.storage_buffers = 32;  // lavapipe, which is slower by as many sets as kernels
    EXPECT_TRUE(policy_of(facts, 8).one_set);
}

using Types = std::vector<std::uint32_t>;

// As NVIDIA's driver arranges it, without and with resizable BAR: the first type is the card's own, then the host's,
// not cached and cached, then the window.
DeviceFacts card(std::uint64_t window) {
    DeviceFacts facts = facts_of(published[0]);
    facts.heaps = {24 * giga, 16 * giga};
    facts.memory = {{.heap = 0, .device_local = true},
                    {.heap = 1, .mappable = true},
                    {.heap = 1, .mappable = true, .cached = true},
                    {.heap = 0, .device_local = true, .mappable = true}};
    if (window == 24 * giga) return facts;
    facts.heaps.push_back(window);
    facts.memory.back().heap = 2;
    return facts;
}

TEST(Policy, BuffersLieInACardsOwnMemoryAndNotInItsWindow) {
    const DevicePolicy policy = policy_of(card(246 * mega), 8);
    EXPECT_FALSE(policy.maps_buffers);
    EXPECT_EQ(policy.buffer_memory, (Types{0, 3})) << "and in the window where that is full";
    EXPECT_EQ(policy.staging_memory, (Types{2, 1, 3})) << "cached, for reads";
    EXPECT_EQ(policy.memory_bytes, 24 * giga + 246 * mega);
    EXPECT_FALSE(policy.memory_of_host);
}

TEST(Policy, BuffersAreMappedWhereTheHostSeesAllMemory) {
    const DevicePolicy policy = policy_of(card(24 * giga), 8);
    EXPECT_TRUE(policy.maps_buffers);
    EXPECT_EQ(policy.buffer_memory, (Types{3, 0}));
    EXPECT_EQ(policy.memory_bytes, 24 * giga);
}

// RADV: what the host does not see is a heap of its own, and the larger of two.
TEST(Policy, TwoHeapsOfTheDevicesOwn) {
    DeviceFacts facts = facts_of(published[6]);
    facts.heaps = {16 * giga - 256 * mega, 16 * giga, 256 * mega};
    facts.memory = {{.heap = 0, .device_local = true},
                    {.heap = 0, .device_local = true},
                    {.heap = 1, .mappable = true},
                    {.heap = 2, .device_local = true, .mappable = true},
                    {.heap = 1, .mappable = true, .cached = true},
                    {.heap = 2, .device_local = true, .mappable = true, .special = true}};
    const DevicePolicy policy = policy_of(facts, 8);
    EXPECT_FALSE(policy.maps_buffers);
    EXPECT_EQ(policy.buffer_memory, (Types{0, 1, 3}));
    EXPECT_EQ(policy.staging_memory, (Types{4, 2, 3}));
}

// A carve-out of 512 MiB and the host's memory, which the device reads alike.
TEST(Policy, AnIntegratedDeviceGoesOnInTheHostsMemory) {
    DeviceFacts facts = facts_of(published[11]);
    facts.heaps = {512 * mega, 8 * giga};
    facts.memory = {{.heap = 0, .device_local = true, .mappable = true}, {.heap = 1, .mappable = true, .cached = true}};
    const DevicePolicy policy = policy_of(facts, 8);
    EXPECT_TRUE(policy.maps_buffers);
    EXPECT_EQ(policy.buffer_memory, (Types{0, 1}));
    EXPECT_EQ(policy.memory_bytes, 512 * mega + 8 * giga);
    EXPECT_LT(policy.busy_lanes, policy_of(card(24 * giga), 8).busy_lanes) << "it has fewer lanes to fill";
}

DeviceFacts llvmpipe() {
    DeviceFacts facts = facts_of(published[0]);
    facts.type = DeviceType::cpu;
    facts.llvmpipe = true;
    facts.subgroup_size = 8;
    facts.memory = {{.heap = 0, .device_local = true, .mappable = true, .cached = true}};
    return facts;
}

TEST(Policy, SoftwareVulkanIsMappedAndHasFewLanes) {
    const DevicePolicy policy = policy_of(llvmpipe(), 4);
    EXPECT_EQ(policy.way, Way::cpu);
    EXPECT_TRUE(policy.maps_buffers);
    EXPECT_TRUE(policy.memory_of_host);
    EXPECT_FALSE(policy.tries_forms);
    EXPECT_EQ(policy.busy_lanes, 2048u);
    EXPECT_EQ(policy.step_budget, 65535 / 8 - 1024u);
}

// Light paths are dealt out where lanes are promised to come together again, and on llvmpipe, where they do.
TEST(Policy, LightPathsAreDealtWhereLanesComeTogether) {
    DeviceFacts facts = facts_of(published[0]);
    EXPECT_FALSE(policy_of(facts, 4).deals_paths);
    for (const Reconvergence promise : {Reconvergence::uniform, Reconvergence::maximal}) {
        facts.reconvergence = promise;
        EXPECT_TRUE(policy_of(facts, 4).deals_paths);
        EXPECT_EQ(policy_of(facts, 4).reconvergence, promise) << "it is asked for";
    }
    EXPECT_TRUE(policy_of(llvmpipe(), 4).deals_paths);
    EXPECT_FALSE(policy_of(llvmpipe(), 4, Way::gpu).deals_paths) << "so that tests see the other form";
}

TEST(Policy, OneWayCanBeAskedForInPlaceOfTheOther) {
    const DevicePolicy policy = policy_of(llvmpipe(), 4, Way::gpu);
    EXPECT_EQ(policy.way, Way::gpu);
    EXPECT_FALSE(policy.maps_buffers) << "copies are staged though all is seen";
    EXPECT_EQ(policy.buffer_memory, Types{0});
    EXPECT_EQ(policy.staging_memory, Types{0});
    EXPECT_TRUE(policy.tries_forms);
    EXPECT_TRUE(policy.memory_of_host) << "its memory stays what it is";
    EXPECT_EQ(policy.step_budget, 65535 / 8 - 1024u) << "and so do its limits";
    EXPECT_NE(text_of(policy).find("VKCPPM_POLICY"), std::string::npos);
    EXPECT_TRUE(policy_of(card(246 * mega), 4, Way::cpu).maps_buffers);
}

TEST(Policy, TheEnvironmentSaysWhichWay) {
    for (const auto& [value, way] : std::vector<std::pair<const char*, std::optional<Way>>>{
             {nullptr, std::nullopt}, {"", std::nullopt}, {"cpu", Way::cpu}, {"gpu", Way::gpu}}) {
        const test::Variable variable("VKCPPM_POLICY", value);
        EXPECT_EQ(asked_way(), way) << (value ? value : "not set");
    }
    const test::Variable variable("VKCPPM_POLICY", "GPU");
    const auto error = test::thrown_by([] { asked_way(); });
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code(), ExitCode::usage);
}

}  // namespace
}  // namespace vkcppm
