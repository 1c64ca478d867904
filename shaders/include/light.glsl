// Light sources: where light paths begin, and one sample of all light that arrives at a point, for next-event
// estimation. Densities (pdf) are 1/sr. Reads lights, and textures of those that have them.
#ifndef LIGHT_GLSL
#define LIGHT_GLSL

#include "include/kernel.glsl"
#include "include/direct.glsl"
#include "include/entry.glsl"
#include "include/environment.glsl"
#include "include/frame.glsl"
#include "include/light_tree.glsl"
#include "include/rng.glsl"
#include "include/sampling.glsl"
#include "include/scene.glsl"
#include "include/surface.glsl"
#include "include/texture.glsl"

LIGHTS(RECORDS)
ASKED_LIGHTS(RECORDS)

// Of a spot or directional light: the unit direction of travel along its axis. Of a spot light: versines of its inner
// and its outer cone.
vec3 axis_of(Light light) { return light.e1; }
vec2 cones_of(Light light) { return light.e2.xy; }

// Of a point or spot light: the distance beyond which it sheds no light, frame units; 0: there is none.
float range_of(Light light) { return light.e2.z; }

// The share of the light of a point or spot light that gets so far (KHR_lights_punctual, Range Property).
float share_within_range(float range, float distance) {
    if (range == 0.0) return 1.0;
    float squared = (distance / range) * (distance / range);
    return max(0.0, 1.0 - squared * squared);
}

// How far a photon of such a light gets: beyond a distance in the share above. u in [0, 1).
float sample_reach(float range, float u) { return range * sqrt(sqrt(1.0 - u)); }

// Whether of what a light emits only a share gets out, by place or direction.
bool has_share(Light light) { return HAS_TEXTURED_LIGHTS && light.textured != 0u; }

// That share of a triangle at a point of it for a ray of that direction that meets it there: its textures, where the
// surface is there, below its clearcoat.
vec3 emitted_share(Light light, vec2 b, vec3 direction) {
    vec2 barycentric = (1.0 - b.x - b.y) * light.corner[0] + b.x * light.corner[1] + b.y * light.corner[2];
    SurfaceMaterial material = materials_at(material_of(texelFetch(shading_texels, int(light.triangle)).w));
    vec4 coordinates = HAS_TEXTURES ? texcoords_at(light.triangle, barycentric) : vec4(0.0);
    if (HAS_ALPHA) {
        if (HAS_VERTEX_COLORS) {
            material.opacity *= vertex_color_at(light.triangle, barycentric).a;
        }
        if (HAS_TEXTURES) {
            material.opacity *= texture_at(material.texture[TEXTURE_BASE_COLOR], coordinates).a;
        }
    }
    vec3 share = vec3(coverage_of(material));
    if (HAS_TEXTURES) share *= texture_at(material.texture[TEXTURE_EMISSIVE], coordinates).rgb;
    if (HAS_CLEARCOAT && material.clearcoat > 0.0) {
        Hit hit = Hit(0.0, light.triangle, barycentric, NO_INSTANCE);  // what emits is no instance
        Surface surface = surface_at(hit, direction);
        if (HAS_TEXTURES) {
            material.clearcoat *= texture_at(material.texture[TEXTURE_CLEARCOAT], coordinates).r;
            if (HAS_NORMAL_MAPS) {
                vec3 texel = texture_at(material.texture[TEXTURE_CLEARCOAT_NORMAL], coordinates).xyz;
                surface.clearcoat_normal = bent_clearcoat(hit, direction, surface, material, texel);
            }
        }
        share *= share_below_clearcoat(material, surface, direction);
    }
    return share;
}

// A light in proportion to its power (alias table, Walker 1974), by the first two of four random words.
Light choose_light(uvec4 bits, out uint index) {
    uint low;
    umulExtended(bits.x, params.light_count, index, low);
    Light light = lights_at(index);
    if (unit_floats(bits).y >= light.keep) {
        index = light.alias_entry;
        light = lights_at(index);
    }
    return light;
}

// The lights of a lamp are drawn in proportion to their power, too, by one word, of which the light keeps what it has
// not used: equidistributed words stay so. power: of the lamp.
uint choose_asked(Lamp lamp, inout uint word, out float power) {
    AskedLight asked = asked_lights_at(lamp.first);
    power = asked.power;
    if (lamp.count == 1u) return asked.light;
    uint entry, low;
    umulExtended(word, lamp.count, entry, low);
    asked = asked_lights_at(lamp.first + entry);
    float share = unit_float(low);
    bool keeps = share < asked.keep;
    share = keeps ? share / asked.keep : (share - asked.keep) / (1.0 - asked.keep);
    word = uint(min(share, LARGEST_UNIT) * 4294967296.0);
    return keeps ? asked.light : asked.alias_light;
}

