// The surface at a hit, on the side from which it was met: its point, its normals and its material with all textures.
// Reads triangles, shading, vertex attributes, materials and textures.
#ifndef SURFACE_GLSL
#define SURFACE_GLSL

#include "include/kernel.glsl"
#include "include/frame.glsl"
#include "include/fresnel.glsl"
#include "include/scene.glsl"
#include "include/texture.glsl"
#include "include/traverse.glsl"

struct Surface {
    vec3 position;
    vec3 geometric;         // unit normals on the side of the incoming ray
    vec3 normal;            // shading
    vec3 clearcoat_normal;  // of the coat on top
    vec3 tangent;           // unit, about `normal`: where anisotropic facets are wider
    float error;            // rays start this far from `position` along +-geometric
    bool front;             // met from the front of the triangle
    uint material;
};

bool is_in_instance(Hit hit) { return HAS_INSTANCES && hit.instance != NO_INSTANCE; }

// The instance that was hit, where is_in_instance().
Instance instance_of(Hit hit) { return instances_at(is_in_instance(hit) ? hit.instance : 0u); }

// A corner's shading normal, in the scene frame. at: of the hit.
vec3 corner_normal(Hit hit, Instance at, uint packed) {
    vec3 n = unpack_direction(packed);
    return is_in_instance(hit) ? normalize(normal_to_scene(at, n)) : n;
}

// Moves the hit into its triangle: the slack lets it lie outside by rounding, which is far in barycentrics of a sliver.
Surface surface_at(inout Hit hit, vec3 direction) {
    int texel = int(hit.triangle) * 3;
    vec4 v0 = texelFetch(triangles_texels, texel);
    vec4 edge1 = texelFetch(triangles_texels, texel + 1);
    vec4 edge2 = texelFetch(triangles_texels, texel + 2);
    vec3 e1 = edge1.xyz;
    vec3 e2 = edge2.xyz;
    vec2 inside = max(hit.barycentric, vec2(0.0));
    // Over the third edge: back along the shorter one of the others, mostly.
    inside -= max(0.0, inside.x + inside.y - 1.0) * vec2(edge1.w, edge2.w) / (edge1.w + edge2.w);
    hit.barycentric = max(inside, vec2(0.0));
    uvec4 corner = texelFetch(shading_texels, int(hit.triangle));
    Surface surface;
    // Barycentrics put the point within the rounding error of the plane, however long the ray was.
    surface.position = v0.xyz + hit.barycentric.x * e1 + hit.barycentric.y * e2;
    surface.error = v0.w;
    float hand = 1.0;
    Instance at = instance_of(hit);
    if (is_in_instance(hit)) {
        surface.position = point_to_scene(at, surface.position);
        surface.error = at.error + at.stretch * v0.w;
        e1 = linear_to_scene(at, e1);
        e2 = linear_to_scene(at, e2);
        hand = at.hand;
    }
    surface.geometric = face_normal(e1, e2);
    if (HAS_INSTANCES) surface.geometric *= hand;
    surface.front = dot(surface.geometric, direction) < 0.0;
    surface.material = material_of(corner.w);
    float side = surface.front ? 1.0 : -1.0;
    surface.geometric *= side;
    surface.normal = surface.geometric;
    if (!is_flat(corner.w)) {
        vec3 n = (1.0 - hit.barycentric.x - hit.barycentric.y) * corner_normal(hit, at, corner.x) +
                 hit.barycentric.x * corner_normal(hit, at, corner.y) +
                 hit.barycentric.y * corner_normal(hit, at, corner.z);
        float squared = dot(n, n);
        // Opposite corner normals can cancel: the geometric normal stands in.
        if (squared > 1e-8) surface.normal = side * inversesqrt(squared) * n;
        // A shading normal that faces away from the ray would see the surface from behind.
        if (dot(surface.normal, direction) >= 0.0) surface.normal = surface.geometric;
    }
    surface.clearcoat_normal = surface.normal;
    surface.tangent = vec3(0.0);
    return surface;
}

// Origin of a ray that leaves the surface into `direction`, off its plane by the rounding error of the hit.
vec3 leave(Surface surface, vec3 direction) {
    float side = dot(direction, surface.geometric) > 0.0 ? 1.0 : -1.0;
    return surface.position + side * surface.error * surface.geometric;
}

