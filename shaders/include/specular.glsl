// Mirrors and smooth dielectrics: one sampled event. Pure functions.

// Fresnel reflectance of a smooth dielectric, unpolarised. cosine in [0, 1] on the side of incidence,
// eta = index on that side / index beyond. cosine_t: cosine beyond, 0 under total internal reflection.
float fresnel_dielectric(float cosine, float eta, out float cosine_t) {
    float sin2_t = eta * eta * (1.0 - cosine * cosine);
    cosine_t = 0.0;
    if (sin2_t >= 1.0) return 1.0;
    cosine_t = sqrt(1.0 - sin2_t);
    float parallel = (cosine - eta * cosine_t) / (cosine + eta * cosine_t);
    float perpendicular = (eta * cosine - cosine_t) / (eta * cosine + cosine_t);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

// Reflectance of a metal: Schlick's approximation from the colour at normal incidence (glTF 2.0, appendix B).
vec3 fresnel_metal(vec3 f0, float cosine) {
    float m = clamp(1.0 - cosine, 0.0, 1.0);
    return f0 + (1.0 - f0) * (m * m) * (m * m) * m;
}

// Mirror direction, on the outer side of the geometric surface whatever the shading normal says.
vec3 mirror_direction(vec3 direction, vec3 normal, vec3 geometric) {
    vec3 r = reflect(direction, normal);
    return normalize(dot(r, geometric) > 0.0 ? r : reflect(direction, geometric));
}

// Goes on from a mirror or a dielectric: sets the direction and returns the factor of the throughput.
// radiance: true for eye paths, whose radiance changes by the squared ratio of indices across the surface
// (Veach 1997, section 5.2); false for the flux of photons.
vec3 scatter_specular(SurfaceMaterial material, Surface surface, float u, bool radiance, inout vec3 direction) {
    float cosine = min(1.0, -dot(direction, surface.normal));
    if (kind_of(material) == SURFACE_MIRROR) {
        direction = mirror_direction(direction, surface.normal, surface.geometric);
        return fresnel_metal(material.color, cosine);
    }
    float eta = surface.front ? 1.0 / material.ior : material.ior;
    float cosine_t;
    float reflectance = fresnel_dielectric(cosine, eta, cosine_t);
    if (u < reflectance) {
        direction = mirror_direction(direction, surface.normal, surface.geometric);
        return vec3(1.0);
    }
    vec3 t = normalize(eta * direction + (eta * cosine - cosine_t) * surface.normal);
    // Shading normals can bend a refracted ray back to its own side: it then goes on along the surface's far side.
    if (dot(t, surface.geometric) >= 0.0) t = direction;
    direction = t;
    return material.color * (radiance ? eta * eta : 1.0);
}
