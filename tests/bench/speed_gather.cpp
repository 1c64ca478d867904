// The grid and the gather on photons and radii of given distributions.

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include <fmt/format.h>

#include "bench/speed.h"
#include "shared/bindings.h"
#include "support/shapes.h"

namespace vkcppm::bench {
namespace {

using std::numbers::pi;
using Random = std::mt19937;

constexpr std::uint32_t side = 256;          // pixels
constexpr std::uint32_t photon_count = 65536;
constexpr double in_disc = 10.0;             // photons expected in a disc
constexpr double spread = 1e3;               // largest radius over the smallest
constexpr double reach = 0.7;                // of the photons about the middle of the plane, m

struct Point {
    double x = 0.0;
    double y = 0.0;
    double radius = 0.0;
};

/// A distribution of pixels with their radii, and one of photons.
struct Case {
    const char* name;
    Point (*pixel)(double u, double v, double w);
    Point (*photon)(double u, double v);
};

Point polar(double distance, double v, double radius) {
    return {distance * std::cos(2.0 * pi * v), distance * std::sin(2.0 * pi * v), radius};
}

/// Photons of the same density everywhere in a disc of that reach: N R^2 / reach^2 of them within R.
Point evenly(double u, double v) { return polar(reach * std::sqrt(u), v, 0.0); }
const double even_radius = reach * std::sqrt(in_disc / photon_count);

/// Density 1 / distance^2 from reach / spread to reach: N c^2 / (2 log spread) of them within c distance.
Point towards_middle(double u, double v) { return polar(reach * std::pow(spread, u - 1.0), v, 0.0); }
const double share = std::sqrt(in_disc * 2.0 * std::log(spread) / photon_count);

constexpr Case cases[] = {
    {"one radius", [](double u, double v, double) { return polar(reach * std::sqrt(u), v, even_radius); }, evenly},
    {"as the density asks, 10^3",
     [](double u, double v, double) {
         const double distance = reach * std::pow(spread, u - 1.0);
         return polar(distance, v, share * distance);
     },
     towards_middle},
    // log-uniform; the mean of R^2, and so of photons, is that of one radius: (1 - spread^-2) / (2 log spread) max^2.
    {"at random, 10^3",
     [](double u, double v, double w) {
         const double largest = even_radius * std::sqrt(2.0 * std::log(spread));
         return polar(reach * std::sqrt(u), v, largest * std::pow(spread, w - 1.0));
     },
     evenly},
};

Scene plane() {
    Scene scene;
    test::add_quad(scene, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, test::add_diffuse(scene, glm::vec3(1.0f)));
    PunctualLight light;  // never traced: without a light there would be no photon lanes
    light.position = {0, 0, 1};
    scene.lights.push_back(light);
    test::add_camera(scene, {0, 0, 2}, {0, 0, 0}, 1.0);
    return scene;
}

/// A render whose hits, radii and photons are the case's.
class Field {
public:
    Field(Device& device, const Settings& settings, const Case& of) : render_(device, plane(), settings) {
        Integrator& integrator = render_.integrator();
        const SceneFrame& frame = render_.flat().frame;
        Random random(1);
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        const auto place = [&](const Point& p) { return glm::vec3(frame.point({p.x, p.y, 0.0})); };
        std::vector<gpu::HitPosition> hits;
        for (std::uint32_t i = 0; i < side * side; ++i) {
            const Point p = of.pixel(uniform(random), uniform(random), uniform(random));
            hits.push_back({place(p), HIT_DIFFUSE | 0x3fffffffu << 2});
            gpu::PixelState state{};
            const double radius = frame.length(p.radius);
            state.radius2 = float(radius * radius);
            state.seeded = 1;
            state.batch = 1e30f;  // no test: the radius stays
            states_.push_back(state);
        }
        integrator.buffer(BIND_HIT_POSITION).upload(hits);
        integrator.buffer(BIND_HIT_WEIGHT).upload(std::vector<gpu::HitWeight>(hits.size(), {glm::vec3(1.0f), 0}));
        integrator.buffer(BIND_PIXELS).upload(states_);
        for (std::uint32_t i = 0; i < photon_count; ++i) {
            photons_.push_back({place(of.photon(uniform(random), uniform(random))), 0});
        }
        const gpu::Params& params = integrator.params();
        // One photon a light path, each in the slot of its path.
        counters_.assign(std::size_t(params.cells) + 1 + 2 * std::size_t(params.photons) + 1, 0);
        const auto counts = counters_.begin() + params.cells + 1;
        std::fill(counts, counts + params.photons, 1);
        std::iota(counts + params.photons + 1, counters_.end(), 0);
    }

    void iterate() {
        Integrator& integrator = render_.integrator();
        integrator.buffer(BIND_COUNTERS).upload(counters_);
        integrator.buffer(BIND_PHOTONS).upload(photons_);
        Report before, after;
        integrator.fill(before);
        integrator.run_from_grid();
        integrator.fill(after);
        gather_ = std::min(gather_, seconds(after, "gather") - seconds(before, "gather"));
        double grid = 0.0;
        for (const char* name : {"grid", "radix", "scan"}) grid += seconds(after, name) - seconds(before, name);
        grid_ = std::min(grid_, grid);
    }

    /// Least so far, s.
    double gather() const { return gather_; }
    double grid() const { return grid_; }

    /// Photons in the discs of one iteration.
    std::uint64_t gathered() {
        std::uint64_t sum = 0;
        for (const gpu::Gathered& g : render_.integrator().buffer(BIND_GATHERED).download<gpu::Gathered>(side * side)) {
            sum += g.count;
        }
        return sum;
    }

private:
    static double seconds(const Report& report, std::string_view name) {
        double sum = 0.0;
        for (const PassReport& pass : report.passes) sum += pass.name.starts_with(name) ? pass.device_seconds : 0.0;
        return sum;
    }

    Render render_;
    std::vector<gpu::PixelState> states_;
    std::vector<gpu::Photon> photons_;
    std::vector<std::uint32_t> counters_;
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
        {"radii", "threads", "grid ms", "gather ms", "gathered", "ns a photon", "over one radius"},
        {}};
    Settings settings;
    settings.size = Extent{side, side};
    settings.photons = photon_count;
    for (const Worker& worker : bench.workers) {
        std::vector<std::unique_ptr<Field>> fields;
        for (const Case& of : cases) {
            fields.push_back(std::make_unique<Field>(*worker.device, settings, of));
            fields.back()->iterate();  // the grid knows no radii yet
        }
        for (int run = 0; run <= bench.runs; ++run) {
            for (auto& field : fields) field->iterate();
        }
        double first = 0.0;
        for (std::size_t i = 0; i < fields.size(); ++i) {
            const double each = fields[i]->gather() / double(fields[i]->gathered());
            if (i == 0) first = each;
            table.rows.push_back({cases[i].name, worker.threads, 1e3 * fields[i]->grid(), 1e3 * fields[i]->gather(),
                                  fields[i]->gathered(), 1e9 * each, each / first});
        }
    }
    return table;
}

}  // namespace vkcppm::bench
