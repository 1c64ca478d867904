#pragma once
// Embree as a second opinion on nearest hits, and as the yardstick of their speed.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include <glm/vec3.hpp>

namespace vkcppm::oracle {

class Embree {
public:
    /// triangles [T][3]: corners. `robust`: RTC_SCENE_FLAG_ROBUST, watertight and slower.
    Embree(std::span<const std::array<glm::vec3, 3>> triangles, bool robust);
    ~Embree();
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;

    struct Hit {
        float t = 0.0f;  // along the direction
        std::uint32_t triangle = 0;
    };
    /// rtcIntersect1; may be called by several threads at once.
    std::optional<Hit> nearest(const glm::vec3& origin, const glm::vec3& direction) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vkcppm::oracle