// A corner's tangent, in the scene frame. at: of the hit.
vec3 corner_tangent(Hit hit, Instance at, uint packed) {
    vec3 t = unpack_direction(packed);
    return is_in_instance(hit) ? normalize(linear_to_scene(at, t)) : t;
}

// The tangent of the triangle at the hit, on its front: that of the file, else the derivative of the point by u of a
// texture, as KHR_texture_transform leaves it, or of the first set where texture_number is 0.
// w: the sign of the bitangent; 0 where there is no tangent to be had.
vec4 tangent_at(Hit hit, uint texture_number) {
    Instance at = instance_of(hit);
    float hand = is_in_instance(hit) ? at.hand : 1.0;  // a mirror turns the bitangent
    if (HAS_TANGENTS) {
        uvec4 corner = texelFetch(tangents_texels, int(hit.triangle));
        if ((corner.w & TANGENTS_GIVEN) == TANGENTS_GIVEN) {
            vec3 t = (1.0 - hit.barycentric.x - hit.barycentric.y) * corner_tangent(hit, at, corner.x) +
                     hit.barycentric.x * corner_tangent(hit, at, corner.y) +
                     hit.barycentric.y * corner_tangent(hit, at, corner.z);
            return vec4(t, (corner.w & TANGENTS_TURNED) != 0u ? -hand : hand);
        }
    }
    int texel = int(hit.triangle) * 3;
    vec3 e1 = texelFetch(triangles_texels, texel + 1).xyz;
    vec3 e2 = texelFetch(triangles_texels, texel + 2).xyz;
    vec4 uv0 = texelFetch(texcoords_texels, texel);
    vec4 d1 = texelFetch(texcoords_texels, texel + 1) - uv0;
    vec4 d2 = texelFetch(texcoords_texels, texel + 2) - uv0;
    bool second_uv = false;
    vec4 rows = vec4(1.0, 0.0, 0.0, 1.0);
    if (HAS_TEXTURES && texture_number != 0u) {
        TextureLookup lookup = textures_at(texture_number - 1u);
        second_uv = (lookup.flags & TEXTURE_SECOND_UV) != 0u;
        rows = lookup.matrix;
    }
    vec2 of_u = second_uv ? vec2(d1.z, d2.z) : vec2(d1.x, d2.x);
    vec2 of_v = second_uv ? vec2(d1.w, d2.w) : vec2(d1.y, d2.y);
    vec2 du = rows.x * of_u + rows.y * of_v;
    vec2 dv = rows.z * of_u + rows.w * of_v;
    float area = du.x * dv.y - du.y * dv.x;
    if (area == 0.0) return vec4(0.0);
    float turn = sign(area);
    vec3 t = turn * (e1 * dv.y - e2 * dv.x);
    if (is_in_instance(hit)) t = linear_to_scene(at, t);
    // glTF's v runs down the image, and its bitangent up: cross(n, t) where the image is not mirrored, and there (u, v)
    // turn clockwise.
    return vec4(t, -turn * hand);
}

// The unit tangent and bitangent about the normal `front_normal` on the front of the triangle; false: there are none.
bool tangent_frame(Hit hit, vec3 front_normal, uint texture_number, out vec3 t, out vec3 b) {
    vec4 tangent = tangent_at(hit, texture_number);
    t = tangent.xyz - front_normal * dot(front_normal, tangent.xyz);
    float length2 = dot(t, t);
    t *= inversesqrt(length2);
    b = cross(front_normal, t) * tangent.w;
    return tangent.w != 0.0 && length2 != 0.0;
}

// The normal `front_normal` bent by a texel of a normal texture; both normals on the front of the triangle.
vec3 bent_normal(Hit hit, vec3 front_normal, uint texture_number, float scale, vec3 texel) {
    if (texture_number == 0u) return front_normal;
    vec3 t, b;
    if (!tangent_frame(hit, front_normal, texture_number, t, b)) return front_normal;
    vec3 n = texel * 2.0 - 1.0;
    n.xy *= scale;
    return normalize(n.x * t + n.y * b + n.z * front_normal);
}

