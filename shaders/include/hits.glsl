// What the eye pass leaves a pixel, one array a record.
layout(binding = BIND_HIT_POSITION, scalar) buffer HitPositionBlock { HitPosition hit_position[]; };
layout(binding = BIND_HIT_WEIGHT, scalar) buffer HitWeightBlock { HitWeight hit_weight[]; };
layout(binding = BIND_HIT_EMISSION, scalar) buffer HitEmissionBlock { HitEmission hit_emission[]; };
layout(binding = BIND_HIT_SURFACE, scalar) buffer HitSurfaceBlock { HitSurface hit_surface[]; };
layout(binding = BIND_GATHERED, scalar) buffer GatheredBlock { Gathered gathered[]; };

uint hit_state(uint pixel) { return hit_position[pixel].state & HIT_MASK; }

// True where the pixel has a surface to gather photons on.
bool gathers(uint pixel) { return (hit_position[pixel].state & HIT_DIFFUSE) != 0u; }

vec3 hit_albedo(uint pixel) {
    uint packed = hit_position[pixel].state >> 2u;
    return vec3(uvec3(packed, packed >> 10u, packed >> 20u) & 1023u) * (1.0 / 1023.0);
}

// Relative luminance, Rec. 709.
float luminance(vec3 c) { return dot(c, vec3(0.2126, 0.7152, 0.0722)); }
