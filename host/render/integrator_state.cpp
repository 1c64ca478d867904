// What an integrator holds between passes and between iterations: told by hash, put down and taken up again.

#include <algorithm>
#include <cassert>
#include <cstddef>

#include <fmt/format.h>

#include "core/error.h"
#include "core/fnv1a.h"
#include "render/grid.h"
#include "render/integrator.h"

namespace vkcppm {
namespace {

/// Of the status, what the next plan of the grid is made from: an iteration leaves it to the next, beside the buffers
/// that are carried.
constexpr std::size_t planned_from = offsetof(gpu::Status, photons);

std::span<const std::byte> planned(const gpu::Status& status) {
    return std::as_bytes(std::span(&status, 1)).subspan(planned_from);
}

class Hasher {
public:
    /// The first `bytes` bytes, or all.
    void add(const Buffer& buffer, std::uint64_t bytes) { hash_ = fnv1a(buffer.download<std::uint8_t>(bytes), hash_); }
    void add(const Buffer& buffer) { add(buffer, buffer.bytes()); }
    void add(std::span<const std::byte> bytes) { hash_ = fnv1a_of(bytes, hash_); }
    template <typename T> void add(const T& value) { hash_ = fnv1a_of(std::span(&value, 1), hash_); }
    std::uint64_t hash() const { return hash_; }

private:
    std::uint64_t hash_ = fnv1a_start;
};

}  // namespace

/// Bytes of save().
std::uint64_t Integrator::state_bytes() const {
    std::uint64_t bytes = sizeof(gpu::Status) - planned_from;
    for (const BufferRow& row : buffer_rows()) {
        if (row.life == Life::carried) bytes += buffers_.at(row.binding).bytes();
    }
    return bytes;
}

std::vector<std::byte> Integrator::save() const {
    std::vector<std::byte> state;
    state.reserve(state_bytes());
    const auto append = [&](std::span<const std::byte> bytes) {
        state.insert(state.end(), bytes.begin(), bytes.end());
    };
    const gpu::Status status = buffers_.at(Binding::status).download_value<gpu::Status>();
    append(planned(status));
    for (const BufferRow& row : buffer_rows()) {
        if (row.life != Life::carried) continue;
        const Buffer& buffer = buffers_.at(row.binding);
        append(buffer.download<std::byte>(buffer.bytes()));
    }
    return state;
}

void Integrator::restore(const Report& report, std::span<const std::byte> state) {
    gpu::Status status{};
    const std::uint64_t bytes = state_bytes();
    if (state.size() != bytes) {
        throw Error(ExitCode::bad_scene,
                    fmt::format("the checkpoint's state has {} bytes, that of this render {}", state.size(), bytes));
    }
    const auto take = [&](std::uint64_t count) {
        const std::span<const std::byte> taken = state.first(count);
        state = state.subspan(count);
        return taken;
    };
    std::ranges::copy(take(sizeof(status) - planned_from), reinterpret_cast<std::byte*>(&status) + planned_from);
    for (const BufferRow& row : buffer_rows()) {
        if (row.life == Life::carried) buffer(row.binding).upload(take(buffer(row.binding).bytes()));
    }
    const auto grid = buffer(Binding::grid).download_value<gpu::Grid>();
    if (!grid_fits(grid, params_)) {
        throw Error(ExitCode::bad_scene,
                    fmt::format("the checkpoint's grid of {} levels in {} entries is not one of this render, which has "
                                "room for {} in {}",
                                grid.levels, grid.entries, params_.most_levels, params_.cells));
    }
    const std::uint32_t levels = levels_that_fit(grid.levels);
    if (levels < grid.levels) limit_levels(levels);
    if (levels > params_.grid_levels) add_levels(levels);
    status.completed = std::uint32_t(report.iterations);
    buffer(Binding::status).upload_value(status);
    completed_ = status.completed;
    rays_ = report.rays;
    stored_ = report.stored_photons;
    invalid_ = report.invalid;
    for (auto& [id, kernel] : kernels_) {
        for (const PassReport& then : report.passes) {
            if (kernel.report.name == then.name) kernel.report = then;
        }
    }
}

std::uint64_t Integrator::hash_of(Pass pass) const {
    Hasher hasher;
    const auto covers = [&](Hashed hashed) {
        switch (hashed) {
            case Hashed::eye: return pass == Pass::eye;
            case Hashed::gather: return pass == Pass::gather;
            case Hashed::update: return pass == Pass::update;
            case Hashed::from_knn: return pass >= Pass::knn;
            case Hashed::never:
            case Hashed::apart: break;
        }
        return false;
    };
    for (const BufferRow& row : buffer_rows()) {
        if (covers(row.hashed)) hasher.add(buffers_.at(row.binding));
    }
    switch (pass) {
        case Pass::eye: {
            const Buffer& surfaces = buffers_.at(Binding::hit_surface);
            if (surfaces.bytes() < pixels_ * sizeof(gpu::HitSurface)) break;
            // Pixels that gather nothing hold the surface of an earlier iteration.
            const auto hits = buffers_.at(Binding::hit_position).download<gpu::HitPosition>(pixels_);
            const auto surface = surfaces.download<gpu::HitSurface>(pixels_);
            for (std::uint64_t i = 0; i < pixels_; ++i) {
                if (hits[i].state & HIT_DIFFUSE) hasher.add(surface[i]);
            }
            break;
        }
        case Pass::photon: {
            // In the order of paths, whatever the lanes and their slots.
            const std::uint64_t paths = params_.photons, counts_at = COUNTERS_OF_PATHS(params_);
            const std::uint64_t slots_at = COUNTERS_OF_SLOTS(params_);
            const auto counters = buffers_.at(Binding::counters).download<std::uint32_t>(slots_at + paths);
            const std::uint64_t slots = std::uint64_t(params_.photon_lanes) * params_.photon_capacity;
            const auto photons = buffers_.at(Binding::photons).download<gpu::Photon>(slots);
            const auto flux = buffers_.at(Binding::photon_flux).download<gpu::PhotonFlux>(slots);
            for (std::uint64_t path = 0; path < paths; ++path) {
                const std::uint64_t begin = counters[slots_at + path], end = begin + counters[counts_at + path];
                assert(end <= slots);
                for (std::uint64_t i = begin; i < end; ++i) {
                    hasher.add(photons[i]);
                    hasher.add(flux[i]);
                }
            }
            break;
        }
        case Pass::grid: {
            const auto grid = buffers_.at(Binding::grid).download_value<gpu::Grid>();
            const auto starts = buffers_.at(Binding::counters).download<std::uint32_t>(std::uint64_t(grid.entries) + 1);
            const std::uint64_t photons = starts.back();
            hasher.add(grid);
            hasher.add(buffers_.at(Binding::counters), starts.size() * sizeof(std::uint32_t));
            hasher.add(buffers_.at(Binding::sorted), photons * sizeof(gpu::Photon));
            hasher.add(buffers_.at(Binding::sorted_flux), photons * sizeof(gpu::PhotonFlux));
            break;
        }
        case Pass::update: hasher.add(planned(buffers_.at(Binding::status).download_value<gpu::Status>())); break;
        case Pass::knn:
        case Pass::gather:
        case Pass::picture:
        case Pass::trace: break;
    }
    return hasher.hash();
}

}  // namespace vkcppm
