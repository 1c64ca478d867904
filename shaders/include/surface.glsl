// The surface at a hit, on the side from which it was met. Reads triangles, shading and materials.
struct Surface {
    vec3 position;
    vec3 geometric;    // unit normals on the side of the incoming ray
    vec3 normal;       // shading
    float error;       // rays start this far from `position` along +-geometric
    bool front;        // met from the front of the triangle
    uint material;
};

Surface surface_at(Hit hit, vec3 direction) {
    int texel = int(hit.triangle) * 3;
    vec4 v0 = texelFetch(triangles, texel);
    vec3 e1 = texelFetch(triangles, texel + 1).xyz;
    vec3 e2 = texelFetch(triangles, texel + 2).xyz;
    uvec4 corner = texelFetch(shading, int(hit.triangle));
    Surface surface;
    // Barycentrics put the point within the rounding error of the plane, however long the ray was.
    surface.position = v0.xyz + hit.barycentric.x * e1 + hit.barycentric.y * e2;
    surface.geometric = normalize(cross(e1, e2));
    surface.front = dot(surface.geometric, direction) < 0.0;
    surface.error = v0.w;
    surface.material = corner.w & ~SHADING_FLAT;
    float side = surface.front ? 1.0 : -1.0;
    surface.geometric *= side;
    surface.normal = surface.geometric;
    if ((corner.w & SHADING_FLAT) == 0u) {
        vec3 n = (1.0 - hit.barycentric.x - hit.barycentric.y) * unpack_direction(corner.x) +
                 hit.barycentric.x * unpack_direction(corner.y) + hit.barycentric.y * unpack_direction(corner.z);
        float squared = dot(n, n);
        // Opposite corner normals can cancel: the geometric normal stands in.
        if (squared > 1e-8) surface.normal = side * inversesqrt(squared) * n;
        // A shading normal that faces away from the ray would see the surface from behind.
        if (dot(surface.normal, direction) >= 0.0) surface.normal = surface.geometric;
    }
    return surface;
}

// Origin of a ray that leaves the surface into `direction`, off its plane by the rounding error of the hit.
vec3 leave(Surface surface, vec3 direction) {
    return surface.position + (dot(direction, surface.geometric) > 0.0 ? surface.error : -surface.error) * surface.geometric;
}
