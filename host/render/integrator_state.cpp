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

}  // namespace

/// What a pass wrote, array by array, to be hashed one after the other: in parts, a band of the picture each, so that
/// the hash is the same however many there are.
class Integrator::Written {
public:
    /// What is added next belongs to the first array, as all that follows does to those behind it.
    void begin_part() { next_ = 0; }
    void add(std::span<const std::byte> bytes) {
        if (next_ == arrays_.size()) arrays_.emplace_back();
        std::vector<std::byte>& array = arrays_[next_++];
        array.insert(array.end(), bytes.begin(), bytes.end());
    }
    std::uint64_t hash() const {
        std::uint64_t hash = fnv1a_start;
        for (const std::vector<std::byte>& array : arrays_) hash = fnv1a_of(std::span<const std::byte>(array), hash);
        return hash;
    }

private:
    std::vector<std::vector<std::byte>> arrays_;
    std::size_t next_ = 0;
};

/// Entries that a row has for a pixel: as many arrays stand one after the other in its buffer, each of all pixels.
std::uint64_t Integrator::arrays_of(const BufferRow& row) const { return entries_of(row, counts_) / bands_.each; }

/// Calls use(buffer, first byte, bytes) for all that an iteration leaves to the next, in an order that is the same
/// however many bands there are. Buffers: those of this integrator, const or not.
template <typename Buffers, typename Use> void Integrator::each_carried(Buffers& buffers, Use use) const {
    for (const BufferRow& row : buffer_rows()) {
        if (row.life == Life::scratch) continue;
        if (row.per != Per::pixel) {
            use(buffers.at(row.binding), 0, buffers.at(row.binding).bytes());
            continue;
        }
        for (std::uint64_t array = 0; array < arrays_of(row); ++array) {
            for (std::uint32_t band = 0; band < bands_.count(); ++band) {
                const std::uint64_t bytes = bands_.size(band) * row.element_bytes;
                use(buffers.at(row.binding, band), array * bytes, bytes);
            }
        }
    }
}

/// Bytes of save().
std::uint64_t Integrator::state_bytes() const {
    std::uint64_t sum = sizeof(gpu::Status) - planned_from;
    each_carried(buffers_, [&](const Buffer&, std::uint64_t, std::uint64_t bytes) { sum += bytes; });
    return sum;
}

std::vector<std::byte> Integrator::save() const {
    std::vector<std::byte> state(state_bytes());
    const gpu::Status status = buffers_.at(Binding::status).download_value<gpu::Status>();
    std::ranges::copy(planned(status), state.begin());
    std::span<std::byte> rest = std::span(state).subspan(sizeof(status) - planned_from);
    each_carried(buffers_, [&](const Buffer& buffer, std::uint64_t first, std::uint64_t bytes) {
        buffer.download_to(rest.first(bytes), first);
        rest = rest.subspan(bytes);
    });
    return state;
}

