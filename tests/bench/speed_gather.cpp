// The grid and the gather on photons and radii of given distributions.

#include <cmath>
#include <numbers>
#include <random>

#include <fmt/format.h>

#include "bench/speed.h"
#include "support/device/disc_field.h"

namespace vkcppm::bench {
namespace {

using std::numbers::pi;
using Random = std::mt19937;

constexpr std::uint32_t side = 256;  // pixels
constexpr std::uint32_t photon_count = 65536;
constexpr double in_disc = 10.0;  // photons expected in a disc
constexpr double spread = 1e3;    // largest radius over the smallest
constexpr double reach = 0.7;     // of the photons about the middle of the plane, m

using test::Disc;
using test::polar;

const test::Spread towards_middle{reach, spread, in_disc, photon_count};
// Photons of the same density everywhere in a disc of that reach: N R^2 / reach^2 of them within R.
const double even_radius = reach * std::sqrt(in_disc / photon_count);

glm::dvec2 evenly(double u, double v) { return polar(reach * std::sqrt(u), v); }

/// A distribution of pixels with their radii, and one of photons.
struct Case {
    const char* name;
    Disc (*disc)(double u, double v, double w);
    glm::dvec2 (*photon)(double u, double v);
};

constexpr Case cases[] = {
    {"one radius",
     [](double u, double v, double) {
         return Disc{evenly(u, v), even_radius};
     },
     evenly},
    {"as the density asks, 10^3", [](double u, double v, double) { return towards_middle.disc(u, v); },
     [](double u, double v) { return towards_middle.photon(u, v); }},
    // log-uniform; the mean of R^2, and so of photons, is that of one radius: (1 - spread^-2) / (2 log spread) max^2.
    {"at random, 10^3",
     [](double u, double v, double w) {
         const double largest = even_radius * std::sqrt(2.0 * std::log(spread));
         return Disc{evenly(u, v), largest * std::pow(spread, w - 1.0)};
     },
     evenly},
};

/// A field of a case with its times.
class TimedField {
public:
    TimedField(Device& device, const Settings& settings, const Case& of)
        : TimedField(device, settings, of, Random(1)) {}

    void iterate() {
        Report before, after;
        field_.integrator().fill(before);
        field_.iterate();
        field_.integrator().fill(after);
        gather_ = std::min(gather_, seconds(after, Pass::gather) - seconds(before, Pass::gather));
        grid_ = std::min(grid_, seconds(after, Pass::grid) - seconds(before, Pass::grid));
    }

    /// So far does not count.
    void forget() { gather_ = grid_ = std::numeric_limits<double>::infinity(); }

    /// Least so far, s.
    double gather() const { return gather_; }
    double grid() const { return grid_; }

    std::uint32_t levels() { return field_.grid().levels; }

    /// Photons in the discs of one iteration.
    std::uint64_t gathered() {
        std::uint64_t sum = 0;
        for (const gpu::Gathered& g : field_.gathered()) sum += g.count;
        return sum;
    }

private:
    TimedField(Device& device, const Settings& settings, const Case& of, Random random)
        : field_(device, settings, discs(of, random), photons(of, random)) {}

    static double uniform(Random& random) { return std::uniform_real_distribution<double>()(random); }

    static std::vector<Disc> discs(const Case& of, Random& random) {
        // As in a picture: pixels see what is near to what their neighbours see.
        std::vector<Disc> all;
        for (std::uint32_t i = 0; i < side * side; ++i) {
            const double u = (i % side + uniform(random)) / side, v = (i / side + uniform(random)) / side;
            all.push_back(of.disc(u, v, uniform(random)));
        }
        return all;
    }

    static std::vector<glm::dvec2> photons(const Case& of, Random& random) {
        std::vector<glm::dvec2> all;
        while (all.size() < photon_count) {
            const double u = uniform(random), v = uniform(random);
            all.push_back(of.photon(u, v));
        }
        return all;
    }

    static double seconds(const Report& report, Pass pass) {
        return test::report_of(report.passes, pass).device_seconds;
    }

    test::DiscField field_;
    double gather_ = std::numeric_limits<double>::infinity();
    double grid_ = std::numeric_limits<double>::infinity();
};

}  // namespace

Table bench_gather(const Bench& bench) {
    Table table{
        "gather",
        fmt::format(
            "{0}x{0} pixels over {1} photons on a plane, {2} expected in a disc in the mean. Device ms; ns for a "
            "photon within a disc.",
            side, photon_count, in_disc),
        {"radii", "threads", "levels", "grid ms", "gather ms", "gathered", "ns a photon", "over one radius"},
        {}};
    Settings settings;
    settings.size = Extent{side, side};
    settings.photons = photon_count;
    for (const Worker& worker : bench.workers) {
        std::vector<std::unique_ptr<TimedField>> fields;
        for (const Case& of : cases) {
            fields.push_back(std::make_unique<TimedField>(*worker.device, settings, of));
            for (int run = 0; run < 2; ++run) fields.back()->iterate();  // the grid knows no radii, then makes room
            fields.back()->forget();
        }
        for (int run = 0; run <= bench.runs; ++run) {
            for (auto& field : fields) field->iterate();
        }
        double first = 0.0;
        for (std::size_t i = 0; i < fields.size(); ++i) {
            const double each = fields[i]->gather() / double(fields[i]->gathered());
            if (i == 0) first = each;
            table.rows.push_back({cases[i].name, worker.threads, fields[i]->levels(), 1e3 * fields[i]->grid(),
                                  1e3 * fields[i]->gather(), fields[i]->gathered(), 1e9 * each, each / first});
        }
    }
    return table;
}

}  // namespace vkcppm::bench
