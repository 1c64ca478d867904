// Light sources. Reads lights.
layout(binding = BIND_LIGHTS) uniform usamplerBuffer lights;

Light light_at(uint index) {
    uvec4 a = texelFetch(lights, int(index) * 4);
    uvec4 b = texelFetch(lights, int(index) * 4 + 1);
    uvec4 c = texelFetch(lights, int(index) * 4 + 2);
    uvec4 d = texelFetch(lights, int(index) * 4 + 3);
    return Light(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), uintBitsToFloat(b.w), uintBitsToFloat(c.xyz), c.w,
                 uintBitsToFloat(d.xyz), d.w);
}

// The start of a light path: lights in proportion to their power (alias table, Walker 1974), then position and
// direction in proportion to what the light emits there, so that every path carries the same power at its start.
// u, v: eight numbers in [0, 1).
void emit(vec4 u, vec4 v, out vec3 origin, out vec3 direction, out vec3 power) {
    float scaled = u.x * float(params.light_count);
    uint index = min(uint(scaled), params.light_count - 1u);
    Light light = light_at(index);
    if (u.y >= light.keep) light = light_at(light.alias_entry);
    power = light.power;
    if (light.kind == LIGHT_TRIANGLE) {
        vec2 b = sample_triangle(u.zw);
        vec3 n = normalize(cross(light.e1, light.e2));
        if (light.double_sided != 0u && v.w < 0.5) n = -n;
        direction = normalize(from_frame(n, sample_cosine(v.xy)));
        // Off the emitter by its rounding error, as `leave` does; its error travels in e-vectors' scale.
        vec3 extent = abs(light.position) + abs(light.e1) + abs(light.e2);
        float error = 4.8e-7 * max(extent.x, max(extent.y, extent.z));
        origin = light.position + b.x * light.e1 + b.y * light.e2 + error * n;
    } else if (light.kind == LIGHT_POINT) {
        direction = sample_azimuth(1.0 - 2.0 * v.x, v.y);
        origin = light.position;
    } else if (light.kind == LIGHT_SPOT) {
        direction = normalize(from_frame(light.e1, sample_azimuth(sample_spot_cosine(light.e2.x, light.e2.y, v.x), v.y)));
        origin = light.position;
    } else {
        direction = light.e1;
        origin = light.position + from_frame(light.e1, vec3(light.e2.x * sample_disc(v.xy), 0.0));
    }
}
