#version 460
// Reads elements 0 and 1 of an array of every shared struct, adds to every scalar of every member its ordinal in the
// struct, and writes the sums to elements 2 and 3; the uniform block and the push constants go to element 4.
#extension GL_GOOGLE_include_directive : require
#include "shared/types.h"
#include "shared/buffers.h"
#include "include/records.glsl"
#include "shared/estimators.h"
#include "layout_members.h"

layout(local_size_x_id = SPEC_WORKGROUP) in;
layout(push_constant, scalar) uniform LaunchBlock { Launch launch; };
PARAMS(UNIFORM)

uint ordinal;

void bump(inout uint x) { x += ++ordinal; }
void bump(inout float x) { x += float(++ordinal); }
void bump(inout vec2 v) { for (int c = 0; c < 2; ++c) v[c] += float(++ordinal); }
void bump(inout vec3 v) { for (int c = 0; c < 3; ++c) v[c] += float(++ordinal); }
void bump(inout vec4 v) { for (int c = 0; c < 4; ++c) v[c] += float(++ordinal); }
void bump(inout uvec2 v) { for (int c = 0; c < 2; ++c) v[c] += ++ordinal; }
void bump(inout uvec3 v) { for (int c = 0; c < 3; ++c) v[c] += ++ordinal; }
void bump(inout uvec4 v) { for (int c = 0; c < 4; ++c) v[c] += ++ordinal; }
void bump(inout uint a[2]) { for (int i = 0; i < 2; ++i) a[i] += ++ordinal; }
void bump(inout uint a[3]) { for (int i = 0; i < 3; ++i) a[i] += ++ordinal; }
void bump(inout uint a[4]) { for (int i = 0; i < 4; ++i) a[i] += ++ordinal; }
void bump(inout uvec4 a[GRID_LEVELS]) { for (int i = 0; i < GRID_LEVELS; ++i) bump(a[i]); }
void bump(inout uint a[TEXTURE_COUNT]) { for (int i = 0; i < TEXTURE_COUNT; ++i) a[i] += ++ordinal; }
void bump(inout uint a[RADIUS_BINS]) { for (int i = 0; i < RADIUS_BINS; ++i) a[i] += ++ordinal; }
void bump(inout float a[MAX_RINGS]) { for (int i = 0; i < MAX_RINGS; ++i) a[i] += float(++ordinal); }
void bump(inout vec3 a[LAYERS]) { for (int i = 0; i < LAYERS; ++i) bump(a[i]); }
void bump(inout vec3 a[3]) { for (int i = 0; i < 3; ++i) bump(a[i]); }
void bump(inout vec4 a[2]) { for (int i = 0; i < 2; ++i) bump(a[i]); }
void bump(inout float a[2]) { for (int i = 0; i < 2; ++i) a[i] += float(++ordinal); }
void bump(inout vec2 a[3]) { for (int i = 0; i < 3; ++i) bump(a[i]); }
void bump(inout vec2 a[MAX_SECTORS / 2]) { for (int i = 0; i < MAX_SECTORS / 2; ++i) bump(a[i]); }
void bump(inout vec2 a[MAX_SECTORS]) { for (int i = 0; i < MAX_SECTORS; ++i) bump(a[i]); }

#define X(member) bump(value.member);
void bump(inout LightRay value) { MEMBERS_LIGHT_RAY }
void bump(inout LightRay a[ASKED_GROUPS]) { for (int i = 0; i < ASKED_GROUPS; ++i) bump(a[i]); }
void bump(inout LightRays value) { MEMBERS_LIGHT_RAYS }
void bump(inout AskedGroup value) { MEMBERS_ASKED_GROUP }
void bump(inout AskedGroup a[ASKED_GROUPS]) { for (int i = 0; i < ASKED_GROUPS; ++i) bump(a[i]); }
#define BLOCK(BINDING, Block, Struct, values) layout(binding = BINDING, scalar) buffer Block { Struct values[]; };
#define BUMP(Struct, value_in, value_out, MEMBERS) \
    {                                              \
        Struct value = value_in;                   \
        ordinal = 0u;                              \
        MEMBERS                                    \
        value_out = value;                         \
    }
// Two, of one work group, which no compiler knows: unrolled the kernel takes twice as long to compile.
#define ELEMENTS (gl_NumWorkGroups.x + 1u)
#define ROUND_TRIP(Struct, values, MEMBERS) \
    for (uint e = 0u; e < ELEMENTS; ++e) BUMP(Struct, values[e], values[e + 2u], MEMBERS)

