// Every buffer that kernels have, a row each. Allocation, the memory of --stats, checkpoints, hashes,
// descriptors and the declarations of the kernels follow from the rows.
//
// ROW(number, name, Element, per, entries, access, life, hashed)
//   number   of its binding; where kernels read it as texels, TEXELS_BINDING + number is that of the view
//   name     of the array in kernels, Binding::name on the host
//   Element  what it is an array of: a struct of types.h, or uint, float, uvec2, vec3, vec4
//   per      what it has entries for, as --stats counts memory (Per of host/render/buffers.h); the first row of
//            each that is not there for some features alone has one entry for each
//            pixel: of the picture, in as many buffers as it has bands; band_pixel: of a band, one buffer for all
//   entries  how many for each (Entries of host/render/buffers.h)
//   access   uniform      as a uniform block
//            storage      as a storage buffer
//            uint_texels, float_texels, word_texels: as texels of four integers, four floats, one integer alone: data
//                         that no kernel writes
//            records      written as a storage buffer, read as texels of four integers: Element is 16 bytes or more
//            words        the same, of one integer
//   life     scratch      made anew by every iteration, or never written by one
//            carried      an iteration leaves it to the next: checkpoints hold it
//            summed       likewise, of a pixel: a sum over iterations, which a slice of a job begins anew from zeros
//   hashed   never, eye, gather, update: after that pass; from_knn: after that and those behind it; apart: by rules of
//            its own in host/render/integrator_state.cpp. A hash goes over its buffers in the order of the
//            rows: a new one changes the hash of its pass
//
// Software Vulkan reads a texel of four words for the lanes of a SIMD group (subgroup) at once, and every word of a
// storage buffer lane by lane. What an invocation has stored it does not read as texels in the same launch.
#ifdef __cplusplus
#pragma once
#endif

// clang-format off
// Of a render.
#define PARAMS(ROW)            ROW(0, params, Params, rest, one, uniform, scratch, never)
#define STATUS(ROW)            ROW(1, status, Status, rest, one, storage, scratch, never)
#define GRID(ROW)              ROW(2, grid, Grid, rest, one, storage, carried, apart)
// Of the scene: members of that name of FlatScene (host/flat/flat_scene.h), but for the nodes of its BVH.
#define NODES(ROW)             ROW(3, nodes, BvhNode, node, uploaded, uint_texels, scratch, never)
#define TRIANGLES(ROW)         ROW(4, triangles, TriangleGeometry, triangle, uploaded, float_texels, scratch, never)
#define SHADING(ROW)           ROW(5, shading, TriangleShading, triangle, uploaded, uint_texels, scratch, never)
#define TEXCOORDS(ROW)         ROW(6, texcoords, vec4, triangle, uploaded, float_texels, scratch, never)
#define VERTEX_COLORS(ROW)     ROW(7, vertex_colors, uvec4, triangle, uploaded, uint_texels, scratch, never)
#define TANGENTS(ROW)          ROW(8, tangents, uvec4, triangle, uploaded, uint_texels, scratch, never)
#define MATERIALS(ROW)         ROW(9, materials, SurfaceMaterial, material, uploaded, uint_texels, scratch, never)
#define TEXTURES(ROW)          ROW(10, textures, TextureLookup, rest, uploaded, uint_texels, scratch, never)
#define IMAGES(ROW)            ROW(11, images, uint, texel, uploaded, uint_texels, scratch, never)
#define LIGHTS(ROW)            ROW(12, lights, Light, light, uploaded, uint_texels, scratch, never)
#define ENVIRONMENT(ROW)       ROW(13, environment, vec4, sky_pixel, uploaded, float_texels, scratch, never)
#define ENVIRONMENT_ALIAS(ROW) ROW(14, environment_alias, uvec2, sky_pixel, uploaded, word_texels, scratch, never)
#define ASKED_LIGHTS(ROW)      ROW(15, asked_lights, AskedLight, light, uploaded, uint_texels, scratch, never)
// Of pixels.
#define HIT_POSITION(ROW)      ROW(16, hit_position, HitPosition, band_pixel, one, records, scratch, eye)
#define HIT_WEIGHT(ROW)        ROW(17, hit_weight, HitWeight, band_pixel, one, records, scratch, eye)
#define HIT_EMISSION(ROW)      ROW(18, hit_emission, HitEmission, band_pixel, one, records, scratch, eye)
#define AOVS(ROW)              ROW(19, aovs, Aovs, pixel, where_aovs, storage, summed, eye)
#define HIT_SURFACE(ROW)       ROW(20, hit_surface, HitSurface, band_pixel, where_glossy, records, scratch, apart)
#define EYE_PATHS(ROW)         ROW(21, eye_paths, EyeState, band_pixel, one, storage, scratch, never)
#define SEARCHES(ROW)          ROW(22, searches, uint, band_pixel, one, storage, scratch, never)
#define CURSORS(ROW)           ROW(23, cursors, Cursor, band_pixel, one, storage, scratch, never)
#define NEAREST(ROW)           ROW(24, nearest, float, band_pixel, nearest, storage, scratch, never)
#define GATHERED(ROW)          ROW(25, gathered, Gathered, band_pixel, one, records, scratch, gather)
#define FILM(ROW)              ROW(26, film, Film, pixel, one, words, summed, update)
#define PIXELS(ROW)            ROW(27, pixels, PixelState, pixel, one, records, carried, from_knn)
#define TALLY(ROW)             ROW(28, tally, uint, pixel, tallies, words, carried, from_knn)
#define MOMENTS(ROW)           ROW(29, moments, float, pixel, moments, words, carried, from_knn)
#define IMAGE(ROW)             ROW(30, image, vec3, band_pixel, one, storage, scratch, never)
#define TRACES(ROW)            ROW(31, traces, TraceState, band_pixel, where_traced, storage, scratch, never)
// Of photons: [lanes x capacity] slots, and sorted once a level of the grid.
#define PATHS(ROW)             ROW(32, paths, PathState, photon_lane, one, storage, scratch, never)
#define PHOTONS(ROW)           ROW(33, photons, Photon, photon_slot, one, records, scratch, apart)
#define PHOTON_FLUX(ROW)       ROW(34, photon_flux, PhotonFlux, photon_slot, one, records, scratch, apart)
#define SORTED(ROW)            ROW(35, sorted, Photon, photon_slot, levels, records, scratch, apart)
#define SORTED_FLUX(ROW)       ROW(36, sorted_flux, PhotonFlux, photon_slot, levels, records, scratch, apart)
#define PAIRS_A(ROW)           ROW(37, pairs_a, uvec2, photon_slot, levels, storage, scratch, never)
#define PAIRS_B(ROW)           ROW(38, pairs_b, uvec2, photon_slot, levels, storage, scratch, never)
#define COUNTERS(ROW)          ROW(39, counters, uint, counter, one, words, scratch, apart)
// [rings x F_QUANTILES] thresholds of the F-tests.
#define QUANTILES(ROW)         ROW(40, quantiles, float, rest, uploaded, word_texels, scratch, never)
// Of pixels again: searches that are unfinished.
#define SEARCH_STATES(ROW)     ROW(41, search_states, SearchState, band_pixel, one, storage, scratch, never)
#define LIGHT_RAYS(ROW)        ROW(42, light_rays, LightRay, band_pixel, asked_groups, storage, scratch, never)
// Of the scene again: instances of meshes, and of pixels in glossy scenes that have some, in which one the hit is.
#define INSTANCES(ROW)         ROW(43, instances, Instance, instance, uploaded, uint_texels, scratch, never)
#define HIT_INSTANCE(ROW)      ROW(44, hit_instance, uint, band_pixel, where_instances, words, scratch, never)
// [ERROR_GROUPS x pixels] where errors are estimated: sums over the iterations of a group, of radiance in x, y and z,
// of the bias of its luminance in w (include/error_groups.glsl).
#define ERRORS(ROW)            ROW(45, errors, vec4, pixel, error_groups, records, summed, update)
// Of the scene again, where lights are in a tree: of a triangle its lamp, branch << 1 | which
// child, or NO_LAMP.
#define LIGHT_TREE(ROW)        ROW(46, light_tree, LightBranch, light, uploaded, uint_texels, scratch, never)
#define LAMPS(ROW)             ROW(47, lamps, uint, triangle, uploaded, word_texels, scratch, never)

