#include "render/buffers.h"

#include <algorithm>
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

/// What kernels decode from texels of four words (RECORDS) is whole ones: a rest would shift all entries behind it.
constexpr bool records_are_whole_texels() {
    return std::ranges::all_of(rows, [](const BufferRow& row) {
        const Access access = bound_buffer(row.binding).access;
        const bool of_four = has_texels(access) && texel_bytes(access) == 16;
        return !of_four || row.element_bytes <= 4 || row.element_bytes % 16 == 0;
    });
}
static_assert(records_are_whole_texels(),
              "an Element that is read as texels of four words is not whole ones: add `unused` words at its end");

}  // namespace
}  // namespace gpu

namespace {

constexpr std::uint64_t empty_bytes = 16;  // of a buffer that holds nothing
// Pixels of a band at most: with so many the device is as busy as with more, which would only take memory.
constexpr std::uint64_t most_band_pixels = 1u << 20;

std::uint64_t things(Per per, const Counts& counts) {
    switch (per) {
        case Per::pixel:
        case Per::band_pixel: return counts.bands.each;
        case Per::photon_slot: return counts.photon_slots;
        case Per::photon_lane: return counts.photon_lanes;
        case Per::counter: return counts.counters;
        case Per::rest: return 1;
        case Per::triangle:
        case Per::node:
        case Per::instance:
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
        case Entries::where_instances: return counts.glossy && counts.instances ? 1 : 0;
        case Entries::asked_groups: return counts.asked_groups;
        case Entries::where_traced: return counts.traced ? 1 : 0;
        case Entries::error_groups: return counts.errors ? ERROR_GROUPS : 0;
    }
    return 0;
}

/// As --stats calls them.
const char* name_of(Per per) {
    switch (per) {
        case Per::pixel: return "pixel";
        case Per::band_pixel: return "pixel of a band";
        case Per::photon_slot: return "photon slot";
        case Per::photon_lane: return "lane of light paths";
        case Per::counter: return "counter of the grid";
        case Per::triangle: return "triangle";
        case Per::node: return "node";
        case Per::instance: return "instance";
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

Bands bands_of(std::uint64_t pixels, const Counts& counts, const Device& device, std::uint64_t most) {
    if (most == 0) most = most_band_pixels;
    for (const BufferRow& row : gpu::rows) {
        if (row.per != Per::pixel && row.per != Per::band_pixel) continue;
        const std::uint64_t bytes = row.element_bytes * each(row.entries, counts);  // a pixel
        // Buffers are whole texels.
        if (bytes > 0) most = std::min(most, (device.largest_buffer(bound_buffer(row.binding).access) - 15) / bytes);
    }
    most = std::max<std::uint64_t>(most, 1);
    const std::uint64_t bands = std::max<std::uint64_t>((pixels + most - 1) / most, 1);
    return {pixels, (pixels + bands - 1) / bands};
}

void Buffers::allocate(Binding binding, std::uint64_t entries) {
    allocate_bytes(binding, entries * gpu::rows[std::size_t(binding)].element_bytes);
}

void Buffers::allocate_bytes(Binding binding, std::uint64_t bytes) {
    const auto put = [&](std::uint64_t size) {
        // The old one first: there may not be room for both.
        lent_.erase(binding);
        std::vector<Buffer>& buffers = buffers_[binding];
        buffers.clear();
        if (gpu::rows[std::size_t(binding)].per != Per::pixel) {
            bindings_.bind(binding, buffers.emplace_back(device_, binding, size));
            return;
        }
        for (std::uint32_t band = 0; band < bindings_.sets(); ++band) {
            bindings_.bind(binding, buffers.emplace_back(device_, binding, size), band);
        }
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

std::map<Binding, std::uint64_t> Buffers::bytes() const {
    std::map<Binding, std::uint64_t> bytes;
    for (const auto& [binding, buffer] : lent_) bytes[binding] = buffer->bytes();
    for (const auto& [binding, buffers] : buffers_) {
        for (const Buffer& buffer : buffers) bytes[binding] += buffer.bytes();
    }
    return bytes;
}

std::vector<MemoryReport> memory_of(const std::map<Binding, std::uint64_t>& all, std::uint32_t bands) {
    std::map<Per, MemoryReport> memory;
    MemoryReport rest{name_of(Per::rest), 1, 0};
    for (const auto& [binding, bytes] : all) {
        const BufferRow& row = gpu::rows[std::size_t(binding)];
        if (row.per == Per::rest || bytes <= empty_bytes * (row.per == Per::pixel ? bands : 1)) {
            rest.bytes += bytes;
            continue;
        }
        MemoryReport& report = memory.try_emplace(row.per, MemoryReport{name_of(row.per), 0, 0}).first->second;
        const bool tells = row.entries == Entries::one || row.entries == Entries::uploaded;
        if (tells && report.count == 0) report.count = bytes / row.element_bytes;
        report.bytes += bytes;
    }
    std::vector<MemoryReport> reports;
    for (auto& [per, report] : memory) reports.push_back(std::move(report));
    reports.push_back(rest);
    return reports;
}

}  // namespace vkcppm
