#include "render/buffers.h"

#include <array>
#include <cassert>
#include <utility>

#include "core/error.h"
#include "shared/types.h"

namespace vkcppm {

namespace gpu {
namespace {

constexpr auto rows = std::to_array<BufferRow>({
#define ROW(number, name, Element, per, entries, access, life, hashed) \
    {Binding::name, sizeof(Element), Per::per, Entries::entries, Life::life, Hashed::hashed},
    BUFFERS(ROW)
#undef ROW
});

}  // namespace
}  // namespace gpu

namespace {

constexpr std::uint64_t empty_bytes = 16;  // of a buffer that holds nothing

std::uint64_t things(Per per, const Counts& counts) {
    switch (per) {
        case Per::pixel: return counts.pixels;
        case Per::photon_slot: return counts.photon_slots;
        case Per::photon_lane: return counts.photon_lanes;
        case Per::counter: return counts.counters;
        case Per::rest: return 1;
        case Per::triangle:
        case Per::node:
        case Per::light:
        case Per::material:
        case Per::texel:
        case Per::sky_pixel: break;  // uploaded
    }
    return 0;
}

std::uint64_t each(Entries entries, const Counts& counts) {
    switch (entries) {
        case Entries::one: return 1;
        case Entries::uploaded: return 0;
        case Entries::tallies: return counts.tallies;
        case Entries::moments: return counts.moments;
        case Entries::nearest: return counts.nearest;
        case Entries::levels: return counts.levels;
        case Entries::where_aovs: return counts.aovs ? 1 : 0;
        case Entries::where_glossy: return counts.glossy ? 1 : 0;
        case Entries::asked_groups: return counts.asked_groups;
        case Entries::where_traced: return counts.traced ? 1 : 0;
    }
    return 0;
}

/// As --stats calls them.
const char* name_of(Per per) {
    switch (per) {
        case Per::pixel: return "pixel";
        case Per::photon_slot: return "photon slot";
        case Per::photon_lane: return "lane of light paths";
        case Per::counter: return "counter of the grid";
        case Per::triangle: return "triangle";
        case Per::node: return "node";
        case Per::light: return "light";
        case Per::material: return "material";
        case Per::texel: return "texel";
        case Per::sky_pixel: return "environment pixel";
        case Per::rest: break;
    }
    return "rest";
}

}  // namespace

std::span<const BufferRow> buffer_rows() { return gpu::rows; }

std::uint64_t entries_of(const BufferRow& row, const Counts& counts) {
    return things(row.per, counts) * each(row.entries, counts);
}

void Buffers::allocate(Binding binding, std::uint64_t entries) {
    allocate_bytes(binding, entries * gpu::rows[std::size_t(binding)].element_bytes);
}

void Buffers::allocate_bytes(Binding binding, std::uint64_t bytes) {
    const auto put = [&](std::uint64_t size) {
        // The old one first: there may not be room for both.
        buffers_.erase(binding);
        lent_.erase(binding);
        bindings_.bind(binding, buffers_.emplace(binding, Buffer(device_, binding, size)).first->second);
    };
    try {
        put(bytes);
    } catch (const Error&) {
        put(0);  // kernels that do not read it can still run
        throw;
    }
}

void Buffers::lend(Binding binding, const Buffer& buffer) {
    buffers_.erase(binding);
    bindings_.bind(binding, buffer);
    lent_[binding] = &buffer;
}

std::map<Binding, const Buffer*> Buffers::all() const {
    std::map<Binding, const Buffer*> all = lent_;
    for (const auto& [binding, buffer] : buffers_) all[binding] = &buffer;
    return all;
}

std::vector<MemoryReport> memory_of(const Buffers& buffers) {
    std::map<Per, MemoryReport> memory;
    MemoryReport rest{name_of(Per::rest), 1, 0};
    for (const auto& [binding, buffer] : buffers.all()) {
        const BufferRow& row = gpu::rows[std::size_t(binding)];
        if (row.per == Per::rest || buffer->bytes() <= empty_bytes) {
            rest.bytes += buffer->bytes();
            continue;
        }
        // The first row of what it has entries for tells how many there are.
        const auto [report, first] =
            memory.try_emplace(row.per, MemoryReport{name_of(row.per), buffer->bytes() / row.element_bytes, 0});
        report->second.bytes += buffer->bytes();
    }
    std::vector<MemoryReport> reports;
    for (auto& [per, report] : memory) reports.push_back(std::move(report));
    reports.push_back(rest);
    return reports;
}

}  // namespace vkcppm
