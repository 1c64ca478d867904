#include "scene/gltf/cameras.h"

#include <cfloat>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <tiny_gltf.h>

#include "scene/bad_scene.h"
#include "scene/gltf/values.h"
#include "scene/instances.h"

namespace vkcppm {

namespace {

/// A frame of orthonormal columns x, y, z whose z is along `z` and whose y is as near to `up` as that allows; nothing
/// where the two are zero or parallel.
std::optional<glm::dmat3> orthonormal_frame(const glm::dvec3& z, const glm::dvec3& up) {
    const glm::dvec3 unit_z = unit_or_zero(z);
    const glm::dvec3 unit_up = unit_or_zero(up);
    const glm::dvec3 x = glm::cross(unit_up, unit_z);
    const double sine = glm::length(x);
    if (!(sine > 1e-9)) return std::nullopt;
    return glm::dmat3(x / sine, glm::cross(unit_z, x / sine), unit_z);
}

}  // namespace

std::optional<Camera> read_camera(const GltfFile& file, const tinygltf::Model& model, const PlacedNode& placed,
                                  Warnings& warnings) {
    const int index = placed.index;
    const glm::dmat4& to_world = placed.to_world;
    const tinygltf::Node& node = model.nodes[index];
    if (node.camera < 0) return std::nullopt;
    const tinygltf::Camera& source = model.cameras[node.camera];
    const bool is_orthographic = source.type == "orthographic";
    const std::string object = fmt::format("cameras[{}].{}", node.camera, source.type);
    const auto require = [&](bool holds, const char* member, double value, std::string_view limit) {
        if (!holds) bad_scene(file.name, fmt::format("{}.{}", object, member), fmt::to_string(value), limit);
    };
    const std::optional<glm::dmat3> frame = orthonormal_frame(glm::dvec3(to_world[2]), glm::dvec3(to_world[1]));
    if (!frame) {
        warnings.add("its camera is skipped, the transform is singular", fmt::format("nodes[{}]", index));
        return std::nullopt;
    }
    Camera camera;
    camera.name = source.name.empty() ? node.name : source.name;
    camera.node = node.name;
    camera.to_world = glm::dmat4(*frame);
    camera.to_world[3] = to_world[3];
    if (is_orthographic) {
        // glTF would rather have them positive, and leaves open what else they mean.
        const double xmag = std::abs(source.orthographic.xmag), ymag = std::abs(source.orthographic.ymag);
        if (source.orthographic.xmag < 0.0 || source.orthographic.ymag < 0.0) {
            warnings.add("negative, the picture is not mirrored", object + ".xmag or .ymag");
        }
        const auto is_length = [](double mag) { return mag >= FLT_MIN && mag <= FLT_MAX; };
        require(is_length(xmag), "xmag", xmag, "it must be positive and within floats");
        require(is_length(ymag), "ymag", ymag, "it must be positive and within floats");
        camera.ymag = ymag;
        camera.aspect = xmag / ymag;
        return camera;
    }
    camera.yfov = source.perspective.yfov;
    require(camera.yfov > 0.0 && camera.yfov < std::numbers::pi, "yfov", camera.yfov, "it must lie between 0 and pi");
    if (file.document["cameras"][node.camera]["perspective"].contains("aspectRatio")) {
        const double aspect = source.perspective.aspectRatio;
        if (aspect > 0.0) {
            camera.aspect = aspect;
        } else {
            warnings.add("ignored, it must be positive", fmt::format("{}.aspectRatio = {}", object, aspect));
        }
    }
    return camera;
}

Camera framing_camera(const Scene& scene) {
    const SceneBox box = world_box(scene);
    const glm::dvec3 centre = box.is_empty() ? glm::dvec3(0.0) : 0.5 * box.low + 0.5 * box.high;
    const double radius = box.is_empty() ? 1.0 : 0.5 * glm::length(box.high - box.low);
    constexpr double margin = 1.05;
    const glm::dvec3 towards_camera = glm::normalize(glm::dvec3(0.0, 0.35, 1.0));
    Camera camera;
    camera.name = "framing";
    camera.to_world = glm::dmat4(*orthonormal_frame(towards_camera, glm::dvec3(0.0, 1.0, 0.0)));
    const double distance = margin * radius / std::sin(0.5 * camera.yfov);
    camera.to_world[3] = glm::dvec4(centre + distance * towards_camera, 1.0);
    return camera;
}

}  // namespace vkcppm
