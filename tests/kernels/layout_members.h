// Every member of every struct of shaders/shared/types.h, in order. The file that includes this defines X(member).
// Compiled by g++ and by glslc.
#ifdef __cplusplus
#pragma once
#endif
// clang-format off
#define MEMBERS_BVH_NODE X(origin) X(exponents) X(low_x) X(low_y) X(low_z) X(high_x) X(high_y) X(high_z) \
    X(children) X(unused) X(leaves) X(parent_leaves)
#define MEMBERS_INSTANCE_NODE X(centre) X(index) X(to_mesh) X(root) X(parent_leaves)
#define MEMBERS_INSTANCE X(row_x) X(row_y) X(row_z) X(error) X(stretch) X(hand) X(size)
#define MEMBERS_TRIANGLE_GEOMETRY X(v0) X(error) X(e1) X(slack_u) X(e2) X(slack_v)
#define MEMBERS_TRIANGLE_SHADING X(normal) X(material)
#define MEMBERS_SURFACE_MATERIAL \
    X(color) X(flags) X(emission) X(ior) X(metallic) X(roughness) X(transmission) X(specular) X(specular_color) \
    X(opacity) X(absorption) X(cauchy) X(clearcoat) X(clearcoat_roughness) X(alpha_cutoff) X(normal_scale) X(texture) \
    X(clearcoat_normal_scale) X(priority) X(iridescence) X(anisotropy) X(film_index) X(film_thickness) X(sheen_color) \
    X(sheen_roughness)
#define MEMBERS_TEXTURE_LOOKUP X(first) X(width) X(height) X(flags) X(matrix) X(offset) X(fine) X(unused)
#define MEMBERS_LIGHT X(position) X(kind) X(e1) X(keep) X(e2) X(alias_entry) X(power) X(double_sided) X(corner) \
    X(triangle) X(textured)
#define MEMBERS_ASKED_GROUP X(first) X(count) X(candidates) X(depth)
#define MEMBERS_ASKED_LIGHT X(light) X(keep) X(alias_light) X(power)
#define MEMBERS_LIGHT_BRANCH X(sphere) X(axis) X(cones) X(reach) X(first) X(count) X(ratio) X(parent)
#define MEMBERS_LIGHT_RAY X(origin) X(distance) X(direction) X(triangle) X(light) X(layer)
#define MEMBERS_LIGHT_RAYS X(of)
#define MEMBERS_PHOTON X(position) X(normal)
#define MEMBERS_PHOTON_FLUX X(power) X(direction)
#define MEMBERS_HIT_POSITION X(position) X(state)
#define MEMBERS_HIT_WEIGHT X(weight) X(normal)
#define MEMBERS_HIT_EMISSION X(emission) X(footprint)
#define MEMBERS_HIT_SURFACE X(triangle) X(barycentric) X(outgoing)
#define MEMBERS_GATHERED X(flux) X(count) X(excess) X(tested)
#define MEMBERS_PIXEL_STATE X(radius2) X(seeded) X(count) X(total) X(batch) X(rejections) \
    X(photons) X(seen) X(statistic) X(radius2_low) X(count_low) X(excess)
#define MEMBERS_AOVS X(albedo) X(normal) X(depth) X(hits) X(albedo_low) X(normal_low) X(depth_low) X(layer) X(layer_low)
#define MEMBERS_FILM X(sum) X(low)
#define MEMBERS_PATH_STATE X(origin) X(path) X(direction) X(flags) X(power) X(stored) X(power0) X(begin) X(next) \
    X(near) X(met) X(media)
#define MEMBERS_TRACE_STATE X(origin) X(flags) X(direction) X(density) X(throughput) X(distance) X(radiance) X(done) \
    X(sum) X(ended) X(light_rays) X(met) X(media)
#define MEMBERS_CURSOR X(cell) X(photon)
#define MEMBERS_GRID X(origin) X(levels) X(dims) X(cell) X(inverse_cell) X(reach) X(first) X(entries)
#define MEMBERS_STATUS X(blocked) X(completed) X(capacity) X(stuck) X(invalid) X(rays) \
    X(stored) X(rays_high) X(levels) X(band) X(searches) X(search_groups) X(photons) X(radius_histogram) \
    X(photon_histogram) X(photon_histogram_high)
#define MEMBERS_PARAMS \
    X(eye) X(width) X(right) X(height) X(up) X(seed) X(forward) X(pixel_radius) X(bounds_low) X(photons) \
    X(bounds_high) X(photons_per_lane) X(photon_lanes) X(photon_capacity) X(bounds_radius) X(max_depth) \
    X(eye_media) X(eye_medium) X(light_count) X(near_lights) X(light_power) X(asked) X(local_power) \
    X(environment_power) X(environment) X(lens_radius) X(focus_distance) X(start) X(orthographic) X(step_budget) \
    X(knn) X(radius_cap) X(radius_floor) X(footprint_cap) X(inverse_paths) X(flux_unit) X(alpha) X(k) X(beta) \
    X(keeps_radii) X(cells) X(grid_levels) X(most_levels) X(sort_lanes) X(scan_blocks) X(threshold) X(sector_edge) \
    X(sector_centre)
#define MEMBERS_EYE_STATE X(origin) X(flags) X(direction) X(followed) X(throughput) X(leg) X(emission) X(distance) \
    X(end) X(layer) X(direct) X(met) X(media) X(bias)
#define MEMBERS_SEARCH_STATE X(largest) X(largest_index) X(radius) X(kept)
#define MEMBERS_LAUNCH X(iteration) X(round) X(last_round) X(paths) X(search_group) X(level) X(scan_first) \
    X(scan_count) X(digit_shift) X(reads_b) X(plans_next) X(error_group) X(band) X(last_band) X(first_pixel) \
    X(pixels) X(argument) X(items)
