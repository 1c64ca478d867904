#include "vk/kernel.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "core/fnv1a.h"
#include "core/process.h"
#include "vk/buffer_impl.h"
#include "vk/device_impl.h"
#include "vk/fold.h"
#include "vk/loops.h"
#include "vk/reconvergence.h"
#include "vk/spirv.h"
#include "vk/texels.h"

namespace vkcppm {
namespace {

constexpr std::uint32_t stamps_a_pool = 1024;

/// Those of the constants that a module has: pipelines that differ in others alone are one.
Specialization of_module(std::span<const std::uint32_t> spirv, const Specialization& constants) {
    Specialization found;
    for (const Instruction words : instructions_of(spirv)) {
        if (opcode(words) != spv::OpDecorate || words[2] != spv::DecorationSpecId) continue;
        const auto constant = constants.find(words[3]);
        if (constant != constants.end()) found.insert(*constant);
    }
    return found;
}

}  // namespace

struct Bindings::Impl {
    using Layout = Device::Impl::Layout;
    struct Bound {
        vk::Buffer buffer;
        vk::BufferView view;
    };
    /// All that is bound in a set, and how often that was changed.
    struct Set {
        std::array<Bound, bound_buffers.size()> bound{};
        std::uint64_t changes = 1;
    };
    /// Descriptor sets of a layout, one for each of those, and the change after which it was written.
    struct Written {
        vk::raii::DescriptorPool pool;
        std::vector<vk::raii::DescriptorSet> sets;
        std::vector<std::uint64_t> changes;
    };
    Device* device = nullptr;
    std::vector<Set> sets;
    std::map<const Layout*, Written> written;

    vk::DescriptorSet set_for(const Layout& layout, std::uint32_t index);
    Written allocated(const Layout& layout) const;
};

Bindings::Bindings(Device& device, std::uint32_t sets) : impl_(std::make_unique<Impl>()) {
    impl_->device = &device;
    impl_->sets.resize(sets);
}

Bindings::~Bindings() = default;

std::uint32_t Bindings::sets() const { return std::uint32_t(impl_->sets.size()); }

void Bindings::bind(Binding binding, const Buffer& buffer) {
    for (std::uint32_t set = 0; set < sets(); ++set) bind(binding, buffer, set);
}

void Bindings::bind(Binding binding, const Buffer& buffer, std::uint32_t set) {
    const auto& source = buffer.impl();
    assert(bound_buffer(binding).access == source.access);
    Impl::Set& of = impl_->sets.at(set);
    of.bound[std::size_t(binding)] = {**source.buffer, source.view ? **source.view : vk::BufferView()};
    ++of.changes;
}

/// With room for all sets.
Bindings::Impl::Written Bindings::Impl::allocated(const Layout& layout) const {
    const auto count = std::uint32_t(sets.size());
    std::map<vk::DescriptorType, std::uint32_t> counts;
    for (const vk::DescriptorSetLayoutBinding& binding : layout.bindings) counts[binding.descriptorType] += count;
    std::vector<vk::DescriptorPoolSize> sizes;
    for (const auto& [type, of_type] : counts) sizes.emplace_back(type, of_type);
    std::optional<Written> made;
    guarded("creating descriptor sets", [&] {
        const vk::raii::Device& gpu = *device->impl().device;
        vk::raii::DescriptorPool pool(
            gpu, vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, count, sizes));
        const std::vector<vk::DescriptorSetLayout> layouts(count, *layout.set);
        std::vector<vk::raii::DescriptorSet> all =
            vk::raii::DescriptorSets(gpu, vk::DescriptorSetAllocateInfo(*pool, layouts));
        made = Written{std::move(pool), std::move(all), std::vector<std::uint64_t>(count)};
    });
    return std::move(*made);
}

/// What is bound in a set, as a kernel of that layout has it.
vk::DescriptorSet Bindings::Impl::set_for(const Layout& layout, std::uint32_t index) {
    auto found = written.find(&layout);
    if (found == written.end()) found = written.emplace(&layout, allocated(layout)).first;
    const Set& of = sets.at(index);
    const vk::DescriptorSet set = *found->second.sets[index];
    if (std::exchange(found->second.changes[index], of.changes) == of.changes) return set;
    std::vector<vk::DescriptorBufferInfo> infos;
    infos.reserve(layout.bindings.size());
    std::vector<vk::WriteDescriptorSet> writes;
    for (const vk::DescriptorSetLayoutBinding& row : layout.bindings) {
        const Bound& bound = of.bound[row.binding % TEXELS_BINDING];
        if (!bound.buffer) continue;
        infos.emplace_back(bound.buffer, 0, VK_WHOLE_SIZE);
        const bool is_view = row.descriptorType == vk::DescriptorType::eUniformTexelBuffer;
        writes.emplace_back(set, row.binding, 0, 1, row.descriptorType, nullptr, is_view ? nullptr : &infos.back(),
                            is_view ? &bound.view : nullptr);
    }
    device->impl().device->updateDescriptorSets(writes, {});
    return set;
}

