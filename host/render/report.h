#pragma once
// What a render did: for --stats, the progress line and the EXR's attributes.

#include <cstdint>
#include <string>
#include <vector>

namespace vkcppm {

/// One kind of pass. device_seconds by timestamps, summed over calls.
struct PassReport {
    std::string name;
    std::uint64_t calls = 0;
    double device_seconds = 0.0;
    std::string form = {};  // of the kernel, where it was chosen by measurement; else empty
};

/// Buffers of the device that hold an entry for each of something: pixels, photon slots, triangles, ...
struct MemoryReport {
    std::string of;  // what there are `count` of
    std::uint64_t count = 0;
    std::uint64_t bytes = 0;  // of all of them

    double bytes_each() const { return count > 0 ? double(bytes) / double(count) : 0.0; }
};

struct Report {
    std::vector<PassReport> passes;  // in the order in which an iteration runs them
    std::uint64_t iterations = 0;
    std::uint64_t emitted_paths = 0;
    std::uint64_t stored_photons = 0;
    std::uint64_t rays = 0;                 // rays traced by eye and photon passes
    std::uint64_t invalid = 0;              // contributions that were not finite and were dropped
    double wall_seconds = 0.0;              // of the iterations: not loading, compiling, measuring, writing
    double cpu_seconds = 0.0;               // user + system of this process, over the same span
    double setup_seconds = 0.0;             // wall: BVH, upload, pipelines
    std::uint64_t peak_memory_bytes = 0;    // resident set of the process
    std::uint64_t device_memory_bytes = 0;  // allocated on the device, at most at a time
    std::vector<MemoryReport> memory;       // allocated on the device by a render at its end
    std::string device;                     // name
    std::string driver;                     // name and version
};

}  // namespace vkcppm
