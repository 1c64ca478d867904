#include "oracle/gather.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace vkcppm::oracle {

bool accepts(const GatherPoint& point, const Photon& photon) { return glm::dot(photon.normal, point.normal) >= 0.1; }

Gathered gather(const GatherPoint& point, double radius, std::span<const Photon> photons) {
    Gathered result;
    result.tallies.resize(std::size_t(point.rings) * point.sectors);
    result.cell_flux.resize(result.tallies.size(), glm::dvec3(0.0));
    for (const Photon& photon : photons) {
        const glm::dvec3 offset = photon.position - point.position;
        const double relative = glm::length(offset) / radius;
        if (!(glm::length(offset) < radius) || !accepts(point, photon)) continue;
        const double turn =
            std::atan2(glm::dot(offset, point.bitangent), glm::dot(offset, point.tangent)) / (2.0 * std::numbers::pi);
        const double positive_turn = turn < 0.0 ? turn + 1.0 : turn;
        const auto sector = std::min(point.sectors - 1, std::uint32_t(point.sectors * positive_turn));
        const auto ring = std::min(point.rings - 1, std::uint32_t(point.rings * relative * relative));
        const std::size_t cell = std::size_t(ring) * point.sectors + sector;
        ++result.count;
        ++result.tallies[cell];
        result.flux += photon.flux;
        result.cell_flux[cell] += photon.flux;
    }
    return result;
}

std::optional<double> kth_nearest_distance(const GatherPoint& point, std::uint32_t k, std::span<const Photon> photons) {
    assert(k >= 1);
    std::vector<double> distances;
    for (const Photon& photon : photons) {
        if (accepts(point, photon)) distances.push_back(glm::distance(photon.position, point.position));
    }
    if (distances.size() < k) return std::nullopt;
    std::nth_element(distances.begin(), distances.begin() + (k - 1), distances.end());
    return distances[k - 1];
}

}  // namespace vkcppm::oracle
