#include "scene/gltf/accessor.h"

#include <limits>

#include <gtest/gtest.h>

namespace vkcppm {
namespace {

constexpr std::size_t huge = std::numeric_limits<std::size_t>::max();

TEST(ElementsFit, CountsTheLastElementWithoutItsGap) {
    EXPECT_TRUE(elements_fit(4, 3, 16, 12, 4 + 2 * 16 + 12));
    EXPECT_FALSE(elements_fit(4, 3, 16, 12, 4 + 2 * 16 + 11));
    EXPECT_TRUE(elements_fit(0, 1, 12, 12, 12));
    EXPECT_FALSE(elements_fit(1, 1, 12, 12, 12));
}

TEST(ElementsFit, DoesNotOverflow) {
    EXPECT_FALSE(elements_fit(0, huge, 12, 12, 1000));
    EXPECT_FALSE(elements_fit(huge, 1, 12, 12, 1000));
    EXPECT_FALSE(elements_fit(huge - 4, 2, 12, 12, huge));
    EXPECT_FALSE(elements_fit(0, (huge / 12) + 2, 12, 12, 1000));  // count * stride wraps to a small number
}

/// The first of two vectors of three components of type T that hold 0, `low` and `high`.
template <typename T> glm::dvec3 normalized(ComponentType type, T low, T high) {
    const T values[] = {T(0), low, high};
    AccessorView view;
    view.count = 1;
    view.type = type;
    view.normalized = true;
    view.base = ElementBytes{{reinterpret_cast<const std::uint8_t*>(values), sizeof values}, sizeof values};
    return read_vectors<3>(view)[0];
}

TEST(ReadVectors, NormalizesIntegersAsTheSpecificationSays) {
    EXPECT_EQ(normalized<std::int8_t>(ComponentType::i8, -128, 127), glm::dvec3(0, -1, 1));
    EXPECT_EQ(normalized<std::int8_t>(ComponentType::i8, -127, 1), glm::dvec3(0, -1, 1.0 / 127));
    EXPECT_EQ(normalized<std::uint8_t>(ComponentType::u8, 51, 255), glm::dvec3(0, 0.2, 1));
    EXPECT_EQ(normalized<std::int16_t>(ComponentType::i16, -32768, 32767), glm::dvec3(0, -1, 1));
    EXPECT_EQ(normalized<std::uint16_t>(ComponentType::u16, 13107, 65535), glm::dvec3(0, 0.2, 1));
}

TEST(BadSparseIndex, FindsWhatDoesNotRiseOrIsOutOfRange) {
    const std::uint8_t indices[] = {1, 3, 3, 9};
    AccessorView view;
    view.count = 5;
    view.sparse = SparseBytes{2, ComponentType::u8, {indices, 1}, {}};
    EXPECT_EQ(bad_sparse_index(view), std::nullopt);
    view.sparse->count = 3;
    EXPECT_EQ(bad_sparse_index(view), 2u);
    view.sparse->indices.bytes = std::span(indices).subspan(2);
    view.sparse->count = 2;
    EXPECT_EQ(bad_sparse_index(view), 1u);
}

}  // namespace
}  // namespace vkcppm
