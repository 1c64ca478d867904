// Whole iterations: on the project's scenes by pass, and how they grow with triangles, photons, pixels and threads.

#include <cmath>

#include <fmt/format.h>

#include "bench/speed.h"
#include "scene/gltf/gltf.h"
#include "support/scenes/scenes.h"

namespace vkcppm::bench {
namespace {

constexpr std::uint32_t warm = 4;  // iterations until every pixel has its radius and the grid knows them

Settings settings_of(Extent size, std::uint32_t photons) {
    Settings settings;
    settings.size = size;
    settings.photons = photons;
    return settings;
}

std::string size_text(Extent size) { return fmt::format("{}x{}", size.width, size.height); }

}  // namespace

Table bench_iterations(const Bench& bench) {
    Table table{"iterations",
                "Iterations of cppm on one thread: device ms a pass, CPU seconds an iteration; light paths and stored "
                "photons a second of the photon pass, rays a second of eye and photon pass, in millions.",
                {"scene", "pixels", "paths", "eye", "photon", "grid", "knn", "gather", "update", "all", "CPU s",
                 "Mpaths/s", "Mphotons/s", "Mrays/s"},
                {}};
    struct Case {
        std::string name;
        Scene scene;
        Extent size;
        std::uint32_t photons;
    };
    std::vector<Case> cases;
    for (const char* name : {"caustic", "box", "clocks", "conference", "cornell", "diamond", "dining", "glass",
                             "sibenik", "sponza", "torus", "water"}) {
        cases.push_back({name, test::project_scene(name), {128, 128}, 16384});
    }
    for (const auto& file : bench.scenes) {
        for (const std::uint32_t side : {256u, 512u}) {
            cases.push_back({file.stem().string(), load_gltf(file), {side, side}, 65536});
        }
    }
    for (const Case& of : cases) {
        Render render(*bench.workers.front().device, of.scene, settings_of(of.size, of.photons));
        render.warm_up(warm);
        Report before;
        render.integrator().fill(before);
        for (int run = 0; run < bench.runs; ++run) render.run(4);
        const Report& after = render.report();
        const double count = double(after.iterations - before.iterations);
        const double photon = render.pass(Pass::photon), eye = render.pass(Pass::eye);
        const auto ms = [&](Pass pass) { return 1e3 * render.pass(pass); };
        table.rows.push_back({of.name, size_text(of.size), of.photons, 1e3 * eye, 1e3 * photon, ms(Pass::grid),
                              ms(Pass::knn), ms(Pass::gather), ms(Pass::update), 1e3 * render.least().device,
                              render.least().cpu, 1e-6 * of.photons / photon,
                              1e-6 * double(after.stored_photons - before.stored_photons) / count / photon,
                              1e-6 * double(after.rays - before.rays) / count / (eye + photon)});
    }
    return table;
}

Table bench_growth(const Bench& bench) {
    Table table{
        "growth",
        "Iterations of cppm as one number grows: device ms, CPU ms; `step`: how many times longer than the row before, "
        "over how many times more there are, 1 where growth is linear; `gain`: by the second number of threads, by "
        "the clock.",
        {"grows", "number", "others"},
        {}};
    for (const Worker& worker : bench.workers) {
        const std::string threads = worker.threads == 1 ? "1 thread" : fmt::format("{} threads", worker.threads);
        for (const char* what : {"ms", "CPU ms", "step"}) table.columns.push_back(fmt::format("{}, {}", what, threads));
    }
    if (bench.workers.size() > 1) table.columns.push_back("gain");

    struct Case {
        std::uint64_t number;
        Scene scene;
        Settings settings;
    };
    const auto grow = [&](const char* name, const char* others, const std::vector<Case>& cases) {
        std::vector<double> last(bench.workers.size());
        for (std::size_t i = 0; i < cases.size(); ++i) {
            std::vector<std::unique_ptr<Render>> renders;
            for (const Worker& worker : bench.workers) {
                renders.push_back(std::make_unique<Render>(*worker.device, cases[i].scene, cases[i].settings));
                renders.back()->warm_up(warm);
            }
            for (int run = 0; run < bench.runs; ++run) {
                for (auto& render : renders) render->run(2);
            }
            nlohmann::ordered_json row = {name, cases[i].number, others};
            for (std::size_t w = 0; w < renders.size(); ++w) {
                const Seconds& least = renders[w]->least();
                row.insert(row.end(), {1e3 * least.device, 1e3 * least.cpu});
                const double more = i > 0 ? double(cases[i].number) / double(cases[i - 1].number) : 1.0;
                row.push_back(i > 0 ? nlohmann::ordered_json(least.device / last[w] / more) : "");
                last[w] = least.device;
            }
            if (renders.size() > 1) row.push_back(renders[0]->least().device / renders[1]->least().device);
            table.rows.push_back(row);
        }
    };
    const Scene cornell = test::project_scene("cornell");
    std::vector<Case> photons, pixels, triangles;
    for (const std::uint32_t n : {4096u, 16384u, 65536u, 262144u, 1048576u}) {
        photons.push_back({n, cornell, settings_of({128, 128}, n)});
    }
    for (const std::uint32_t side : {64u, 128u, 256u, 512u, 1024u}) {
        pixels.push_back({std::uint64_t(side) * side, cornell, settings_of({side, side}, 16384)});
    }
    for (const std::uint32_t n : {1000u, 10000u, 50000u, 500000u}) {
        triangles.push_back({n, bumpy_room(n), settings_of({128, 128}, 16384)});
    }
    grow("paths", "cornell, 128x128 pixels", photons);
    grow("pixels", "cornell, 16384 paths", pixels);
    grow("triangles", "room of bumpy spheres, 128x128 pixels, 16384 paths", triangles);
    return table;
}

}  // namespace vkcppm::bench
