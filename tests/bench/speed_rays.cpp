// Nearest hits: the renderer's traversal on the renderer's buffers beside Embree's rtcIntersect1, on the same rays and
// as many threads.

#include <cassert>
#include <cmath>
#include <numbers>
#include <random>
#include <thread>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "bench/speed.h"
#include "kernels/probe.h"
#include "oracle/embree.h"
#include "render/render.h"
#include "render/scene_on_device.h"
#include "support/device/trace_kernel.h"
#include "vk/kernel.h"

namespace vkcppm::bench {
namespace {

constexpr std::uint32_t stream_words[] = {
#include "speed_stream.spv.inc"
};

constexpr std::uint32_t side = 512;          // of the camera's picture
constexpr std::uint32_t rays_per_lane = 16;  // of speed_stream.comp

using Rays = std::vector<gpu::RayInput>;
using Random = std::mt19937;

/// Of a camera in a corner of the room, row by row, as eye paths begin.
Rays primary_rays(const SceneFrame& frame) {
    Rays rays;
    const glm::dvec3 eye(0.1, 1.7, 0.1);
    const glm::dvec3 forward = glm::normalize(glm::dvec3(1.0, 0.9, 1.0) - eye);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 1, 0))), up = glm::cross(right, forward);
    for (std::uint32_t y = 0; y < side; ++y) {
        for (std::uint32_t x = 0; x < side; ++x) {
            const double u = 2.0 * (x + 0.5) / side - 1.0, v = 1.0 - 2.0 * (y + 0.5) / side;
            rays.push_back({glm::vec3(frame.point(eye)), glm::vec3(glm::normalize(forward + u * right + v * up))});
        }
    }
    return rays;
}

/// From where the rays hit, by the cosine about the normal on their side.
Rays diffuse_rays(const Rays& first, const oracle::Embree& embree, const FlatScene& flat, Random& random) {
    Rays rays;
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    for (const gpu::RayInput& ray : first) {
        const auto hit = embree.nearest(ray.origin, ray.direction);
        if (!hit) continue;
        const gpu::TriangleGeometry& triangle = flat.triangles[hit->triangle];
        glm::vec3 normal = glm::normalize(glm::cross(triangle.e1, triangle.e2));
        if (glm::dot(normal, ray.direction) > 0.0f) normal = -normal;
        const float cosine = 1.0f - 2.0f * uniform(random),
                    azimuth = 2.0f * std::numbers::pi_v<float> * uniform(random);
        const float sine = std::sqrt(1.0f - cosine * cosine);
        const glm::vec3 on_sphere(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine);
        const glm::vec3 place = ray.origin + hit->t * ray.direction;
        rays.push_back({place + 1e-4f * normal, glm::normalize(normal + 0.999f * on_sphere)});
    }
    return rays;
}

/// From anywhere in the room to anywhere.
Rays random_rays(const FlatScene& flat, Random& random) {
    Rays rays;
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    const auto place = [&] {
        return glm::mix(flat.low, flat.high, glm::vec3(uniform(random), uniform(random), uniform(random)));
    };
    while (rays.size() < side * side) {
        const glm::vec3 from = place(), to = place();
        rays.push_back({from, glm::normalize(to - from)});
    }
    return rays;
}

/// A kernel on the buffers of a scene, ready for rays.
class Tracer {
public:
    Tracer(Device& device, const FlatScene& flat, const Settings& settings, const Scene& scene)
        : bindings_(device),
          commands_(device, bindings_),
          buffers_(device, bindings_),
          on_device_(device, flat),
          trace_(device, "trace", test::trace_words, scene_specialization(flat, 0)),
          stream_(device, "stream", stream_words, scene_specialization(flat, 0)) {
        params_ = scene_params(device, flat, scene.cameras.at(0), settings, false);
        on_device_.lend(buffers_);
        buffers_.upload(Binding::params, std::vector{params_});
        buffers_.allocate(Binding::status, 1);
    }

    void take(const Rays& rays) {
        count_ = std::uint32_t(rays.size());
        buffers_.upload(PROBE_INPUT, rays);
        buffers_.upload(PROBE_OUTPUT, std::vector<gpu::RayOutput>(rays.size()));
    }
    /// One ray a lane, as eye paths are traced.
    Seconds trace() { return run(trace_, count_); }
    /// Lanes that take the next of their rays as soon as they are done with one, as photons are traced.
    Seconds stream() { return run(stream_, (count_ + rays_per_lane - 1) / rays_per_lane); }

