#pragma once
// The device of the tests, under the validation layer, and small programs on it.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "render/integrator.h"
#include "vk/buffer.h"
#include "vk/device.h"
#include "vk/kernel.h"

namespace vkcppm::test {

/// The one device of a test program, with synchronization validation.
Device& device();

/// The same without the validation layer, whose bookkeeping takes longer than tiny kernels: for runs of many
/// iterations.
Device& plain_device();

/// Every test of a kernel: a message of the validation layer during the test fails it.
class GpuTest : public testing::Test {
protected:
    void SetUp() override;
    void TearDown() override;

private:
    std::size_t messages_before_ = 0;
};

/// A kernel of tests/kernels with buffers of its own at the bindings it declares.
class Probe {
public:
    /// features: FEATURE_* that it is specialised to. node_bits: of an index of a node of the BVH.
    Probe(std::string name, std::span<const std::uint32_t> spirv, std::uint32_t stack = 32,
          std::uint32_t features = ~0u, std::uint32_t node_bits = 20);

    template <typename T> void input(Binding binding, const std::vector<T>& data) {
        create(binding, data.size() * sizeof(T));
        buffers_.at(binding).upload(data);
    }
    template <typename T> void output(Binding binding, std::size_t count) { create(binding, count * sizeof(T)); }
    template <typename T> std::vector<T> result(Binding binding, std::size_t count) const {
        return buffers_.at(binding).download<T>(count);
    }
    void run(std::uint64_t invocations, const gpu::Launch& launch = {});

private:
    void create(Binding binding, std::uint64_t bytes);

    Bindings bindings_;
    Commands commands_;
    Kernel kernel_;
    std::map<Binding, Buffer> buffers_;
};

}  // namespace vkcppm::test