#define FIRST_SCENE_BUFFERS(ROW)                                                                             \
    TRIANGLES(ROW) SHADING(ROW) TEXCOORDS(ROW) VERTEX_COLORS(ROW) TANGENTS(ROW) MATERIALS(ROW) TEXTURES(ROW) \
    IMAGES(ROW) LIGHTS(ROW) ENVIRONMENT(ROW) ENVIRONMENT_ALIAS(ROW) ASKED_LIGHTS(ROW)
#define SCENE_BUFFERS(ROW) FIRST_SCENE_BUFFERS(ROW) INSTANCES(ROW) LIGHT_TREE(ROW) LAMPS(ROW)
#define BUFFERS(ROW)                                                                                      \
    PARAMS(ROW) STATUS(ROW) GRID(ROW) NODES(ROW) FIRST_SCENE_BUFFERS(ROW)                                 \
    HIT_POSITION(ROW) HIT_WEIGHT(ROW) HIT_EMISSION(ROW) AOVS(ROW) HIT_SURFACE(ROW) EYE_PATHS(ROW)         \
    SEARCHES(ROW) CURSORS(ROW) NEAREST(ROW) GATHERED(ROW) FILM(ROW) PIXELS(ROW) TALLY(ROW) MOMENTS(ROW)   \
    IMAGE(ROW) TRACES(ROW)                                                                                \
    PATHS(ROW) PHOTONS(ROW) PHOTON_FLUX(ROW) SORTED(ROW) SORTED_FLUX(ROW) PAIRS_A(ROW) PAIRS_B(ROW)       \
    COUNTERS(ROW) QUANTILES(ROW) SEARCH_STATES(ROW) LIGHT_RAYS(ROW) INSTANCES(ROW)                        \
    HIT_INSTANCE(ROW) ERRORS(ROW) LIGHT_TREE(ROW) LAMPS(ROW)
// clang-format on

// PARAMS(BINDING_NUMBER): its binding.
#define BINDING_NUMBER(number, name, Element, per, entries, access, life, hashed) number
#define TEXELS_BINDING 64  // beyond every row
