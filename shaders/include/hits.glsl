// What the eye pass leaves a pixel, one array a record: written as storage, read as texels.
#ifndef HITS_GLSL
#define HITS_GLSL

#include "include/kernel.glsl"

HIT_POSITION(STORES)
HIT_WEIGHT(STORES)
HIT_EMISSION(STORES)
HIT_SURFACE(STORES)
HIT_INSTANCE(STORES)
GATHERED(STORES)
HIT_POSITION(RECORDS)
HIT_WEIGHT(RECORDS)
HIT_EMISSION(RECORDS)
HIT_SURFACE(RECORDS)
HIT_INSTANCE(TEXELS)
GATHERED(RECORDS)

// Of a hit whose HitSurface is kept.
uint instance_of_hit(uint pixel) {
    return HAS_INSTANCES ? texelFetch(hit_instance_texels, int(pixel)).x : NO_INSTANCE;
}

// HitPosition::state. kind: HIT_*; albedo: 10 bits a channel.
uint hit_state(uint kind, uvec3 albedo) { return kind | (albedo.x | albedo.y << 10u | albedo.z << 20u) << HIT_BITS; }

uint hit_kind(HitPosition hit) { return hit.state & HIT_MASK; }

// True where the pixel has a surface to gather photons on.
bool gathers(HitPosition hit) { return (hit.state & HIT_DIFFUSE) != 0u; }

bool gathers_both_sides(HitPosition hit) { return hit_kind(hit) == HIT_BOTH_SIDES; }

vec3 hit_albedo(uint pixel) {
    uint packed = hit_position_at(pixel).state >> HIT_BITS;
    return vec3(uvec3(packed, packed >> 10u, packed >> 20u) & 1023u) * (1.0 / 1023.0);
}

#endif