struct Kernel::Impl {
    std::string name;
    std::uint32_t workgroup = 64;
    std::shared_ptr<Device::Impl::Pipeline> made;
};

Kernel::Kernel(Device& device, std::string name, std::span<const std::uint32_t> spirv,
               const Specialization& specialization)
    : impl_(std::make_unique<Impl>()) {
    impl_->name = std::move(name);
    impl_->workgroup = specialization.at(SPEC_WORKGROUP);
    const Specialization own = of_module(spirv, specialization);
    std::shared_ptr<Device::Impl::Pipeline>& made = device.impl().made[{fnv1a_of(spirv), own}];
    if (!made) {
        guarded(fmt::format("creating kernel '{}'", impl_->name), [&] {
            auto& gpu = *device.impl().device;
            const DevicePolicy& policy = device.policy();
            std::vector<std::uint32_t> words = folded(spirv, own);
            if (policy.texels_as_storage) words = with_storage_for_texels(words);
            if (policy.closes_loops) words = with_loops_closed(words);
            words = with_promise(words, policy.reconvergence);
            const Device::Impl::Layout& layout = layout_of(device.impl(), bindings_of(words));
            const vk::raii::ShaderModule module(gpu, vk::ShaderModuleCreateInfo({}, words));
            std::vector<vk::SpecializationMapEntry> entries;
            std::vector<std::uint32_t> values;
            for (const auto& [id, value] : of_module(words, own)) {  // none where it was folded
                entries.emplace_back(id, std::uint32_t(values.size() * sizeof(value)), sizeof(value));
                values.push_back(value);
            }
            const vk::SpecializationInfo info(std::uint32_t(entries.size()), entries.data(),
                                              values.size() * sizeof(values[0]), values.data());
            const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main",
                                                          &info);
            auto pipeline = std::make_shared<Device::Impl::Pipeline>();
            pipeline->layout = &layout;
            pipeline->pipeline.emplace(gpu, *device.impl().pipelines,
                                       vk::ComputePipelineCreateInfo({}, stage, *layout.pipeline));
            name_object(device.impl(), *pipeline->pipeline, impl_->name);
            made = std::move(pipeline);
        });
    }
    impl_->made = made;
}

Kernel::~Kernel() = default;
Kernel::Kernel(Kernel&&) noexcept = default;
Kernel& Kernel::operator=(Kernel&&) noexcept = default;

const std::string& Kernel::name() const { return impl_->name; }

struct Commands::Impl {
    Device* device = nullptr;
    const Bindings* bindings = nullptr;
    std::uint32_t set = 0;    // of the launches that follow
    vk::DescriptorSet bound;  // what the last of them was with
    std::optional<vk::raii::CommandBuffer> commands;
    std::optional<vk::raii::Fence> fence;
    std::vector<vk::raii::QueryPool> stamps;  // one more where a submission has more launches than any before
    std::uint32_t stamped = 0;                // at the begin, and after every launch
    std::vector<const Kernel*> launched;
};

Commands::Commands(Device& device, const Bindings& bindings) : impl_(std::make_unique<Impl>()) {
    guarded("creating a command buffer", [&] {
        auto& gpu = device.impl();
        impl_->device = &device;
        impl_->bindings = &bindings;
        vk::raii::CommandBuffers buffers(*gpu.device, {**gpu.pool, vk::CommandBufferLevel::ePrimary, 1});
        impl_->commands.emplace(std::move(buffers.front()));
        impl_->fence.emplace(*gpu.device, vk::FenceCreateInfo());
    });
}

Commands::~Commands() = default;

void Commands::begin() {
    guarded("recording commands", [&] {
        impl_->launched.clear();
        impl_->bound = nullptr;
        impl_->stamped = 0;
        impl_->commands->reset();
        impl_->commands->begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
        use(0);
        stamp();
    });
}

void Commands::use(std::uint32_t set) { impl_->set = set; }

/// Takes the time once all kernels before have ended. A stamp before them could be taken while the driver still holds
/// back the barrier in front of a launch, whose time would then count for two.
void Commands::stamp() {
    if (impl_->device->impl().stamp_bits == 0) return;
    const std::uint32_t pool = impl_->stamped / stamps_a_pool, query = impl_->stamped % stamps_a_pool;
    if (pool == impl_->stamps.size()) {
        impl_->stamps.emplace_back(*impl_->device->impl().device,
                                   vk::QueryPoolCreateInfo({}, vk::QueryType::eTimestamp, stamps_a_pool));
    }
    const vk::QueryPool queries = *impl_->stamps[pool];
    if (query == 0) impl_->commands->resetQueryPool(queries, 0, stamps_a_pool);
    impl_->commands->writeTimestamp(vk::PipelineStageFlagBits::eComputeShader, queries, query);
    ++impl_->stamped;
}

