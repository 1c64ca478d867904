// The point where a ray from far away comes within the scene's bounds, so that the precision of hits does not depend
// on how far away the eye or a light stands. A ray from inside, or one that misses, starts where it is.
#ifndef BOUNDS_GLSL
#define BOUNDS_GLSL

#include "include/kernel.glsl"

vec3 enter_bounds(vec3 origin, vec3 direction) {
    vec3 inverse = 1.0 / mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20)));
    vec3 a = (params.bounds_low - origin) * inverse;
    vec3 b = (params.bounds_high - origin) * inverse;
    vec3 low = min(a, b);
    vec3 high = max(a, b);
    float near = max(low.x, max(low.y, low.z));
    float far = min(high.x, min(high.y, high.z));
    // A little before the bounds: the box of a flat scene has no inside.
    return near > 0.0 && near <= far ? origin + direction * (near * 0.9999) : origin;
}

#endif
