// Instances of meshes that are stored once beside copies of them: the time an iteration, and of loading and flattening.

#include <cmath>
#include <random>

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

#include "bench/speed.h"
#include "scene/gltf/gltf.h"
#include "support/files/files.h"
#include "support/files/temporary_folder.h"
#include "support/scenes/gltf_builder.h"
#include "support/scenes/instanced.h"

namespace vkcppm::bench {

Table bench_instances(const Bench& bench) {
    Table table{
        "instances",
        "Instances of a bumpy sphere over a floor, shared and copied: seconds by the clock until the scene can be "
        "uploaded, device ms an iteration of cppm of 256x256 pixels and 65,536 paths, and how many times longer it is "
        "where the sphere is shared.",
        {"instances", "triangles each", "threads", "load s, shared", "copied", "iteration ms, shared", "copied",
         "eye and photon ms, shared", "copied", "times"},
        {}};
    for (const auto& [instances, triangles] :
         {std::pair(4000u, 8u), {4000u, 32u}, {4000u, 128u}, {1000u, 512u}, {128u, 9800u}, {4u, 100000u}}) {
        const test::TemporaryFolder folder;
        test::write_bytes(folder / "scene.gltf", test::instanced_spheres(instances, triangles).gltf());
        for (const Worker& worker : bench.workers) {
            Settings settings;
            settings.size = Extent{256, 256};
            settings.photons = 65536;
            std::array<Seconds, 2> load;
            std::vector<std::unique_ptr<Render>> renders;
            const std::array<Sharing, 2> both = {Sharing::always, Sharing::never};
            for (int i = 0; i < 2; ++i) {
                for (int run = 0; run < bench.runs; ++run) {
                    load[i].keep(time_of([&] { flatten(load_gltf(folder / "scene.gltf", {.sharing = both[i]})); }));
                }
                renders.push_back(std::make_unique<Render>(
                    *worker.device, load_gltf(folder / "scene.gltf", {.sharing = both[i]}), settings));
                renders.back()->warm_up(4);
            }
            for (int run = 0; run < bench.runs; ++run) {
                for (const auto& render : renders) render->run(2);
            }
            const auto ms = [&](int i) { return 1e3 * renders[i]->least().device; };
            const auto rays = [&](int i) {
                return 1e3 * (renders[i]->pass(Pass::eye) + renders[i]->pass(Pass::photon));
            };
            table.rows.push_back({instances, triangles, worker.threads, load[0].device, load[1].device, ms(0), ms(1),
                                  rays(0), rays(1), ms(0) / ms(1)});
        }
    }
    return table;
}

}  // namespace vkcppm::bench