// The normal of the clearcoat, bent by a texel of its own normal texture. surface: with the normal of its vertices.
vec3 bent_clearcoat(Hit hit, vec3 direction, Surface surface, SurfaceMaterial material, vec3 texel) {
    float side = surface.front ? 1.0 : -1.0;
    vec3 n = side * bent_normal(hit, side * surface.normal, material.texture[TEXTURE_CLEARCOAT_NORMAL],
                                material.clearcoat_normal_scale, texel);
    return dot(n, direction) >= 0.0 ? surface.geometric : n;
}

// Turns the tangent of the surface to where the facets of the material are wider, in the frame that normal textures are
// in: of the texture coordinates of the normal texture, else of the anisotropy texture, else of the first set. Without
// such a frame the material has no anisotropy. texel: of the anisotropy texture, where there is one.
void set_tangent(Hit hit, vec3 texel, inout Surface surface, inout SurfaceMaterial material) {
    uint of = 0u;
    vec2 direction = vec2(1.0, 0.0);
    if (HAS_TEXTURES && has(material, SURFACE_TEXTURED)) {
        uint number = material.texture[TEXTURE_ANISOTROPY];
        if (number != 0u) {
            direction = texel.rg * 2.0 - 1.0;
            material.anisotropy.z *= texel.b;
        }
        uint bending = material.texture[TEXTURE_NORMAL];
        of = bending != 0u ? bending : number;
    }
    vec2 turn = material.anisotropy.xy;
    direction = vec2(turn.x * direction.x - turn.y * direction.y, turn.y * direction.x + turn.x * direction.y);
    vec3 t, b;
    bool framed = tangent_frame(hit, surface.front ? surface.normal : -surface.normal, of, t, b);
    if (framed && direction != vec2(0.0)) {
        surface.tangent = normalize(direction.x * t + direction.y * b);
    } else {
        material.anisotropy.z = 0.0;
    }
}

// Whether a kind of texture (TEXTURE_*) has to be looked up in this scene.
bool is_read(int kind) {
    if (kind == TEXTURE_METALLIC_ROUGHNESS) return HAS_REFLECTION || HAS_TRANSMISSION;
    if (kind == TEXTURE_TRANSMISSION) return HAS_TRANSMISSION;
    if (kind == TEXTURE_SPECULAR || kind == TEXTURE_SPECULAR_COLOR) return HAS_COAT || HAS_SPECULAR_GLASS;
    if (kind == TEXTURE_CLEARCOAT || kind == TEXTURE_CLEARCOAT_ROUGHNESS) return HAS_CLEARCOAT;
    if (kind == TEXTURE_NORMAL) return HAS_NORMAL_MAPS;
    if (kind == TEXTURE_CLEARCOAT_NORMAL) return HAS_NORMAL_MAPS && HAS_CLEARCOAT;
    if (kind == TEXTURE_ANISOTROPY) return HAS_ANISOTROPY;
    if (kind == TEXTURE_IRIDESCENCE || kind == TEXTURE_IRIDESCENCE_THICKNESS) return HAS_IRIDESCENCE;
    if (kind == TEXTURE_SHEEN_COLOR || kind == TEXTURE_SHEEN_ROUGHNESS) return HAS_SHEEN;
    return true;
}

// The texels of a material at the coordinates of both sets, by their kind; white where it has none. All lanes run what
// one of them runs: a loop over the textures that there are looks up as many as the material with the most has, and is
// compiled once. Arrays are indexed by constants alone, once loops are unrolled: registers, not memory.
void read_textures(SurfaceMaterial material, vec4 coordinates, out vec4 texels[TEXTURE_COUNT]) {
    uint there = 0u;
    for (int kind = 0; kind < TEXTURE_COUNT; ++kind) {
        texels[kind] = vec4(1.0);
        if (is_read(kind) && material.texture[kind] != 0u) there |= 1u << kind;
    }
    while (there != 0u) {
        int next = findLSB(there);
        there &= there - 1u;
        uint number = 0u;
        for (int kind = 0; kind < TEXTURE_COUNT; ++kind) {
            if (is_read(kind)) number = kind == next ? material.texture[kind] : number;
        }
        vec4 texel = texture_at(number, coordinates);
        for (int kind = 0; kind < TEXTURE_COUNT; ++kind) {
            if (is_read(kind)) texels[kind] = kind == next ? texel : texels[kind];
        }
    }
}

