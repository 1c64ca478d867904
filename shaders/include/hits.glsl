// What the eye pass leaves a pixel, one array a record: written as storage, read as texels.
layout(binding = BIND_HIT_POSITION, scalar) writeonly buffer HitPositionBlock { HitPosition hit_position[]; };
layout(binding = BIND_HIT_WEIGHT, scalar) writeonly buffer HitWeightBlock { HitWeight hit_weight[]; };
layout(binding = BIND_HIT_EMISSION, scalar) writeonly buffer HitEmissionBlock { HitEmission hit_emission[]; };
layout(binding = BIND_HIT_SURFACE, scalar) writeonly buffer HitSurfaceBlock { HitSurface hit_surface[]; };
layout(binding = BIND_GATHERED, scalar) writeonly buffer GatheredBlock { Gathered gathered[]; };
layout(binding = BIND_HIT_POSITION_TEXELS) uniform usamplerBuffer hit_positions;
layout(binding = BIND_HIT_WEIGHT_TEXELS) uniform usamplerBuffer hit_weights;
layout(binding = BIND_HIT_EMISSION_TEXELS) uniform usamplerBuffer hit_emissions;
layout(binding = BIND_HIT_SURFACE_TEXELS) uniform usamplerBuffer hit_surfaces;
layout(binding = BIND_GATHERED_TEXELS) uniform usamplerBuffer gathered_sums;

HitPosition hit_position_at(uint pixel) {
    uvec4 texel = texelFetch(hit_positions, int(pixel));
    return HitPosition(uintBitsToFloat(texel.xyz), texel.w);
}

HitWeight hit_weight_at(uint pixel) {
    uvec4 texel = texelFetch(hit_weights, int(pixel));
    return HitWeight(uintBitsToFloat(texel.xyz), texel.w);
}

HitEmission hit_emission_at(uint pixel) {
    vec4 texel = uintBitsToFloat(texelFetch(hit_emissions, int(pixel)));
    return HitEmission(texel.xyz, texel.w);
}

HitSurface hit_surface_at(uint pixel) {
    uvec4 texel = texelFetch(hit_surfaces, int(pixel));
    return HitSurface(texel.x, uintBitsToFloat(texel.yz), texel.w);
}

Gathered gathered_at(uint pixel) {
    uvec4 a = texelFetch(gathered_sums, int(pixel) * 2);
    uvec4 b = texelFetch(gathered_sums, int(pixel) * 2 + 1);
    return Gathered(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), 0u);
}

// True where the pixel has a surface to gather photons on.
bool gathers(HitPosition hit) { return (hit.state & HIT_DIFFUSE) != 0u; }

vec3 hit_albedo(uint pixel) {
    uint packed = hit_position_at(pixel).state >> 2u;
    return vec3(uvec3(packed, packed >> 10u, packed >> 20u) & 1023u) * (1.0 / 1023.0);
}

// Relative luminance, Rec. 709.
float luminance(vec3 c) { return dot(c, vec3(0.2126, 0.7152, 0.0722)); }
