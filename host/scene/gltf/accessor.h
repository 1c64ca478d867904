#pragma once
// Typed elements out of raw bytes: the arithmetic of a glTF accessor, without the file around it.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace vkcppm {

/// glTF's numbers for the type of a component.
enum class ComponentType : int { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };

/// Size of a component in bytes, or 0 where `type` is none of the above.
std::size_t component_size(ComponentType type);

/// Equally spaced elements: element i starts at byte i * stride.
struct ElementBytes {
    std::span<const std::uint8_t> bytes;
    std::size_t stride = 0;
};

/// Whether `count` >= 1 elements of `size` bytes, `stride` apart, lie within `available` bytes from `offset` on. No sum
/// overflows.
bool elements_fit(std::size_t offset, std::size_t count, std::size_t stride, std::size_t size, std::size_t available);

/// Values that replace some of the base's. The indices must rise and lie below the accessor's count.
struct SparseBytes {
    std::size_t count = 0;
    ComponentType index_type = ComponentType::u32;  // u8, u16 or u32
    ElementBytes indices;                           // [count]
    ElementBytes values;                            // [count], of the accessor's type
};

/// An accessor whose ranges have been checked with elements_fit.
struct AccessorView {
    std::size_t count = 0;
    ComponentType type = ComponentType::f32;
    bool normalized = false;           // integers map to [0, 1] or [-1, 1] (glTF 2.0, section 3.11)
    std::optional<ElementBytes> base;  // [count]; zeros where absent
    std::optional<SparseBytes> sparse;
};

/// The first sparse index that does not rise or is not below the count, where there is one.
std::optional<std::size_t> bad_sparse_index(const AccessorView& accessor);

/// [count] vectors of N components: 2, 3 or 4.
template <int N> std::vector<glm::vec<N, double>> read_vectors(const AccessorView& accessor);

/// [count x components] the components of all elements, one after the other; of a matrix its columns.
std::vector<double> read_numbers(const AccessorView& accessor, std::size_t components);

/// [count] unsigned integers; the type is u8, u16 or u32.
std::vector<std::uint32_t> read_indices(const AccessorView& accessor);

}  // namespace vkcppm