// What a path spends of its budget of steps, trips of loops, at a surface that it meets.
int vertex_steps() { return HAS_TEXTURES ? 1 + TEXTURE_COUNT : 1; }

// The material at the hit. Bends the normals of the surface where it has normal textures, and turns its tangent.
SurfaceMaterial material_at(Hit hit, vec3 direction, inout Surface surface) {
    SurfaceMaterial material = materials_at(surface.material);
    if (HAS_VERTEX_COLORS) {
        vec4 color = vertex_color_at(hit.triangle, hit.barycentric);
        material.color *= color.rgb;
        material.opacity *= color.a;
    }
    vec4 texels[TEXTURE_COUNT];
    if (HAS_TEXTURES && has(material, SURFACE_TEXTURED)) {
        read_textures(material, texcoords_at(hit.triangle, hit.barycentric), texels);
        material.color *= texels[TEXTURE_BASE_COLOR].rgb;
        material.opacity *= texels[TEXTURE_BASE_COLOR].a;
        material.emission *= texels[TEXTURE_EMISSIVE].rgb;
        material.roughness *= texels[TEXTURE_METALLIC_ROUGHNESS].g;
        material.metallic *= texels[TEXTURE_METALLIC_ROUGHNESS].b;
        material.transmission *= texels[TEXTURE_TRANSMISSION].r;
        material.specular *= texels[TEXTURE_SPECULAR].a;
        material.specular_color *= texels[TEXTURE_SPECULAR_COLOR].rgb;
        material.clearcoat *= texels[TEXTURE_CLEARCOAT].r;
        material.clearcoat_roughness *= texels[TEXTURE_CLEARCOAT_ROUGHNESS].g;
        if (HAS_IRIDESCENCE) {
            // The thickness is the most without a texture.
            material.iridescence *= texels[TEXTURE_IRIDESCENCE].r;
            material.film_thickness.y = mix(material.film_thickness.x, material.film_thickness.y,
                                            texels[TEXTURE_IRIDESCENCE_THICKNESS].g);
        }
        if (HAS_SHEEN) {
            material.sheen_color *= texels[TEXTURE_SHEEN_COLOR].rgb;
            material.sheen_roughness *= texels[TEXTURE_SHEEN_ROUGHNESS].a;
        }
        if (HAS_NORMAL_MAPS) {
            if (HAS_CLEARCOAT) {
                surface.clearcoat_normal =
                    bent_clearcoat(hit, direction, surface, material, texels[TEXTURE_CLEARCOAT_NORMAL].xyz);
            }
            float side = surface.front ? 1.0 : -1.0;
            surface.normal = side * bent_normal(hit, side * surface.normal, material.texture[TEXTURE_NORMAL],
                                                material.normal_scale, texels[TEXTURE_NORMAL].xyz);
            if (dot(surface.normal, direction) >= 0.0) surface.normal = surface.geometric;
        }
    }
    if (HAS_ANISOTROPY && material.anisotropy.z > 0.0) {
        set_tangent(hit, texels[TEXTURE_ANISOTROPY].xyz, surface, material);
    }
    return material;
}

// How much of the surface is there, in [0, 1].
float coverage_of(SurfaceMaterial material) {
    if (has(material, SURFACE_MASK)) return material.opacity >= material.alpha_cutoff ? 1.0 : 0.0;
    return has(material, SURFACE_BLEND) ? material.opacity : 1.0;
}

// What gets out through the clearcoat over an emitter to a ray that meets it (KHR_materials_clearcoat, Emission).
float share_below_clearcoat(SurfaceMaterial material, Surface surface, vec3 direction) {
    return 1.0 - clearcoat_reflectance(material.clearcoat, min(1.0, -dot(direction, surface.clearcoat_normal)));
}

// What an emitter sends along a ray that has met it.
vec3 met_radiance(SurfaceMaterial material, Surface surface, vec3 direction) {
    return material.emission * share_below_clearcoat(material, surface, direction);
}

#endif
