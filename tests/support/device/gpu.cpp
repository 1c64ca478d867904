#include "support/device/gpu.h"

#include <cstdlib>
#include <string_view>

#include "support/drivers.h"

namespace vkcppm::test {
namespace {

/// VKCPPM_TEST_VALIDATION=0 goes without the validation layer, on a machine or a driver that it cannot be used on.
bool validates() {
    const char* asked = std::getenv("VKCPPM_TEST_VALIDATION");
    return !asked || std::string_view(asked) != "0";
}

}  // namespace

Device& device() {
    static Device shared(Device::Options{.select = "", .validate = validates()});
    return shared;
}

Device& plain_device() {
    static Device shared(Device::Options{.select = "", .validate = false});
    return shared;
}

void GpuTest::SetUp() {
    if (device().policy().texels_as_storage && faults_where_texels_are_storage(device().info().driver))
        GTEST_SKIP() << why_storage_faults;
    ASSERT_EQ(device().validating(), validates());
    messages_before_ = device().validation_messages().size();
}

void GpuTest::TearDown() {
    const std::vector<std::string> messages = device().validation_messages();
    for (std::size_t i = messages_before_; i < messages.size(); ++i) ADD_FAILURE() << messages[i];
}

Probe::Probe(std::string name, std::span<const std::uint32_t> spirv, std::uint32_t stack, std::uint32_t features,
             std::uint32_t node_bits)
    : bindings_(device()),
      commands_(device(), bindings_),
      kernel_(device(), std::move(name), spirv,
              {{SPEC_WORKGROUP, 64},
               {SPEC_STACK, stack},
               {SPEC_FEATURES, features},
               {SPEC_NODE_BITS, node_bits},
               {SPEC_LIGHT_TREE, 1}}) {
    create(Binding::params, sizeof(gpu::Params));
    create(Binding::status, sizeof(gpu::Status));
}

void Probe::create(Binding binding, std::uint64_t bytes) {
    buffers_.erase(binding);
    buffers_.emplace(binding, Buffer(device(), binding, bytes));
    bindings_.bind(binding, buffers_.at(binding));
}

void Probe::run(std::uint64_t invocations, const gpu::Launch& launch) {
    commands_.begin();
    commands_.launch(kernel_, invocations, launch);
    commands_.finish();
}

}  // namespace vkcppm::test
