#pragma once
// One point against all photons, one by one.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace vkcppm::oracle {

struct Photon {
    glm::dvec3 position;  // m
    glm::dvec3 normal;    // unit, geometric, on the side the photon arrived from
    glm::dvec3 flux;      // W a channel, or what else the caller sums (psi)
};

struct GatherPoint {
    glm::dvec3 position;            // m
    glm::dvec3 normal;              // unit, shading, on the side the path arrived from
    glm::dvec3 tangent, bitangent;  // unit, across the normal: sector 0 starts at the tangent
    std::uint32_t rings = 2, sectors = 6;
};

struct Gathered {
    std::uint64_t count = 0;             // accepted photons
    glm::dvec3 flux{0.0};                // their sum (Phi)
    std::vector<std::uint32_t> tallies;  // [rings x sectors] accepted photons a cell
    std::vector<glm::dvec3> cell_flux;   // [rings x sectors] their flux
};

/// Whether the photon's surface faces as the point's does: dot of the normals at least 0.1.
bool accepts(const GatherPoint& point, const Photon& photon);

/// All accepted photons with |y - x| < radius. Cell: ring = floor(rings |v|^2 / radius^2) of equal areas,
/// sector = floor(sectors angle / 2 pi), angle = atan2(v . bitangent, v . tangent) in [0, 2 pi), v = y - x.
Gathered gather(const GatherPoint& point, double radius, std::span<const Photon> photons);

/// Distance to the k-th nearest accepted photon (k from 1); none where there are fewer.
std::optional<double> kth_nearest_distance(const GatherPoint& point, std::uint32_t k, std::span<const Photon> photons);

}  // namespace vkcppm::oracle
