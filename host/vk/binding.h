#pragma once
// The buffers by their rows of shaders/shared/buffers.h: where each is bound, and how kernels read it.

#include <array>
#include <cstddef>
#include <cstdint>

#include "shared/buffers.h"

namespace vkcppm {

/// A buffer by its name; the value is its binding.
enum class Binding : std::uint32_t {
#define ENUMERATOR(number, name, Element, per, entries, access, life, hashed) name = number,
    BUFFERS(ENUMERATOR)
#undef ENUMERATOR
};

/// How kernels read and write it.
enum class Access { uniform, storage, uint_texels, float_texels, word_texels, records, words };

struct BoundBuffer {
    Binding binding{};
    Access access{};
    const char* name = nullptr;
};

inline constexpr auto bound_buffers = std::to_array<BoundBuffer>({
#define BOUND(number, name, Element, per, entries, access, life, hashed) {Binding::name, Access::access, #name},
    BUFFERS(BOUND)
#undef BOUND
});

/// Rows are numbered in their order, from 0 on, and below the bindings of their texels.
constexpr bool rows_are_numbered() {
    for (std::size_t i = 0; i < bound_buffers.size(); ++i) {
        if (std::size_t(bound_buffers[i].binding) != i) return false;
    }
    return bound_buffers.size() <= TEXELS_BINDING;
}
static_assert(rows_are_numbered(), "BUFFERS of shaders/shared/buffers.h is not in the order of its numbers from 0 on");

constexpr const BoundBuffer& bound_buffer(Binding binding) { return bound_buffers[std::size_t(binding)]; }

/// True where kernels read it as texels, bound at TEXELS_BINDING + binding.
constexpr bool has_texels(Access access) { return access != Access::uniform && access != Access::storage; }

/// True where it is bound as a storage buffer.
constexpr bool has_storage(Access access) {
    return access == Access::storage || access == Access::records || access == Access::words;
}

/// Bytes of a texel of it.
constexpr std::uint64_t texel_bytes(Access access) {
    return access == Access::word_texels || access == Access::words ? 4 : 16;
}

}  // namespace vkcppm
