#include "scene/gltf/accessor.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <limits>

namespace vkcppm {

namespace {

static_assert(std::endian::native == std::endian::little, "glTF buffers are little-endian");

template <typename T> T load(const std::uint8_t* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);  // a hostile file need not align its elements
    return value;
}

/// An integer component, normalized to [0, 1] or [-1, 1] (glTF 2.0, section 3.11).
template <typename T> double load_integer(const std::uint8_t* bytes, bool normalized) {
    const double value = load<T>(bytes);
    return normalized ? std::max(value / std::numeric_limits<T>::max(), -1.0) : value;
}

double load_component(const std::uint8_t* bytes, ComponentType type, bool normalized) {
    switch (type) {
        case ComponentType::i8: return load_integer<std::int8_t>(bytes, normalized);
        case ComponentType::u8: return load_integer<std::uint8_t>(bytes, normalized);
        case ComponentType::i16: return load_integer<std::int16_t>(bytes, normalized);
        case ComponentType::u16: return load_integer<std::uint16_t>(bytes, normalized);
        case ComponentType::u32: return load_integer<std::uint32_t>(bytes, normalized);
        case ComponentType::f32: return load<float>(bytes);
    }
    assert(false && "the component type was checked");
    return 0.0;
}

std::uint32_t load_index(const ElementBytes& elements, std::size_t i, ComponentType type) {
    const std::uint8_t* bytes = elements.bytes.data() + i * elements.stride;
    switch (type) {
        case ComponentType::u8: return *bytes;
        case ComponentType::u16: return load<std::uint16_t>(bytes);
        case ComponentType::u32: return load<std::uint32_t>(bytes);
        default: assert(false && "the index type was checked"); return 0;
    }
}

/// [count] elements: zeros, then the base, then the sparse values over it. load(elements, i) gives element i.
template <typename T, typename Load> std::vector<T> read(const AccessorView& accessor, const Load& load) {
    std::vector<T> elements(accessor.count, T(0));
    if (accessor.base) {
        for (std::size_t i = 0; i < accessor.count; ++i) elements[i] = load(*accessor.base, i);
    }
    if (accessor.sparse) {
        const SparseBytes& sparse = *accessor.sparse;
        for (std::size_t i = 0; i < sparse.count; ++i) {
            elements[load_index(sparse.indices, i, sparse.index_type)] = load(sparse.values, i);
        }
    }
    return elements;
}

}  // namespace

std::size_t component_size(ComponentType type) {
    switch (type) {
        case ComponentType::i8:
        case ComponentType::u8: return 1;
        case ComponentType::i16:
        case ComponentType::u16: return 2;
        case ComponentType::u32:
        case ComponentType::f32: return 4;
    }
    return 0;
}

bool elements_fit(std::size_t offset, std::size_t count, std::size_t stride, std::size_t size, std::size_t available) {
    if (offset > available || size > available - offset) return false;
    return count - 1 <= (available - offset - size) / stride;
}

std::optional<std::size_t> bad_sparse_index(const AccessorView& accessor) {
    if (!accessor.sparse) return std::nullopt;
    std::size_t least = 0;
    for (std::size_t i = 0; i < accessor.sparse->count; ++i) {
        const std::size_t index = load_index(accessor.sparse->indices, i, accessor.sparse->index_type);
        if (index < least || index >= accessor.count) return i;
        least = index + 1;
    }
    return std::nullopt;
}

template <int N> std::vector<glm::vec<N, double>> read_vectors(const AccessorView& accessor) {
    const std::size_t size = component_size(accessor.type);
    return read<glm::vec<N, double>>(accessor, [&](const ElementBytes& elements, std::size_t i) {
        const std::uint8_t* bytes = elements.bytes.data() + i * elements.stride;
        glm::vec<N, double> value;
        for (int c = 0; c < N; ++c) value[c] = load_component(bytes + c * size, accessor.type, accessor.normalized);
        return value;
    });
}

template std::vector<glm::dvec2> read_vectors<2>(const AccessorView&);
template std::vector<glm::dvec3> read_vectors<3>(const AccessorView&);
template std::vector<glm::dvec4> read_vectors<4>(const AccessorView&);

std::vector<double> read_numbers(const AccessorView& accessor, std::size_t components) {
    const std::size_t size = component_size(accessor.type);
    std::vector<double> numbers(accessor.count * components);
    const auto load = [&](const ElementBytes& elements, std::size_t from, std::size_t to) {
        const std::uint8_t* bytes = elements.bytes.data() + from * elements.stride;
        for (std::size_t c = 0; c < components; ++c) {
            numbers[to * components + c] = load_component(bytes + c * size, accessor.type, accessor.normalized);
        }
    };
    for (std::size_t i = 0; accessor.base && i < accessor.count; ++i) load(*accessor.base, i, i);
    for (std::size_t i = 0; accessor.sparse && i < accessor.sparse->count; ++i) {
        load(accessor.sparse->values, i, load_index(accessor.sparse->indices, i, accessor.sparse->index_type));
    }
    return numbers;
}

std::vector<std::uint32_t> read_indices(const AccessorView& accessor) {
    return read<std::uint32_t>(
        accessor, [&](const ElementBytes& elements, std::size_t i) { return load_index(elements, i, accessor.type); });
}

}  // namespace vkcppm