void Commands::launch(const Kernel& kernel, std::uint64_t invocations, const gpu::Launch& push) {
    const std::uint64_t groups = (invocations + kernel.impl().workgroup - 1) / kernel.impl().workgroup;
    const std::uint64_t limit = impl_->device->impl().limits.maxComputeWorkGroupCount[0];
    const std::uint64_t rows = (groups + limit - 1) / limit;
    assert(groups > 0 && rows <= impl_->device->impl().limits.maxComputeWorkGroupCount[1]);
    record(kernel, push, [&](vk::raii::CommandBuffer& commands) {
        commands.dispatch(std::uint32_t((groups + rows - 1) / rows), std::uint32_t(rows), 1);
    });
}

void Commands::launch_indirect(const Kernel& kernel, const Buffer& groups, std::uint64_t offset,
                               const gpu::Launch& push) {
    record(kernel, push,
           [&](vk::raii::CommandBuffer& commands) { commands.dispatchIndirect(**groups.impl().buffer, offset); });
}

/// Records what `dispatch` adds, timed, after all before it and before all after it.
template <typename Dispatch> void Commands::record(const Kernel& kernel, const gpu::Launch& push, Dispatch dispatch) {
    auto& commands = *impl_->commands;
    const bool takes_labels = commands.getDispatcher()->vkCmdBeginDebugUtilsLabelEXT != nullptr;
    using Stage = vk::PipelineStageFlagBits;
    using Access = vk::AccessFlagBits;

    if (takes_labels) commands.beginDebugUtilsLabelEXT(vk::DebugUtilsLabelEXT(kernel.name().c_str()));
    const Device::Impl::Pipeline& made = *kernel.impl().made;
    const vk::DescriptorSet set = impl_->bindings->impl().set_for(*made.layout, impl_->set);
    if (std::exchange(impl_->bound, set) != set) {
        commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *made.layout->pipeline, 0, set, {});
    }
    commands.bindPipeline(vk::PipelineBindPoint::eCompute, **made.pipeline);
    commands.pushConstants<gpu::Launch>(*made.layout->pipeline, vk::ShaderStageFlagBits::eCompute, 0, push);
    dispatch(commands);
    const vk::MemoryBarrier barrier(Access::eShaderWrite,
                                    Access::eShaderRead | Access::eShaderWrite | Access::eIndirectCommandRead);
    commands.pipelineBarrier(Stage::eComputeShader, Stage::eComputeShader | Stage::eDrawIndirect, {}, barrier, {}, {});
    stamp();
    impl_->launched.push_back(&kernel);
    if (takes_labels) commands.endDebugUtilsLabelEXT();
}

std::vector<Timing> Commands::finish() {
    std::vector<Timing> timings;
    guarded("running kernels", [&] {
        auto& gpu = impl_->device->impl();
        // Everything is read or written by the host next, itself or through a transfer.
        using Access = vk::AccessFlagBits;
        const vk::MemoryBarrier barrier(Access::eShaderWrite,
                                        Access::eHostRead | Access::eTransferRead | Access::eTransferWrite);
        impl_->commands->pipelineBarrier(vk::PipelineStageFlagBits::eComputeShader,
                                         vk::PipelineStageFlagBits::eHost | vk::PipelineStageFlagBits::eTransfer, {},
                                         barrier, {}, {});
        impl_->commands->end();
        const vk::CommandBuffer raw = **impl_->commands;
        const double begun = wall_now();
        gpu.queue->submit(vk::SubmitInfo({}, {}, raw), **impl_->fence);
        if (gpu.device->waitForFences(**impl_->fence, true, UINT64_MAX) != vk::Result::eSuccess) {
            throw Error(ExitCode::device_lost, "the device did not finish its kernels");
        }
        const double waited = wall_now() - begun;
        gpu.device->resetFences(**impl_->fence);
        if (gpu.stamp_bits == 0) {
            for (const Kernel* kernel : impl_->launched) {
                timings.push_back({kernel, waited / double(impl_->launched.size())});
            }
            return;
        }
        std::vector<std::uint64_t> stamps;
        while (stamps.size() < impl_->stamped) {
            const auto count = std::uint32_t(std::min<std::size_t>(stamps_a_pool, impl_->stamped - stamps.size()));
            const auto [result, of_pool] = impl_->stamps[stamps.size() / stamps_a_pool].getResults<std::uint64_t>(
                0, count, count * sizeof(std::uint64_t), sizeof(std::uint64_t),
                vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait);
            stamps.insert(stamps.end(), of_pool.begin(), of_pool.end());
        }
        const std::uint64_t valid = ~std::uint64_t(0) >> (64 - gpu.stamp_bits);  // the clock begins again after it
        for (std::size_t i = 0; i < impl_->launched.size(); ++i) {
            const double ticks = double((stamps[i + 1] - stamps[i]) & valid);
            timings.push_back({impl_->launched[i], ticks * gpu.limits.timestampPeriod * 1e-9});
        }
    });
    return timings;
}

}  // namespace vkcppm