// Steps that it takes to find one, or how often it is asked for, beyond one.
int local_light_steps() { return HAS_LIGHT_TREE ? int(params.asked[0].depth) : 0; }

// About the density, per area, in which points of an emitter are asked for where its lamp is always asked for: exact
// but for what textures vary. emission: without textures; power: of the lamp.
float emitter_density(vec3 emission, bool double_sided, float power) {
    // Not the sum of the channels, which may be beyond floats.
    return dot(emission / power, vec3(double_sided ? 2.0 * PI / 3.0 : PI / 3.0));
}

// Of a triangle that emits, without textures.
vec3 emission_of(uint triangle) {
    return materials_at(material_of(texelFetch(shading_texels, int(triangle)).w)).emission;
}

// The lamp in the light tree of a triangle that emits; NO_LAMP: there is no tree. power: of the lamp.
uint lamp_with_power(uint triangle, out float power) {
    uint lamp = HAS_LIGHT_TREE ? lamp_of(triangle) : NO_LAMP;
    power = params.local_power;
    if (HAS_LIGHT_TREE && lamp != NO_LAMP) power = asked_lights_at(first_of(lamp)).power;
    return lamp;
}

// Densities, 1/sr, in which a direction to an emitter is asked for.
struct AskedDensity {
    float density;
    float of_lamp;  // the same if its lamp was always asked for: include/direct.glsl
};

// Those of a triangle that emits, for a ray that meets it `distance` away.
AskedDensity met_density(uint triangle, SurfaceMaterial material, Surface surface, vec3 direction, float distance) {
    // Without textures, as where the light is asked for.
    vec3 emission = HAS_TEXTURES ? materials_at(surface.material).emission : material.emission;
    float cosine = max(1e-12, -dot(direction, surface.geometric));
    float power;
    uint lamp = lamp_with_power(triangle, power);
    float of_lamp = emitter_density(emission, has(material, SURFACE_DOUBLE_SIDED), power);
    of_lamp *= distance * distance / cosine;
    return AskedDensity(of_lamp * lamp_probability(lamp, surface.position - distance * direction), of_lamp);
}

// The density, 1/sr, in which directions to the environment are asked for.
float environment_density(vec3 away) {
    uint pixel = environment_pixel(away);
    vec3 radiance = texelFetch(environment_texels, int(pixel)).rgb;
    return (radiance.r + radiance.g + radiance.b) * environment_area(pixel) / (3.0 * params.environment_power);
}

// One sample of the light of a group that arrives at a point.
struct LightSample {
    vec3 direction;   // unit, towards the light
    float distance;
    vec3 radiance;    // over the density of the sample; of punctual lights the irradiance across it, over the
                      // probability
    float density;    // about that of the direction, 1/sr, the same function as of what a path meets; 0: punctual
    float of_lamp;    // AskedDensity
    uint triangle;    // that the light is a part of; NO_TRIANGLE: none
};

