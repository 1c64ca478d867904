#pragma once
// The accessors of a glTF file as vectors and indices, every range checked.

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "scene/gltf/accessor.h"
#include "scene/gltf/file.h"
#include "scene/gltf/views.h"

namespace tinygltf {
class Model;
}

namespace vkcppm {

/// Vectors of N components that several primitives may share.
template <int N> using SharedVectors = std::shared_ptr<const std::vector<glm::vec<N, double>>>;

/// Throws Error(bad_input) with accessor, value, limit and file where an accessor cannot be read as asked for.
class GltfAccessors {
public:
    /// `model` may name a view past the last of the file for accessors that have none. Keeps all three.
    GltfAccessors(const GltfFile& file, const tinygltf::Model& model, GltfViews& views);

    std::size_t count(int accessor) const;

    /// As the file has it, e.g. "accessors[3]".
    std::string name(int accessor) const;

    /// Components of an element, e.g. 3 for VEC3.
    int components(int accessor) const;

    /// The vectors of an accessor, read once. `use` says what for, e.g. "POSITION".
    template <int N> const SharedVectors<N>& vectors(int accessor, std::string_view use);

    /// [count x components] the numbers of an accessor, element after element; not kept. `use` as above.
    std::vector<double> numbers(int accessor, int components, std::string_view use);

    /// [count] indices, and the number of its type that is none (primitive restart).
    struct Indices {
        std::vector<std::uint32_t> values;
        std::uint32_t restart;
    };
    Indices indices(int accessor);

private:
    template <int N> using Cache = std::map<int, SharedVectors<N>>;

    AccessorView view(int accessor, int components, std::string_view use);
    ElementBytes elements(int view, std::size_t offset, std::size_t count, std::size_t size, const std::string& object,
                          bool packed);

    const GltfFile& file_;
    const tinygltf::Model& model_;
    GltfViews& views_;
    std::tuple<Cache<2>, Cache<3>, Cache<4>> caches_;
    std::size_t read_vectors_ = 0;
};

}  // namespace vkcppm