    std::vector<gpu::RayOutput> hits() const { return buffers_.at(PROBE_OUTPUT).download<gpu::RayOutput>(count_); }

private:
    Seconds run(const Kernel& kernel, std::uint64_t invocations) {
        commands_.begin();
        commands_.launch(kernel, invocations,
                         {.iteration = 0,
                          .round = rays_per_lane,
                          .last_round = 0,
                          .argument = params_.step_budget,
                          .items = count_});
        std::vector<Timing> timings;
        const Seconds host = time_of([&] { timings = commands_.finish(); });
        return {timings.front().seconds, host.cpu};
    }

    Bindings bindings_;
    Commands commands_;
    Buffers buffers_;
    SceneOnDevice on_device_;
    Kernel trace_;
    Kernel stream_;
    gpu::Params params_{};
    std::uint32_t count_ = 0;
};

/// Embree over the rays in as many threads; every hit is written.
Seconds embree_seconds(const oracle::Embree& embree, const Rays& rays, unsigned threads) {
    std::vector<gpu::RayOutput> outputs(rays.size());
    return time_of([&] {
        std::vector<std::jthread> pool;
        for (unsigned t = 0; t < threads; ++t) {
            pool.emplace_back([&, t] {
                for (std::size_t i = rays.size() * t / threads; i < rays.size() * (t + 1) / threads; ++i) {
                    const auto hit = embree.nearest(rays[i].origin, rays[i].direction);
                    if (hit) outputs[i] = {1, hit->t, hit->triangle, {}, 0};
                }
            });
        }
    });
}

/// Share of rays whose distance is not Embree's. Rays along edges may differ; more than a few would make the times
/// idle.
double differing(const oracle::Embree& embree, const Rays& rays, const std::vector<gpu::RayOutput>& hits) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const auto hit = embree.nearest(rays[i].origin, rays[i].direction);
        if (hits[i].found == test::found_unfinished || hit.has_value() != (hits[i].found != 0) ||
            (hit && std::abs(hit->t - hits[i].t) > 1e-4f)) {
            ++count;
        }
    }
    return double(count) / double(rays.size());
}

}  // namespace

Table bench_rays(const Bench& bench) {
    Table table{
        "rays",
        fmt::format("Nearest hits of {} rays in a room of bumpy spheres, beside Embree's rtcIntersect1 (default flags, "
                    "not robust). Millions of rays a CPU second; `eye`: one ray a lane, `photon`: lanes take the next "
                    "ray. In units of Embree's: by CPU seconds, and by the clock.",
                    side * side),
        {"triangles", "rays", "threads", "eye", "photon", "Embree", "eye / Embree", "photon / Embree", "eye, clock",
         "photon, clock", "differ"},
        {}};
    for (const std::uint32_t triangles : {1000u, 50000u, 500000u}) {
        const Scene scene = bumpy_room(triangles);
        const FlatScene flat = flatten(scene);
        const oracle::Embree embree(corners_of(flat), false);
        Settings wanted;
        wanted.size = Extent{side, side};
        const Settings settings = resolve_settings(wanted, scene);
        std::vector<std::unique_ptr<Tracer>> tracers;
        for (const Worker& worker : bench.workers) {
            tracers.push_back(std::make_unique<Tracer>(*worker.device, flat, settings, scene));
        }
        Random random(1);
        const Rays primary = primary_rays(flat.frame);
        for (const auto& [kind, rays] :
             {std::pair("primary", primary), std::pair("diffuse", diffuse_rays(primary, embree, flat, random)),
              std::pair("random", random_rays(flat, random))}) {
            struct Times {
                Seconds eye, photon, embree;
            };
            std::vector<Times> least(bench.workers.size());
            for (auto& tracer : tracers) tracer->take(rays);
            for (int run = 0; run <= bench.runs; ++run) {
                for (std::size_t w = 0; w < bench.workers.size(); ++w) {
                    const Times times{tracers[w]->trace(), tracers[w]->stream(),
                                      embree_seconds(embree, rays, bench.workers[w].threads)};
                    if (run == 0) continue;  // compiles
                    least[w].eye.keep(times.eye);
                    least[w].photon.keep(times.photon);
                    least[w].embree.keep(times.embree);
                }
            }
            for (std::size_t w = 0; w < bench.workers.size(); ++w) {
                const Times& t = least[w];
                const double millions = 1e-6 * double(rays.size());
                table.rows.push_back({flat.triangles.size(), kind, bench.workers[w].threads, millions / t.eye.cpu,
                                      millions / t.photon.cpu, millions / t.embree.cpu, t.embree.cpu / t.eye.cpu,
                                      t.embree.cpu / t.photon.cpu, t.embree.device / t.eye.device,
                                      t.embree.device / t.photon.device, differing(embree, rays, tracers[w]->hits())});
            }
        }
    }
    return table;
}

}  // namespace vkcppm::bench
