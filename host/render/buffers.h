#pragma once
// The device's buffers of one renderer, by the rows of shaders/shared/buffers.h: how large each is, what an iteration
// leaves to the next, what memory they take.

#include <algorithm>
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

/// What a buffer has entries for. The first row of each that is not there for some features alone has exactly one entry
/// for each.
enum class Per {
    pixel,       // of the picture: a buffer for every band of it
    band_pixel,  // of a band
    photon_slot,
    photon_lane,
    counter,
    triangle,
    node,
    instance,
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
    where_aovs,       // one, where the settings ask for further channels
    where_glossy,     // one, in glossy scenes
    where_instances,  // one, in glossy scenes that have instances
    asked_groups,     // of lights that eye paths ask for
    where_traced,     // one, in the path tracer
    error_groups,     // ERROR_GROUPS, where errors are estimated
};

enum class Life { scratch, carried, summed };

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

/// A picture that is gone through in bands of as many pixels, of which the last may be smaller: their number, whatever
/// the picture's, fits the device's buffers, and what an iteration makes anew is there for one band alone.
struct Bands {
    std::uint64_t pixels = 0;  // of the picture
    std::uint64_t each = 0;    // of a band
    std::uint32_t count() const { return each == 0 ? 0 : std::uint32_t((pixels + each - 1) / each); }
    std::uint64_t first(std::uint32_t band) const { return band * each; }
    std::uint64_t size(std::uint32_t band) const { return std::min(each, pixels - first(band)); }
};

/// What the sizes of a renderer's buffers follow from.
struct Counts {
    Bands bands;
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
    bool instances = false;
    bool traced = false;
    bool errors = false;
};

/// Entries of a buffer of a row, of each of them where the row has one for every band; 0 for one that is uploaded.
std::uint64_t entries_of(const BufferRow& row, const Counts& counts);

/// Bands of a picture of so many pixels: one, unless it is large or has more than a buffer of the device holds. most:
/// pixels of a band at most, 0: what is best.
Bands bands_of(std::uint64_t pixels, const Counts& counts, const Device& device, std::uint64_t most = 0);

/// The buffers of one renderer. Each is bound as long as it lives: in all descriptor sets, of which there is one for
/// every band of the picture, but where every band has a buffer of its own.
class Buffers {
public:
    Buffers(Device& device, Bindings& bindings) : device_(device), bindings_(bindings) {}

    /// A buffer, or one for every band, of `entries` zeros, in place of what stood there. Throws
    /// Error(out_of_device_memory).
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

    /// There must be one of its own: not one that was lent. band: of those of which every band has one.
    Buffer& at(Binding binding, std::uint32_t band = 0) { return buffers_.at(binding).at(band); }
    const Buffer& at(Binding binding, std::uint32_t band = 0) const { return buffers_.at(binding).at(band); }

    /// Bytes of all of them, and of those that were lent.
    std::map<Binding, std::uint64_t> bytes() const;

private:
    void allocate_bytes(Binding binding, std::uint64_t bytes);

    Device& device_;
    Bindings& bindings_;
    std::map<Binding, std::vector<Buffer>> buffers_;
    std::map<Binding, const Buffer*> lent_;
};

/// Bytes of buffers by what they have entries for; what has no such measure comes last. They sum to all buffers'.
std::vector<MemoryReport> memory_of(const std::map<Binding, std::uint64_t>& bytes, std::uint32_t bands);

}  // namespace vkcppm