void Integrator::restore(const Report& report, std::span<const std::byte> state) {
    gpu::Status status{};
    const std::uint64_t bytes = state_bytes();
    if (state.size() != bytes) {
        throw Error(ExitCode::bad_input,
                    fmt::format("the checkpoint's state has {} bytes, that of this render {}", state.size(), bytes));
    }
    const auto take = [&](std::uint64_t count) {
        const std::span<const std::byte> taken = state.first(count);
        state = state.subspan(count);
        return taken;
    };
    std::ranges::copy(take(sizeof(status) - planned_from), reinterpret_cast<std::byte*>(&status) + planned_from);
    each_carried(buffers_,
                 [&](Buffer& buffer, std::uint64_t first, std::uint64_t bytes) { buffer.upload(take(bytes), first); });
    const auto grid = buffer(Binding::grid).download_value<gpu::Grid>();
    if (!grid_fits(grid, params_)) {
        throw Error(ExitCode::bad_input,
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
    first_ = 0;
    params_.keeps_radii = 0;
    buffer(Binding::params).upload_value(params_);
    rays_ = report.rays;
    stored_ = report.stored_photons;
    invalid_ = report.invalid;
    for (auto& [id, kernel] : kernels_) {
        for (const PassReport& then : report.passes) {
            if (kernel.report.name == then.name) kernel.report = then;
        }
    }
}

/// What `pass` wrote in that band.
void Integrator::add_written(Written& written, Pass pass, std::uint32_t band) const {
    written.begin_part();
    const auto add = [&](Binding binding, std::uint64_t bytes) {
        written.add(buffers_.at(binding).download<std::byte>(bytes));
    };
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
        if (!covers(row.hashed)) continue;
        const Buffer& buffer = buffers_.at(row.binding, row.per == Per::pixel ? band : 0);
        const std::uint64_t bytes = bands_.size(band) * row.element_bytes;
        for (std::uint64_t array = 0; array < arrays_of(row); ++array) {
            written.add(buffer.download<std::byte>(bytes, array * bytes));
        }
    }
    switch (pass) {
        case Pass::eye: {
            if (!counts_.glossy) break;
            // Pixels that gather nothing hold the surface of an earlier iteration, or band.
            const auto hits = buffers_.at(Binding::hit_position).download<gpu::HitPosition>(bands_.size(band));
            auto surfaces = buffers_.at(Binding::hit_surface).download<gpu::HitSurface>(bands_.size(band));
            std::size_t kept = 0;
            for (std::size_t i = 0; i < hits.size(); ++i) {
                if (hits[i].state & HIT_DIFFUSE) surfaces[kept++] = surfaces[i];
            }
            written.add(std::as_bytes(std::span(surfaces).first(kept)));
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
            struct Stored {
                gpu::Photon photon;
                gpu::PhotonFlux flux;
            };
            std::vector<Stored> stored;
            for (std::uint64_t path = 0; path < paths; ++path) {
                const std::uint64_t begin = counters[slots_at + path], end = begin + counters[counts_at + path];
                assert(end <= slots);
                for (std::uint64_t i = begin; i < end; ++i) stored.push_back({photons[i], flux[i]});
            }
            written.add(std::as_bytes(std::span(stored)));
            break;
        }
        case Pass::grid: {
            const auto grid = buffers_.at(Binding::grid).download_value<gpu::Grid>();
            const auto starts = buffers_.at(Binding::counters).download<std::uint32_t>(std::uint64_t(grid.entries) + 1);
            const std::uint64_t photons = starts.back();
            written.add(std::as_bytes(std::span(&grid, 1)));
            written.add(std::as_bytes(std::span(starts)));
            add(Binding::sorted, photons * sizeof(gpu::Photon));
            add(Binding::sorted_flux, photons * sizeof(gpu::PhotonFlux));
            break;
        }
        case Pass::update: {
            if (band + 1 < bands_.count()) break;
            const gpu::Status status = buffers_.at(Binding::status).download_value<gpu::Status>();
            written.add(planned(status));
            break;
        }
        case Pass::knn:
        case Pass::area:
        case Pass::gather:
        case Pass::picture:
        case Pass::trace: break;
    }
}

std::vector<Integrator::PassHash> Integrator::run_hashed() {
    const std::uint32_t iteration = completed_;
    std::map<Pass, Written> written;
    const auto run = [&](Pass pass, std::uint32_t band) {
        const Part part{.from = pass, .to = pass, .first_band = band, .last_band = band};
        begin();
        iterate(iteration, part);
        finish();
        unblock(part);
        add_written(written[pass], pass, band);
    };
    for (const Pass pass : {Pass::photon, Pass::grid}) run(pass, 0);
    for (std::uint32_t band = 0; band < bands_.count(); ++band) {
        for (const Pass pass : {Pass::eye, Pass::knn, Pass::area, Pass::gather, Pass::update}) run(pass, band);
    }
    std::vector<PassHash> hashes;
    for (const auto& [pass, arrays] : written) hashes.push_back({std::string(name_of(pass)), arrays.hash()});
    return hashes;
}

}  // namespace vkcppm