// A light of the group, and a point in proportion to what is emitted there. bits: two random words, which may be
// equidistributed; v: two numbers in [0, 1).
LightSample sample_light(AskedGroup group, uvec2 bits, vec2 v, vec3 position) {
    LightSample s = LightSample(vec3(0.0), FAR, vec3(0.0), 0.0, 0.0, NO_TRIANGLE);
    Lamp lamp = choose_lamp(group, position, bits.x, v);
    if (lamp.count == 0u) return s;
    float power;
    uint index = choose_asked(lamp, bits.x, power);
    Light light = lights_at(index);
    light.power *= power / lamp.probability / params.light_power;
    vec2 u = unit_floats(bits.xyxy).xy;
    vec3 towards = light.position - position;
    if (HAS_AREA_LIGHTS && light.kind == LIGHT_TRIANGLE) {
        vec2 b = sample_triangle(u);
        towards += b.x * light.e1 + b.y * light.e2;
        s.distance = length(towards);
        s.direction = towards / s.distance;
        bool double_sided = light.double_sided != 0u;
        float cosine = -dot(s.direction, face_normal(light.e1, light.e2));
        cosine = double_sided ? abs(cosine) : max(0.0, cosine);
        s.triangle = lights_at(index).triangle;
        float inverse = cosine / (s.distance * s.distance);
        s.radiance = light.power * (inverse / (double_sided ? 2.0 * PI : PI));
        if (has_share(light)) s.radiance *= emitted_share(light, b, s.direction);
        float density = emitter_density(emission_of(s.triangle), double_sided, power);
        if (cosine > 0.0) s.of_lamp = density / inverse;
        s.density = s.of_lamp * lamp.probability;
    }
    if ((HAS_POINT_LIGHTS || HAS_SPOT_LIGHTS) &&
        (light.kind == LIGHT_POINT || light.kind == LIGHT_SPOT)) {
        s.distance = length(towards);
        s.direction = towards / s.distance;
        s.radiance = light.power * (share_within_range(range_of(light), s.distance) / (s.distance * s.distance));
        if (light.kind == LIGHT_POINT) {
            s.radiance /= 4.0 * PI;
        } else {
            vec2 cones = cones_of(light);
            s.radiance *= spot_attenuation(cones.x, cones.y, versine(-s.direction, axis_of(light))) /
                          (2.0 * PI * (cones.x + (cones.y - cones.x) / 3.0));
        }
    }
    if (HAS_DIRECTIONAL_LIGHTS && light.kind == LIGHT_DIRECTIONAL) {
        s.direction = -axis_of(light);
        s.radiance = light.power / entry_area(axis_of(light));
    }
    if (HAS_ENVIRONMENT && light.kind == LIGHT_ENVIRONMENT) {
        s.radiance = light.power * sample_environment(bits.x, u.y, v, s.direction);
        s.density = environment_density(s.direction);
    }
    return s;
}

// The start of a light path: lights in proportion to their power, then position and direction in proportion to what the
// light emits there, so that every path carries the same power at its start (but for what a texture varies within a
// triangle, and entry_area within a pixel of the environment). bits: four random words; v: four numbers in [0, 1).
// near: length from the light within which photons bring what is left to them of what it sends (include/direct.glsl,
// include/split.glsl); of a light with a range the negative of how far the photon gets; else 0. Returns the kind of the
// light.
uint emit(uvec4 bits, vec4 v, out vec3 origin, out vec3 direction, out vec3 power, out float near) {
    vec4 u = unit_floats(bits);
    uint index;
    Light light = choose_light(bits, index);
    power = light.power;
    near = 0.0;
    // One kind after the other, each only where the scene has it.
    if (HAS_AREA_LIGHTS && light.kind == LIGHT_TRIANGLE) {
        vec2 b = sample_triangle(u.zw);
        vec3 n = face_normal(light.e1, light.e2);
        if (light.double_sided != 0u && v.w < 0.5) n = -n;
        vec3 local = sample_cosine(v.xy);
        direction = normalize(from_frame(n, local));
        if (HAS_SPLIT) near = params.near_lights;
        if (HAS_DIRECT) {
            uint triangle = lights_at(index).triangle;
            float of_lamp;
            lamp_with_power(triangle, of_lamp);
            near = near_emitter(emitter_density(emission_of(triangle), light.double_sided != 0u, of_lamp), local.z);
        }
        // Off the emitter by its rounding error, as `leave` does; its error travels in e-vectors' scale.
        vec3 extent = abs(light.position) + abs(light.e1) + abs(light.e2);
        float error = 4.8e-7 * max(extent.x, max(extent.y, extent.z));
        origin = light.position + b.x * light.e1 + b.y * light.e2 + error * n;
        if (has_share(light)) power *= emitted_share(light, b, -direction);
    }
    if (HAS_POINT_LIGHTS && light.kind == LIGHT_POINT) {
        direction = sample_azimuth(1.0 - 2.0 * v.x, v.y);
        origin = light.position;
        near = -sample_reach(range_of(light), v.z);
    }
    if (HAS_SPOT_LIGHTS && light.kind == LIGHT_SPOT) {
        vec2 cones = cones_of(light);
        vec3 local = sample_cone(sample_spot_versine(cones.x, cones.y, v.x), v.y);
        direction = normalize(from_frame(axis_of(light), local));
        origin = light.position;
        near = -sample_reach(range_of(light), v.z);
    }
    if (HAS_DIRECTIONAL_LIGHTS && light.kind == LIGHT_DIRECTIONAL) {
        direction = axis_of(light);
        origin = sample_entry(direction, v.xy);
    }
    if (HAS_ENVIRONMENT && light.kind == LIGHT_ENVIRONMENT) {
        vec3 away;
        power *= sample_environment(bits.z, u.w, v.xy, away);
        direction = -away;
        power *= entry_area(direction);
        origin = sample_entry(direction, v.zw);
    }
    return light.kind;
}

#endif
