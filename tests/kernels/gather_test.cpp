// Nearest photons and sums over discs, against every photon for every pixel in double precision; dense rows and hash.

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/display.h"
#include "oracle/gather.h"
#include "oracle/octahedral.h"
#include "support/device/disc_field.h"
#include "support/device/gpu.h"
#include "support/device/rig.h"
#include "support/scenes/shapes.h"

namespace vkcppm::test {
namespace {

using std::numbers::pi;

// Floats of the kernels decide differently from doubles within these distances of a boundary.
constexpr double distance_rounding = 2e-6;  // relative, of squared distances
constexpr double cosine_rounding = 1e-6;    // of normals that agree
constexpr double turn_rounding = 2e-6;      // of sectors, in turns, and of rings, relative

Settings settings_of(const std::string& estimator, std::uint32_t photons) {
    Settings settings;
    settings.estimator = estimator;
    settings.size = Extent{64, 64};
    settings.photons = photons;
    settings.direct = direct_gathered;  // many photons of few paths
    return settings;
}

/// The photons of a rig in the order of the grid, with the flux that pixel normal n would add.
struct PhotonSet {
    std::vector<oracle::Photon> photons;  // flux without the correction for shading normals
    std::vector<glm::dvec3> towards;
};

PhotonSet photons_of(Rig& rig) {
    const auto counters = rig.all<std::uint32_t>(Binding::counters);
    const std::size_t count = counters[rig.integrator.buffer(Binding::grid).download_value<gpu::Grid>().entries];
    const auto sorted = rig.all<gpu::Photon>(Binding::sorted);
    const auto flux = rig.all<gpu::PhotonFlux>(Binding::sorted_flux);
    PhotonSet set;
    for (std::size_t i = 0; i < count; ++i) {
        set.photons.push_back(
            {glm::dvec3(sorted[i].position), oracle::unpack_direction(sorted[i].normal), glm::dvec3(flux[i].power)});
        set.towards.push_back(oracle::unpack_direction(flux[i].direction));
    }
    return set;
}

/// What the pixel gathers at; none where it sees no diffuse surface.
std::optional<oracle::GatherPoint> point_of(const gpu::HitPosition& position, const gpu::HitWeight& weight,
                                            const Settings& settings) {
    if ((position.state & HIT_MASK) != HIT_DIFFUSE) return std::nullopt;
    oracle::GatherPoint point;
    point.position = glm::dvec3(position.position);
    point.normal = oracle::unpack_direction(weight.normal);
    // Tangents of Duff et al. 2017, equations of their listing 3.
    const glm::dvec3 n = point.normal;
    const double sign = n.z >= 0.0 ? 1.0 : -1.0, a = -1.0 / (sign + n.z), b = n.x * n.y * a;
    point.tangent = {1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x};
    point.bitangent = {b, sign + n.y * n.y * a, -n.y};
    point.rings = settings.rings;
    point.sectors = settings.sectors;
    return point;
}

/// Photons whose acceptance, and accepted photons whose cell, rounding may decide.
struct Doubtful {
    std::size_t accepted = 0, cells = 0;
};

Doubtful doubtful(const oracle::GatherPoint& point, double radius2, const std::vector<oracle::Photon>& photons) {
    Doubtful result;
    for (const auto& photon : photons) {
        const glm::dvec3 offset = photon.position - point.position;
        const double q = glm::dot(offset, offset) / radius2;
        if (q > 1.0 + distance_rounding) continue;
        const double agreement = glm::dot(photon.normal, point.normal);
        if (std::abs(q - 1.0) <= distance_rounding || std::abs(agreement - 0.1) <= cosine_rounding) ++result.accepted;
        if (agreement < 0.1) continue;
        const double x = glm::dot(offset, point.tangent), y = glm::dot(offset, point.bitangent);
        const double length = std::hypot(x, y) / std::sqrt(radius2);
        const double sector = point.sectors * (std::atan2(y, x) / (2.0 * pi) + 1.0);
        const double turn = std::abs(sector - std::round(sector)) / point.sectors;
        const double ring = std::abs(point.rings * q - std::round(point.rings * q));
        // A photon at the pixel's own place has no direction.
        if (turn * length < turn_rounding || ring < point.rings * turn_rounding) ++result.cells;
    }
    return result;
}

std::string where(std::size_t pixel, const oracle::GatherPoint& point, double radius2) {
    return fmt::format("pixel {} at ({:.9g}, {:.9g}, {:.9g}), radius {:.9g}", pixel, point.position.x, point.position.y,
                       point.position.z, std::sqrt(radius2));
}

class Gather : public GpuTest {
protected:
    /// Runs one iteration with a table of `cells` entries (0: the default).
    static void run(Rig& rig, std::uint32_t cells) {
        gpu::Params params = rig.integrator.params();
        if (cells > 0) params.cells = cells;
        rig.integrator.set_params(params);
        rig.integrator.run(1);
        const bool hashed = rig.integrator.buffer(Binding::grid).download_value<gpu::Grid>().dims[0].w != 0;
        ASSERT_EQ(hashed, cells > 0);
    }
};

TEST_F(Gather, StartingRadiusIsTheDistanceOfTheKthNearestPhoton) {
    std::vector<std::vector<gpu::PixelState>> states;
    for (const std::uint32_t cells : {0u, 512u}) {
        SCOPED_TRACE(cells == 0 ? "dense rows" : "hash");
        // The first iteration of cppm changes no radius: k - 1 photons are fewer than a batch.
        Rig rig(room(), settings_of("cppm", 1500));
        gpu::Params params = rig.integrator.params();
        params.footprint_cap = 4.0f;  // so that some pixels find fewer than k
        params.radius_floor *= 0.5f;
        rig.integrator.set_params(params);
        run(rig, cells);
        const auto hits = rig.all<gpu::HitPosition>(Binding::hit_position);
        const auto weights = rig.all<gpu::HitWeight>(Binding::hit_weight);
        const auto emission = rig.all<gpu::HitEmission>(Binding::hit_emission);
        const auto pixels = rig.all<gpu::PixelState>(Binding::pixels);
        const auto gathered = rig.all<gpu::Gathered>(Binding::gathered);
        const PhotonSet set = photons_of(rig);
        std::size_t seeded = 0, capped = 0, doubts = 0;
        for (std::size_t i = 0; i < rig.pixels(); ++i) {
            const auto point = point_of(hits[i], weights[i], rig.settings);
            if (!point) {
                ASSERT_EQ(pixels[i].radius2, 0.0f) << "pixel " << i << " sees no diffuse surface";
                continue;
            }
            const double cap = std::min<double>(
                params.radius_cap, std::max<double>(params.radius_floor, params.footprint_cap * emission[i].footprint));
            const auto kth = oracle::kth_nearest_distance(*point, rig.settings.knn, set.photons);
            const bool found = kth && *kth < cap;
            const double want = found ? *kth * *kth : cap * cap;
            if (doubtful(*point, want, set.photons).accepted >
                (found ? 1 : 0)) {  // the k-th itself lies on the boundary
                ++doubts;
                continue;
            }
            ASSERT_EQ(pixels[i].seeded, found ? 1u : 0u)
                << where(i, *point, want) << ": k-th photon at " << kth.value_or(-1.0) << ", cap " << cap;
            ASSERT_NEAR(pixels[i].radius2, want, 1e-6 * want) << where(i, *point, want) << (found ? "" : " (the cap)");
            (found ? seeded : capped) += 1;
            if (found) {
                ASSERT_EQ(gathered[i].count, rig.settings.knn - 1) << where(i, *point, want) << ": strictly inside";
            }
        }
        EXPECT_GT(seeded, 1000u);
        EXPECT_GT(capped, 100u);
        EXPECT_LT(doubts, rig.pixels() / 100);
        states.push_back(pixels);
    }
    for (std::size_t i = 0; i < states[0].size(); ++i) {
        ASSERT_EQ(states[0][i].radius2, states[1][i].radius2) << "pixel " << i << ": dense rows and hash differ";
    }
}

TEST_F(Gather, APixelThatFoundTooFewPhotonsTriesAgain) {
    Rig rig(room(), settings_of("cppm", 400));
    rig.integrator.run(1);
    const auto before = rig.all<gpu::PixelState>(Binding::pixels);
    const std::uint32_t unseeded =
        std::uint32_t(std::count_if(before.begin(), before.end(), [](const auto& p) { return p.seeded == 0; }));
    ASSERT_GT(unseeded, 0u) << "the scene is to leave pixels without k photons";
    rig.integrator.run(30);
    const auto after = rig.all<gpu::PixelState>(Binding::pixels);
    std::uint32_t still = 0;
    for (std::size_t i = 0; i < after.size(); ++i) {
        still += after[i].seeded == 0 ? 1 : 0;
        ASSERT_TRUE(before[i].seeded == 0 || after[i].seeded == 1) << "pixel " << i << " lost its seed";
        if (before[i].radius2 > 0.0f) {
            ASSERT_LE(after[i].radius2, before[i].radius2) << "pixel " << i;
        }
    }
    EXPECT_LT(still, unseeded / 2);
}

/// Radii of every size, some smaller than a photon's distance and some larger than a wall.
std::vector<gpu::PixelState> random_radii(Rig& rig, std::uint32_t seed) {
    auto pixels = rig.all<gpu::PixelState>(Binding::pixels);
    pixels.resize(rig.pixels());
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> exponent(-3.0f, -0.5f);
    for (auto& pixel : pixels) pixel.radius2 = std::pow(std::pow(10.0f, exponent(random)), 2.0f);
    return pixels;
}

TEST_F(Gather, SumsCountsAndTalliesAreThoseOfAllPhotons) {
    std::map<std::string, std::vector<gpu::Gathered>> sums;
    std::map<std::string, std::vector<std::uint32_t>> tallies;
    struct Case {
        std::uint32_t cells, rings, sectors;
    };
    for (const Case& c : {Case{0, 2, 6}, Case{512, 2, 6}, Case{64, 4, 12}, Case{0, 1, 4}}) {
        SCOPED_TRACE(fmt::format("table of {} entries, {} rings, {} sectors", c.cells, c.rings, c.sectors));
        Settings settings = settings_of("cppm", 2400);
        settings.rings = c.rings;
        settings.sectors = c.sectors;
        Rig rig(room(), settings);
        run(rig, c.cells);
        // The same photons again, with radii of our own and an empty tally.
        const auto states = random_radii(rig, 15);
        rig.integrator.buffer(Binding::pixels).upload(states);
        const std::uint32_t bins = c.rings * c.sectors;
        rig.integrator.buffer(Binding::tally).upload(std::vector<std::uint32_t>(bins * rig.pixels()));
        gather(rig);

        const auto hits = rig.all<gpu::HitPosition>(Binding::hit_position);
        const auto weights = rig.all<gpu::HitWeight>(Binding::hit_weight);
        const auto gathered = rig.all<gpu::Gathered>(Binding::gathered);
        const auto tally = rig.all<std::uint32_t>(Binding::tally);
        PhotonSet set = photons_of(rig);
        const std::vector<oracle::Photon> plain = set.photons;
        std::size_t photons = 0, doubtful_pixels = 0, doubtful_cells = 0, smooth = 0;
        for (std::size_t i = 0; i < rig.pixels(); ++i) {
            const auto point = point_of(hits[i], weights[i], rig.settings);
            if (!point) {
                ASSERT_EQ(gathered[i].count, 0u) << "pixel " << i << " sees no diffuse surface";
                continue;
            }
            // On shaded normals: photons arrive per area of the true surface, the BRDF is that of the shaded one.
            for (std::size_t j = 0; j < plain.size(); ++j) {
                const double shading = std::max(0.0, glm::dot(set.towards[j], point->normal));
                set.photons[j].flux =
                    plain[j].flux * shading / std::max(0.01, glm::dot(set.towards[j], plain[j].normal));
            }
            const double radius2 = states[i].radius2;
            const auto want = oracle::gather(*point, std::sqrt(radius2), set.photons);
            const Doubtful doubt = doubtful(*point, radius2, set.photons);
            photons += want.count;
            smooth +=
                std::abs(std::max({std::abs(point->normal.x), std::abs(point->normal.y), std::abs(point->normal.z)}) -
                         1.0) > 1e-3
                    ? 1
                    : 0;
            ASSERT_NEAR(double(gathered[i].count), double(want.count), double(doubt.accepted))
                << where(i, *point, radius2);
            if (doubt.accepted > 0) {
                ++doubtful_pixels;
                continue;
            }
            // Rounding of n sums of positive terms, and of packed directions in the correction.
            for (int channel = 0; channel < 3; ++channel) {
                ASSERT_NEAR(gathered[i].flux[channel], want.flux[channel],
                            (1e-5 + 1.2e-7 * double(want.count)) * want.flux[channel])
                    << where(i, *point, radius2) << ", " << want.count << " photons, channel " << channel;
            }
            std::size_t differences = 0;
            for (std::uint32_t bin = 0; bin < bins; ++bin) {
                const std::int64_t got = tally[bin * rig.pixels() + i];
                differences += std::size_t(std::abs(got - std::int64_t(want.tallies[bin])));
                if (doubt.cells == 0) {
                    ASSERT_EQ(got, want.tallies[bin])
                        << where(i, *point, radius2) << ", ring " << bin / c.sectors << ", sector " << bin % c.sectors;
                }
            }
            ASSERT_LE(differences, 2 * doubt.cells) << where(i, *point, radius2);
            doubtful_cells += doubt.cells > 0 ? 1 : 0;
        }
        EXPECT_GT(photons, 20u * rig.pixels()) << "too few photons to mean anything";
        EXPECT_GT(smooth, 50u) << "pixels on shaded normals";
        EXPECT_LT(doubtful_pixels, rig.pixels() / 50);
        EXPECT_LT(doubtful_cells, rig.pixels() / 20);
        const std::string kind = fmt::format("{} x {}", c.rings, c.sectors);
        if (sums.contains(kind)) {
            for (std::size_t i = 0; i < rig.pixels(); ++i) {
                ASSERT_EQ(sums[kind][i].count, gathered[i].count) << "pixel " << i << ": dense rows and hash differ";
                ASSERT_LE(glm::distance(sums[kind][i].flux, gathered[i].flux), 1e-5f * glm::length(gathered[i].flux))
                    << "pixel " << i;
            }
            for (std::size_t i = 0; i < bins * rig.pixels(); ++i)
                ASSERT_EQ(tallies[kind][i], tally[i]) << "tally word " << i;
        }
        sums[kind] = gathered;
        tallies[kind] = tally;
    }
    EXPECT_EQ(sums.size(), 3u);
}

// What errors are estimated from: by the flux of the whole disc, of its inner half and of its inner quarter.
TEST_F(Gather, BiasIsThatOfInnerDiscs) {
    Settings settings = settings_of("cppm", 2400);
    settings.rings = 4;
    settings.sectors = 4;
    settings.error = true;
    Rig rig(room(), settings);
    run(rig, 0);
    const auto states = random_radii(rig, 17);
    rig.integrator.buffer(Binding::pixels).upload(states);
    gather(rig);
    const auto hits = rig.all<gpu::HitPosition>(Binding::hit_position);
    const auto weights = rig.all<gpu::HitWeight>(Binding::hit_weight);
    const auto paths = rig.all<gpu::EyeState>(Binding::eye_paths);
    PhotonSet set = photons_of(rig);
    const std::vector<oracle::Photon> plain = set.photons;
    std::size_t compared = 0;
    for (std::size_t i = 0; i < rig.pixels(); ++i) {
        const auto point = point_of(hits[i], weights[i], rig.settings);
        if (!point) continue;
        for (std::size_t j = 0; j < plain.size(); ++j) {
            const double shading = std::max(0.0, glm::dot(set.towards[j], point->normal));
            set.photons[j].flux = plain[j].flux * glm::dvec3(weights[i].weight) * shading /
                                  std::max(0.01, glm::dot(set.towards[j], plain[j].normal));
        }
        const double radius2 = states[i].radius2;
        const Doubtful doubt = doubtful(*point, radius2, set.photons);
        if (doubt.accepted > 0 || doubt.cells > 0) continue;
        const auto found = oracle::gather(*point, std::sqrt(radius2), set.photons);
        double ring[4] = {};
        for (std::size_t cell = 0; cell < 16; ++cell) ring[cell / 4] += luminance(found.cell_flux[cell]);
        const double disc = ring[0] + ring[1] + ring[2] + ring[3];
        const double half = 2.0 * (ring[0] + ring[1]), quarter = 4.0 * ring[0];
        const double want = (1.0 + states[i].excess) * disc - half + (2.0 + std::sqrt(2.0)) * (half - quarter);
        ASSERT_NEAR(paths[i].bias, want, 1e-4 * disc) << where(i, *point, radius2) << ", " << found.count << " photons";
        compared += found.count > 8 ? 1 : 0;
    }
    EXPECT_GT(compared, rig.pixels() / 4);
}

TEST_F(Gather, AFoldedTallyAddsOppositeSectors) {
    Rig plain(room(), settings_of("cppm", 2400)), folded(room(), settings_of("cppm-fold", 2400));
    for (Rig* rig : {&plain, &folded}) {
        rig->integrator.run(1);
        rig->integrator.buffer(Binding::pixels).upload(random_radii(*rig, 16));
        const std::size_t words = rig->integrator.buffer(Binding::tally).bytes() / 4;
        rig->integrator.buffer(Binding::tally).upload(std::vector<std::uint32_t>(words));
        gather(*rig);
    }
    const auto whole = plain.all<std::uint32_t>(Binding::tally), halves = folded.all<std::uint32_t>(Binding::tally);
    const std::size_t p = plain.pixels();
    ASSERT_EQ(whole.size(), 12 * p);
    ASSERT_EQ(halves.size(), 6 * p);
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < p; ++i) {
        for (std::size_t ring = 0; ring < 2; ++ring) {
            for (std::size_t s = 0; s < 3; ++s) {
                const std::uint32_t both = whole[(ring * 6 + s) * p + i] + whole[(ring * 6 + s + 3) * p + i];
                ASSERT_EQ(halves[(ring * 3 + s) * p + i], both)
                    << "pixel " << i << ", ring " << ring << ", sector " << s;
                sum += both;
            }
        }
    }
    EXPECT_GT(sum, 20 * p) << "too few photons to mean anything";
}

TEST_F(Gather, DiscsOfAllSizesLookAtLevelsOfTheGridAndFindTheirPhotons) {
    const Spread spread{.photons = 8192};
    std::mt19937 random(5);
    const auto number = [&] { return std::uniform_real_distribution<double>()(random); };
    std::vector<Disc> discs;
    std::vector<glm::dvec2> places;
    while (discs.size() < 64 * 64) {
        const double u = number(), v = number();
        discs.push_back(spread.disc(u, v));
        // Some that look at another level than their neighbours.
        if (discs.size() % 16 == 0) discs.back().radius *= std::exp2(8.0 * number() - 4.0);
    }
    while (places.size() < spread.photons) {
        const double u = number(), v = number();
        places.push_back(spread.photon(u, v));
    }
    DiscField field(device(), settings_of("cppm", spread.photons), discs, places);
    field.iterate();
    ASSERT_EQ(field.grid().levels, 1u) << "the first grid knows no radii";
    const auto of_one_level = field.gathered();
    field.iterate();
    const gpu::Grid grid = field.grid();
    ASSERT_GE(grid.levels, 3u);
    const auto of_levels = field.gathered();
    std::vector<std::size_t> looking(grid.levels);
    std::size_t found = 0, doubts = 0;
    for (std::size_t i = 0; i < discs.size(); ++i) {
        const double radius2 = field.states()[i].radius2;
        std::uint32_t count = 0, on_edge = 0;
        for (const gpu::Photon& photon : field.photons()) {
            const glm::dvec3 offset = glm::dvec3(photon.position) - glm::dvec3(field.hits()[i].position);
            const double q = glm::dot(offset, offset) / radius2;
            count += q < 1.0 ? 1 : 0;
            on_edge += std::abs(q - 1.0) <= 1e-5 ? 1 : 0;
        }
        std::uint32_t level = 0;
        while (std::sqrt(radius2) > grid.reach[level]) ++level;
        ++looking.at(level);
        const std::string disc = fmt::format("disc {} of radius {:.6g} on level {} of cells {:.6g}", i,
                                             std::sqrt(radius2), level, grid.cell[level]);
        ASSERT_EQ(of_levels[i].count, of_one_level[i].count) << disc;
        ASSERT_NEAR(of_levels[i].flux.x - of_levels[i].excess.x, of_one_level[i].flux.x - of_one_level[i].excess.x,
                    1e-6 * of_one_level[i].flux.x)
            << disc;
        found += of_levels[i].count;
        doubts += on_edge;
        if (on_edge == 0) {
            ASSERT_EQ(of_levels[i].count, count) << disc;
        }
    }
    EXPECT_GT(found, 5 * discs.size());
    EXPECT_LT(doubts, discs.size() / 20);
    for (std::uint32_t level = 0; level < grid.levels; ++level) EXPECT_GT(looking[level], 100u) << "level " << level;
}

}  // namespace
}  // namespace vkcppm::test
