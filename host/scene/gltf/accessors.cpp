#include "scene/gltf/accessors.h"

#include <tiny_gltf.h>

#include "scene/bad_scene.h"
#include "scene/gltf/limits.h"

namespace vkcppm {

namespace {

bool is_unsigned(ComponentType type) {
    return type == ComponentType::u8 || type == ComponentType::u16 || type == ComponentType::u32;
}

}  // namespace

GltfAccessors::GltfAccessors(const GltfFile& file, const tinygltf::Model& model, GltfViews& views)
    : file_(file), model_(model), views_(views) {}

std::size_t GltfAccessors::count(int accessor) const { return model_.accessors[accessor].count; }

std::string GltfAccessors::name(int accessor) const {
    const std::size_t own = model_.accessors.size() - file_.decoded.size(), i = std::size_t(accessor);
    return fmt::format("accessors[{}]", i < own ? i : file_.decoded[i - own]);
}

int GltfAccessors::components(int accessor) const {
    return tinygltf::GetNumComponentsInType(model_.accessors[accessor].type);
}

template <int N> const SharedVectors<N>& GltfAccessors::vectors(int accessor, std::string_view use) {
    SharedVectors<N>& cached = std::get<Cache<N>>(caches_)[accessor];
    if (!cached) {
        const AccessorView source = view(accessor, N, use);
        read_vectors_ += source.count;
        check_total(read_vectors_, max_read_vectors, "vectors that the meshes read", file_);
        cached = std::make_shared<const std::vector<glm::vec<N, double>>>(read_vectors<N>(source));
    }
    return cached;
}

template const SharedVectors<2>& GltfAccessors::vectors<2>(int, std::string_view);
template const SharedVectors<3>& GltfAccessors::vectors<3>(int, std::string_view);
template const SharedVectors<4>& GltfAccessors::vectors<4>(int, std::string_view);

std::vector<double> GltfAccessors::numbers(int accessor, int components, std::string_view use) {
    const AccessorView source = view(accessor, components, use);
    read_vectors_ += source.count * std::size_t((components + 3) / 4);
    check_total(read_vectors_, max_read_vectors, "vectors that the meshes read", file_);
    return read_numbers(source, std::size_t(components));
}

GltfAccessors::Indices GltfAccessors::indices(int accessor) {
    const AccessorView source = view(accessor, 1, "indices");
    if (!is_unsigned(source.type)) {
        bad_scene(file_.name, name(accessor) + ".componentType", fmt::to_string(int(source.type)),
                  "not a type of indices");
    }
    return {read_indices(source), UINT32_MAX >> (32 - 8 * component_size(source.type))};
}

/// `count` elements of `size` bytes from `offset` on in a view, as far apart as it states unless they are packed.
ElementBytes GltfAccessors::elements(int view, std::size_t offset, std::size_t count, std::size_t size,
                                     const std::string& object, bool packed) {
    if (count == 0) return {};
    const std::size_t stride = packed || views_.stride(view) == 0 ? size : views_.stride(view);
    if (stride < size) {
        bad_scene(file_.name, fmt::format("bufferViews[{}].byteStride", view), fmt::to_string(stride),
                  fmt::format("an element of {} has {} bytes", object, size));
    }
    if (!elements_fit(offset, count, stride, size, views_.size(view))) {
        bad_scene(file_.name, object,
                  fmt::format("{} elements of {} bytes, {} apart, from {} on", count, size, stride, offset),
                  fmt::format("bufferViews[{}] has {} bytes", view, views_.size(view)));
    }
    return {views_.bytes(view).subspan(offset, (count - 1) * stride + size), stride};
}

/// The checked view of an accessor of `components` (1: SCALAR, 3: VEC3) that serves as `use`.
AccessorView GltfAccessors::view(int accessor, int components, std::string_view use) {
    const tinygltf::Accessor& source = model_.accessors[accessor];
    const std::string object = name(accessor);
    AccessorView view;
    view.count = source.count;
    view.type = ComponentType(source.componentType);
    view.normalized = source.normalized;
    const std::size_t size = component_size(view.type) * components;
    if (size == 0) {
        bad_scene(file_.name, object + ".componentType", fmt::to_string(source.componentType),
                  fmt::format("not a type of {}", use));
    }
    if (const int found = this->components(accessor); found != components) {
        bad_scene(file_.name, object + ".type", fmt::format("of {} components", found),
                  fmt::format("{} needs {}", use, components));
    }
    if (std::size_t(source.bufferView) < views_.count()) {
        view.base = elements(source.bufferView, source.byteOffset, source.count, size, object, false);
    }
    if (source.sparse.isSparse) {
        const auto& sparse = source.sparse;
        SparseBytes bytes;
        bytes.count = std::size_t(sparse.count);
        bytes.index_type = ComponentType(sparse.indices.componentType);
        if (!is_unsigned(bytes.index_type)) {
            bad_scene(file_.name, object + ".sparse.indices.componentType",
                      fmt::to_string(sparse.indices.componentType), "it must be 5121, 5123 or 5125");
        }
        bytes.indices = elements(sparse.indices.bufferView, std::size_t(sparse.indices.byteOffset), bytes.count,
                                 component_size(bytes.index_type), object + ".sparse.indices", true);
        bytes.values = elements(sparse.values.bufferView, std::size_t(sparse.values.byteOffset), bytes.count, size,
                                object + ".sparse.values", true);
        view.sparse = bytes;
    }
    if (const auto bad = bad_sparse_index(view)) {
        bad_scene(file_.name, fmt::format("{}.sparse.indices element {}", object, *bad), "out of order or range",
                  fmt::format("they must rise and lie below {}", view.count));
    }
    return view;
}

}  // namespace vkcppm