#define FIRST HIT_POSITION(BINDING_NUMBER)
BLOCK(FIRST + 0, BvhNodeBlock, BvhNode, bvh_nodes)
BLOCK(FIRST + 1, TriangleGeometryBlock, TriangleGeometry, triangle_geometries)
BLOCK(FIRST + 2, TriangleShadingBlock, TriangleShading, triangle_shadings)
BLOCK(FIRST + 3, SurfaceMaterialBlock, SurfaceMaterial, surface_materials)
BLOCK(FIRST + 4, LightBlock, Light, lights)
BLOCK(FIRST + 5, PhotonBlock, Photon, photons)
BLOCK(FIRST + 6, PhotonFluxBlock, PhotonFlux, photon_fluxes)
BLOCK(FIRST + 7, HitPositionBlock, HitPosition, hit_positions)
BLOCK(FIRST + 8, HitWeightBlock, HitWeight, hit_weights)
BLOCK(FIRST + 9, HitEmissionBlock, HitEmission, hit_emissions)
BLOCK(FIRST + 10, GatheredBlock, Gathered, gathereds)
BLOCK(FIRST + 11, PixelStateBlock, PixelState, pixel_states)
BLOCK(FIRST + 12, AovsBlock, Aovs, aovs)
BLOCK(FIRST + 13, FilmBlock, Film, films)
BLOCK(FIRST + 14, PathStateBlock, PathState, path_states)
BLOCK(FIRST + 15, CursorBlock, Cursor, cursors)
BLOCK(FIRST + 16, GridBlock, Grid, grids)
BLOCK(FIRST + 17, StatusBlock, Status, statuses)
BLOCK(FIRST + 18, ParamsArrayBlock, Params, params_array)
BLOCK(FIRST + 19, LaunchArrayBlock, Launch, launches)
BLOCK(FIRST + 20, TextureLookupBlock, TextureLookup, texture_lookups)
BLOCK(FIRST + 21, HitSurfaceBlock, HitSurface, hit_surfaces)
BLOCK(FIRST + 22, TraceStateBlock, TraceState, trace_states)
BLOCK(FIRST + 23, LightRayBlock, LightRay, light_rays)
// The rows of this number and of the one for instances are read as texels alone; beyond the last row there is none.
BLOCK(ERRORS(BINDING_NUMBER), EyeStateBlock, EyeState, eye_states)
BLOCK(FIRST + 25, SearchStateBlock, SearchState, search_states)
BLOCK(FIRST + 26, AskedLightBlock, AskedLight, asked_lights)
BLOCK(GRID(BINDING_NUMBER), InstanceBlock, Instance, instance_records)
BLOCK(FIRST + 28, InstanceNodeBlock, InstanceNode, instance_nodes)
BLOCK(STATUS(BINDING_NUMBER), LightBranchBlock, LightBranch, light_branches)

void main() {
    if (gl_GlobalInvocationID.x != 0u) return;
    ROUND_TRIP(BvhNode, bvh_nodes, MEMBERS_BVH_NODE)
    ROUND_TRIP(TriangleGeometry, triangle_geometries, MEMBERS_TRIANGLE_GEOMETRY)
    ROUND_TRIP(TriangleShading, triangle_shadings, MEMBERS_TRIANGLE_SHADING)
    ROUND_TRIP(SurfaceMaterial, surface_materials, MEMBERS_SURFACE_MATERIAL)
    ROUND_TRIP(Light, lights, MEMBERS_LIGHT)
    ROUND_TRIP(Photon, photons, MEMBERS_PHOTON)
    ROUND_TRIP(PhotonFlux, photon_fluxes, MEMBERS_PHOTON_FLUX)
    ROUND_TRIP(HitPosition, hit_positions, MEMBERS_HIT_POSITION)
    ROUND_TRIP(HitWeight, hit_weights, MEMBERS_HIT_WEIGHT)
    ROUND_TRIP(HitEmission, hit_emissions, MEMBERS_HIT_EMISSION)
    ROUND_TRIP(Gathered, gathereds, MEMBERS_GATHERED)
    ROUND_TRIP(PixelState, pixel_states, MEMBERS_PIXEL_STATE)
    ROUND_TRIP(Aovs, aovs, MEMBERS_AOVS)
    ROUND_TRIP(Film, films, MEMBERS_FILM)
    ROUND_TRIP(PathState, path_states, MEMBERS_PATH_STATE)
    ROUND_TRIP(Cursor, cursors, MEMBERS_CURSOR)
    ROUND_TRIP(Grid, grids, MEMBERS_GRID)
    ROUND_TRIP(Status, statuses, MEMBERS_STATUS)
    ROUND_TRIP(Params, params_array, MEMBERS_PARAMS)
    ROUND_TRIP(Launch, launches, MEMBERS_LAUNCH)
    ROUND_TRIP(TextureLookup, texture_lookups, MEMBERS_TEXTURE_LOOKUP)
    ROUND_TRIP(Instance, instance_records, MEMBERS_INSTANCE)
    ROUND_TRIP(InstanceNode, instance_nodes, MEMBERS_INSTANCE_NODE)
    ROUND_TRIP(HitSurface, hit_surfaces, MEMBERS_HIT_SURFACE)
    ROUND_TRIP(TraceState, trace_states, MEMBERS_TRACE_STATE)
    ROUND_TRIP(LightRay, light_rays, MEMBERS_LIGHT_RAY)
    ROUND_TRIP(EyeState, eye_states, MEMBERS_EYE_STATE)
    ROUND_TRIP(SearchState, search_states, MEMBERS_SEARCH_STATE)
    ROUND_TRIP(AskedLight, asked_lights, MEMBERS_ASKED_LIGHT)
    ROUND_TRIP(LightBranch, light_branches, MEMBERS_LIGHT_BRANCH)
    BUMP(Params, params, params_array[4], MEMBERS_PARAMS)
    BUMP(Launch, launch, launches[4], MEMBERS_LAUNCH)
}
