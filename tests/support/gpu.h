#pragma once
// The device of the tests, under the validation layer, and small programs on it.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "render/integrator.h"
#include "shared/bindings.h"
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

    template <typename T>
    void input(std::uint32_t binding, const std::vector<T>& data, Buffer::Kind kind = Buffer::Kind::storage) {
        create(binding, data.size() * sizeof(T), kind);
        buffers_.at(binding).upload(data);
    }
    template <typename T> void output(std::uint32_t binding, std::size_t count) {
        create(binding, count * sizeof(T), Buffer::Kind::storage);
    }
    template <typename T> std::vector<T> result(std::uint32_t binding, std::size_t count) const {
        return buffers_.at(binding).download<T>(count);
    }
    void run(std::uint64_t invocations, const gpu::Launch& launch = {});

private:
    void create(std::uint32_t binding, std::uint64_t bytes, Buffer::Kind kind);

    Bindings bindings_;
    Commands commands_;
    Kernel kernel_;
    std::map<std::uint32_t, Buffer> buffers_;
};

}  // namespace vkcppm::test
