// Where light from infinity enters the scene: by the box of its bounds or, where that shows less of itself, by their
// sphere. What misses the scene is wasted: the box about a ball shows twice as much as the ball, the sphere about a
// plain many times as much as the plain seen at a slant.
#ifndef ENTRY_GLSL
#define ENTRY_GLSL

#include "include/kernel.glsl"
#include "include/frame.glsl"
#include "include/sampling.glsl"

// What the faces of the box across x, y and z show of themselves along a unit vector: the at most three that are turned
// to the light cover the silhouette once.
vec3 projected_faces(vec3 direction) {
    vec3 extent = params.bounds_high - params.bounds_low;
    return abs(direction) * extent.yzx * extent.zxy;
}

float projected_sphere() { return PI * params.bounds_radius * params.bounds_radius; }

// The area across `direction` by which parallel light along it enters.
float entry_area(vec3 direction) {
    vec3 faces = projected_faces(direction);
    return min(faces.x + faces.y + faces.z, projected_sphere());
}

// A point there, uniform across `direction`. u: two numbers in [0, 1).
vec3 sample_entry(vec3 direction, vec2 u) {
    vec3 faces = projected_faces(direction);
    float area = faces.x + faces.y + faces.z;
    if (projected_sphere() < area) return from_frame(direction, params.bounds_radius * vec3(sample_disc(u), -1.0));
    // A face in proportion to its projection, then a point of it. 0: the low face of an axis, 1: the high one.
    float x = u.x * area;
    vec3 place = vec3(lessThanEqual(direction, vec3(0.0)));
    if (x < faces.x) {
        place.yz = vec2(x / faces.x, u.y);
    } else if (x - faces.x < faces.y) {
        place.zx = vec2((x - faces.x) / faces.y, u.y);
    } else {
        // By rounding, also where this face is seen end-on.
        place.xy = vec2(min(1.0, (x - faces.x - faces.y) / max(1e-30, faces.z)), u.y);
    }
    return mix(params.bounds_low, params.bounds_high, place);
}

#endif
