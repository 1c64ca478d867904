#pragma once
// The device's buffers of one renderer, by the rows of shaders/shared/buffers.h: how large each is, what an iteration
// leaves to the next, what memory they take.

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "render/report.h"
#include "vk/binding.h"
#include "vk/buffer.h"
#include "vk/device.h"
#include "vk/kernel.h"

namespace vkcppm {

/// What a buffer has entries for. The first row of each has exactly one entry for each.
enum class Per {
    pixel,
    photon_slot,
    photon_lane,
    counter,
    triangle,
    node,
    light,
    material,
    texel,
    sky_pixel,
    rest,
};

/// How many entries for each.
enum class Entries {
    one,
    uploaded,  // as many as the host has
    tallies,
    moments,
    nearest,
    levels,
    where_aovs,    // one, where the settings ask for further channels
    where_glossy,  // one, in glossy scenes
    asked_groups,  // of lights that eye paths ask for
    where_traced,  // one, in the path tracer
};

enum class Life { scratch, carried };

/// After which pass a hash covers it.
enum class Hashed { never, eye, gather, update, from_knn, apart };

struct BufferRow {
    Binding binding{};
    std::uint64_t element_bytes = 0;
    Per per{};
    Entries entries{};
    Life life{};
    Hashed hashed{};
};

/// All rows, in the order of their bindings.
std::span<const BufferRow> buffer_rows();

/// What the sizes of a renderer's buffers follow from.
struct Counts {
    std::uint64_t pixels = 0;
    std::uint64_t photon_slots = 0;
    std::uint64_t photon_lanes = 0;
    std::uint64_t counters = 0;
    std::uint64_t tallies = 0;  // a pixel, as all from here on
    std::uint64_t moments = 0;
    std::uint64_t nearest = 0;
    std::uint64_t asked_groups = 0;
    std::uint64_t levels = 0;  // a photon slot
    bool aovs = false;
    bool glossy = false;
    bool traced = false;
};

/// Entries of a row; 0 for one that is uploaded.
std::uint64_t entries_of(const BufferRow& row, const Counts& counts);

/// The buffers of one renderer. Each is bound as long as it lives.
class Buffers {
public:
    Buffers(Device& device, Bindings& bindings) : device_(device), bindings_(bindings) {}

    /// A buffer of `entries` zeros, in place of what stood there. Throws Error(out_of_device_memory).
    void allocate(Binding binding, std::uint64_t entries);

    /// The rows that `takes` says, each with the entries that follow from the counts.
    template <typename Takes> void allocate(const Counts& counts, Takes takes) {
        for (const BufferRow& row : buffer_rows()) {
            if (takes(row)) allocate(row.binding, entries_of(row, counts));
        }
    }

    /// One that holds `data`.
    template <typename T> void upload(Binding binding, const std::vector<T>& data) {
        allocate_bytes(binding, data.size() * sizeof(T));
        at(binding).upload(data);
    }

    /// Binds a buffer that lives elsewhere.
    void lend(Binding binding, const Buffer& buffer);

    /// There must be one of its own: not one that was lent.
    Buffer& at(Binding binding) { return buffers_.at(binding); }
    const Buffer& at(Binding binding) const { return buffers_.at(binding); }

    /// All of them, and those that were lent.
    std::map<Binding, const Buffer*> all() const;

private:
    void allocate_bytes(Binding binding, std::uint64_t bytes);

    Device& device_;
    Bindings& bindings_;
    std::map<Binding, Buffer> buffers_;
    std::map<Binding, const Buffer*> lent_;
};

/// The buffers by what they have entries for; what has no such measure comes last. Their bytes sum to all buffers'.
std::vector<MemoryReport> memory_of(const Buffers& buffers);

}  // namespace vkcppm
