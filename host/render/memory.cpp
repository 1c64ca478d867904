#include "render/memory.h"

#include <cstdint>
#include <map>
#include <utility>

#include "shared/bindings.h"
#include "shared/types.h"

namespace vkcppm {
namespace {

/// The first of the bindings has exactly one entry of `size` bytes for each.
struct Kind {
    const char* of;
    std::uint64_t size;
    std::vector<std::uint32_t> bindings;
};

const std::vector<Kind>& kinds() {
    static const std::vector<Kind> all = {
        {"pixel",
         sizeof(gpu::PixelState),
         {BIND_PIXELS, BIND_HIT_POSITION, BIND_HIT_WEIGHT, BIND_HIT_EMISSION, BIND_HIT_SURFACE, BIND_GATHERED,
          BIND_LIGHT_RAYS, BIND_SEARCHES, BIND_TALLY, BIND_MOMENTS, BIND_FILM, BIND_CURSOR, BIND_NEAREST, BIND_IMAGE,
          BIND_AOVS}},
        {"photon slot",
         sizeof(gpu::Photon),
         {BIND_PHOTONS, BIND_PHOTON_FLUX, BIND_SORTED, BIND_SORTED_FLUX, BIND_PAIRS_A, BIND_PAIRS_B}},
        {"lane of light paths", sizeof(gpu::PathState), {BIND_PATHS}},
        {"counter of the grid", sizeof(std::uint32_t), {BIND_COUNTERS}},
        {"triangle",
         sizeof(gpu::TriangleGeometry),
         {BIND_TRIANGLES, BIND_SHADING, BIND_TEXCOORDS, BIND_VERTEX_COLORS, BIND_TANGENTS}},
        {"node", sizeof(gpu::BvhNode), {BIND_NODES}},
        {"light", sizeof(gpu::Light), {BIND_LIGHTS}},
        {"material", sizeof(gpu::SurfaceMaterial), {BIND_MATERIALS}},
        {"texel", sizeof(std::uint32_t), {BIND_TEXELS}},
        {"environment pixel", sizeof(gpu::vec4), {BIND_ENVIRONMENT, BIND_ENVIRONMENT_ALIAS}},
    };
    return all;
}

constexpr std::uint64_t empty_bytes = 16;  // of a buffer that holds nothing

}  // namespace

std::vector<MemoryReport> memory_of(const SceneBuffers& buffers) {
    std::map<std::uint32_t, std::uint64_t> left = buffers.bytes();
    std::vector<MemoryReport> memory;
    for (const Kind& kind : kinds()) {
        if (left[kind.bindings.front()] <= empty_bytes) continue;
        MemoryReport row{kind.of, left[kind.bindings.front()] / kind.size, 0};
        for (const std::uint32_t binding : kind.bindings) {
            if (left[binding] > empty_bytes) row.bytes += std::exchange(left[binding], 0);
        }
        memory.push_back(row);
    }
    MemoryReport rest{"rest", 1, 0};
    for (const auto& [binding, bytes] : left) rest.bytes += bytes;
    memory.push_back(rest);
    return memory;
}

}  // namespace vkcppm
