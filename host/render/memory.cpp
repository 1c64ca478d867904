#include "render/memory.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "core/error.h"
#include "core/process.h"
#include "flat/features.h"
#include "flat/material.h"
#include "flat/textures.h"
#include "render/estimators.h"
#include "render/kernel_choice.h"

namespace vkcppm {
namespace {

constexpr std::uint32_t most_photons_per_lane = 64;
constexpr std::uint32_t first_photon_capacity = 6;  // photons a path, before a render knows better

/// Bytes of a buffer of a row, or of all bands' buffers.
std::uint64_t bytes_of(const BufferRow& row, const Counts& counts) {
    return row.element_bytes * entries_of(row, counts) * (row.per == Per::pixel ? counts.bands.count() : 1);
}

Counts counts_before(const Settings& settings, const Device& device, std::uint32_t features, bool lit) {
    gpu::Params params{};
    set_photons(params, settings, device, lit, workgroup);
    return counts_of(params, settings, device, features);
}

/// Features that say how much a pixel takes, of what is known before the scene is flat.
std::uint32_t features_before(const Scene& scene, const Settings& settings) {
    std::uint32_t features = bits_of(features_of(settings));
    for (const MaterialTraits& traits : traits_of(scene)) {
        if (traits.glossy()) features |= FEATURE_GLOSS;
        if (traits.is_rough()) features |= FEATURE_ROUGH;
    }
    if (!scene.instances.empty()) features |= FEATURE_INSTANCES;
    return features;
}

/// Of what the scene takes all that is known before it is flat.
std::uint64_t bytes_of_images(const Scene& scene) {
    std::uint64_t texels = 0;
    for (const TextureImage& image : scene.images) texels += texels_of(image);
    return texels * sizeof(std::uint32_t);
}

std::string megabytes(std::uint64_t bytes) { return fmt::format("{:.0f} MB", std::ceil(double(bytes) * 1e-6)); }

}  // namespace

void set_photons(gpu::Params& params, const Settings& settings, const Device& device, bool lit, std::uint32_t group) {
    params.photons = lit ? photons_of(settings) : 0;
    const std::uint32_t per_lane = std::clamp(params.photons / device.policy().busy_lanes, 1u, most_photons_per_lane);
    params.photons_per_lane = per_lane;
    // Whole work groups: a SIMD group takes the share of all its lanes.
    params.photon_lanes = (params.photons / per_lane / workgroup + 1) * workgroup;
    params.photon_capacity = per_lane * first_photon_capacity;
    params.cells = std::bit_ceil(std::clamp(16 * photons_of(settings), 1u << 12, 1u << 20));
    params.grid_levels = 1;
    // By the settings alone, so that it does not hang on how the render was cut; for 65,536 paths all there are.
    constexpr std::uint64_t sorted_bytes = 1u << 27, usual_photons = 16;  // a path
    params.most_levels = std::uint32_t(std::clamp<std::uint64_t>(
        sorted_bytes / (sizeof(gpu::Photon) * usual_photons * photons_of(settings)), 1, GRID_LEVELS));
    const DevicePolicy& policy = device.policy();
    params.sort_lanes =
        std::bit_ceil(std::clamp(photons_of(settings) / policy.sort_run, workgroup, policy.most_sort_lanes));
    params.scan_blocks = std::clamp(params.cells / 256, group, 4096u);
}

Digits digits_of(const gpu::Params& params) {
    const auto key_bits = std::uint32_t(std::countr_zero(params.cells));
    const std::uint32_t count = (key_bits + 7) / 8;
    return {(key_bits + count - 1) / count, count};
}

Counts counts_of(const gpu::Params& params, const Settings& settings, const Device& device, std::uint32_t features,
                 std::uint64_t most_band_pixels) {
    const EstimatorRow& estimator = find_estimator(settings.estimator);
    Counts counts;
    counts.photon_lanes = params.photon_lanes;
    counts.photon_slots = std::uint64_t(params.photon_lanes) * params.photon_capacity;
    counts.levels = params.grid_levels;
    counts.counters = COUNTERS_IN_ALL(params, digits_of(params).bits);
    counts.tallies = tally_rows(estimator, settings.rings, settings.sectors);
    counts.moments = moment_rows(estimator, settings.rings, settings.sectors);
    counts.nearest = settings.knn;
    counts.aovs = settings.aovs;
    counts.errors = settings.error;
    counts.glossy = (features & FEATURE_GLOSS) != 0;
    counts.instances = (features & FEATURE_INSTANCES) != 0;
    counts.asked_groups = ASKS_FOR_LIGHTS(features) ? GROUPS_ASKED(features) : 0;
    counts.bands = bands_of(settings.size->pixels(), counts, device, most_band_pixels);
    return counts;
}

std::vector<MemoryReport> memory_needed(const FlatScene& scene, const Settings& settings, const Device& device) {
    const std::uint32_t features = feature_bits(scene, settings);
    const Counts counts = counts_before(settings, device, features, !scene.lights.empty());
    std::map<Binding, std::uint64_t> bytes;
    for (const BufferRow& row : buffer_rows()) bytes[row.binding] = bytes_of(row, counts);
    const auto add = [&](Binding binding, const auto& data) { bytes[binding] = data.size() * sizeof(data[0]); };
    add(Binding::nodes, scene.bvh.nodes);
#define ADD(number, name, Element, per, entries, access, life, hashed) add(Binding::name, scene.name);
    SCENE_BUFFERS(ADD)
#undef ADD
    return memory_of(bytes, counts.bands.count());
}

void check_memory(const Scene& scene, const Settings& settings, const Device& device) {
    const Counts counts = counts_before(settings, device, features_before(scene, settings), true);
    const std::uint64_t of_images = bytes_of_images(scene);
    const std::uint64_t most = device.largest_buffer(bound_buffer(Binding::images).access);
    if (of_images > most) {
        throw Error(
            ExitCode::out_of_device_memory,
            fmt::format("the scene's images need a buffer of {}, the device '{}' allows {}: smaller images would do",
                        megabytes(of_images), device.info().name, megabytes(most)));
    }
    check_memory(counts, settings, device, of_images);
}

void check_memory(const Counts& counts, const Settings& settings, const Device& device, std::uint64_t of_scene) {
    std::uint64_t of_pixels = 0, of_band = 0, of_photons = 0;
    for (const BufferRow& row : buffer_rows()) {
        const std::uint64_t bytes = bytes_of(row, counts);
        switch (row.per) {
            case Per::pixel: of_pixels += bytes; break;
            case Per::band_pixel: of_band += bytes; break;
            default: of_photons += bytes; break;
        }
        // Bands keep the others within it.
        const std::uint64_t most = device.largest_buffer(bound_buffer(row.binding).access);
        if (row.per != Per::photon_slot || bytes <= most) continue;
        throw Error(ExitCode::out_of_device_memory,
                    fmt::format("{} light paths need a buffer of {}, the device '{}' allows {}: --photons {} would fit",
                                photons_of(settings), megabytes(bytes), device.info().name, megabytes(most),
                                std::uint64_t(double(photons_of(settings)) * 0.99 * double(most) / double(bytes))));
    }
    const DeviceInfo& info = device.info();
    std::uint64_t there = info.memory_bytes - std::min(info.memory_bytes, device.allocated_bytes());
    if (device.policy().memory_of_host) there = std::min(there, available_memory());
    const std::uint64_t needed = of_pixels + of_band + of_photons + of_scene;
    if (needed <= there) return;
    const Extent size = *settings.size;
    std::string remedy;
    const std::uint64_t rest = needed - of_pixels;
    if (rest < there) {
        const double side = std::sqrt(double(there - rest) / double(of_pixels));
        remedy = fmt::format("--size {}x{} would fit", std::max(1u, std::uint32_t(size.width * side)),
                             std::max(1u, std::uint32_t(size.height * side)));
    } else if (of_pixels + of_band + of_scene < there) {
        const double share = double(there - of_pixels - of_band - of_scene) / double(of_photons);
        remedy = fmt::format("--photons {} would fit", std::max(1u, std::uint32_t(photons_of(settings) * share)));
    } else {
        remedy = "nothing but more memory, or smaller images, would do";
    }
    throw Error(
        ExitCode::out_of_device_memory,
        fmt::format("the render needs {} on the device '{}': {} for {}x{} pixels, {} for {} light paths, {} for "
                    "the scene's images; it has {}: {}",
                    megabytes(needed), info.name, megabytes(of_pixels + of_band), size.width, size.height,
                    megabytes(of_photons), photons_of(settings), megabytes(of_scene), megabytes(there), remedy));
}

}  // namespace vkcppm
