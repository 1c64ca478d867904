// Rooms whose ball and pane are instances of shared meshes, in mirrored and sheared spaces of their own, against the
// same rooms of triangles in world space: block means agree by a paired test. Random numbers are the same in both, so
// that most paths are, too, and what differs is seen far below the noise of a picture.

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "core/metrics.h"
#include "scene/instances.h"
#include "support/scenes/instanced.h"
#include "support/scenes/rooms.h"
#include "support/statistics/blocks.h"

namespace vkcppm::test {
namespace {

/// Turned, stretched, sheared and mirrored, and far from its origin.
glm::dmat4 crooked(double size) {
    glm::dmat4 m = glm::translate(glm::dmat4(1.0), glm::dvec3(0.7, 0.4, 0.9));
    m = glm::rotate(m, 1.1, glm::normalize(glm::dvec3(1.0, 2.0, -0.5)));
    m = glm::scale(m, size * glm::dvec3(-1.0, 0.6, 1.7));
    glm::dmat4 shear(1.0);
    shear[1][0] = 0.8;
    return m * shear * glm::translate(glm::dmat4(1.0), glm::dvec3(3.0, -1.0, 2.0));
}

void expect_like_copies(const Scene& room, const Settings& settings) {
    Scene instanced = room;
    for (const std::uint32_t material : {2u, 3u}) {  // the ball, the pane
        const bool used =
            std::ranges::any_of(room.triangles, [=](const Triangle& t) { return t.material == material; });
        if (!used || room.materials[material].emission != glm::vec3(0.0f)) continue;
        instanced = shared(instanced, material, crooked(material == 2 ? 1e-3 : 50.0));
    }
    ASSERT_FALSE(instanced.instances.empty());
    const TwoScenes pictures = render_two_scenes(instanced, room, settings, 12);
    expect_blocks_agree(pictures, {.side = 4, .bias = 0.005}, "instances over copies");
}

Settings quick() {
    Settings settings;
    settings.size = Extent{32, 32};
    settings.iterations = 12;
    settings.photons = 16384;
    return settings;
}

class InstancedRooms : public testing::TestWithParam<Case> {};

TEST_P(InstancedRooms, LookLikeTheirCopies) {
    Scene room = make_room();
    Settings settings = quick();
    GetParam().change(room, settings);
    expect_like_copies(room, settings);
}

/// One normal all over the texture, which leans to one side: its image in a mirror leans to the other.
Scene leaning_room(Settings& settings) {
    Scene room = make_room();
    std::ranges::find(material_cases(), std::string("normal_map"), &Case::name)->change(room, settings);
    std::vector<std::uint8_t>& texels = room.images.back().rgba;
    for (std::size_t i = 0; i < texels.size(); i += 4) {
        texels[i] = 128;
        texels[i + 1] = 220;
        texels[i + 2] = 216;
    }
    return room;
}

TEST(InstancedRoom, LeansNormalsAsItsCopyDoes) {
    Settings settings = quick();
    const Scene room = leaning_room(settings);
    expect_like_copies(room, settings);
}

TEST(InstancedRoom, LeansNormalsByTangentsOfTheFileAsItsCopyDoes) {
    Settings settings = quick();
    Scene room = leaning_room(settings);
    for (const glm::vec3& n : room.normals) {
        room.tangents.emplace_back(glm::normalize(glm::cross(n, glm::vec3(0.48f, 0.6f, 0.64f))), 1.0f);
    }
    expect_like_copies(room, settings);
}

std::string name_of(const testing::TestParamInfo<Case>& info) { return info.param.name; }

/// The rooms that have what an instance places: sides, lengths within a solid, normals, tangents, coordinates, holes.
/// The others' lobes are the same functions of the same surface.
std::vector<Case> rooms_of_instances() {
    std::vector<Case> rooms;
    for (const char* name :
         {"metal_02", "clearcoat_04", "glass", "glass_rough", "absorption", "thin", "blend", "mask", "textures",
          "normal_map", "anisotropy", "anisotropy_glass", "sheen", "lens", "environment"}) {
        const auto room = std::ranges::find(material_cases(), std::string(name), &Case::name);
        if (room == material_cases().end()) throw std::logic_error(fmt::format("there is no room '{}'", name));
        rooms.push_back(*room);
    }
    return rooms;
}

INSTANTIATE_TEST_SUITE_P(Features, InstancedRooms, testing::ValuesIn(rooms_of_instances()), name_of);

}  // namespace
}  // namespace vkcppm::test
