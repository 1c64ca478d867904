// What a path carries from bounce to bounce besides its ray and its throughput: its flags, one word (PATH_*), which say
// how it came here, whether it has a wavelength, and the medium, the solid that it is in (include/media.glsl).
#ifndef PATH_GLSL
#define PATH_GLSL

#include "include/kernel.glsl"
#include "include/bsdf.glsl"
#include "include/media.glsl"
#include "include/scene.glsl"
#include "include/surface.glsl"
#include "include/wavelength.glsl"

// What a path from the eye begins with.
uint flags_at_eye() { return PATH_STRAIGHT | (HAS_NESTED ? params.eye_medium << PATH_MEDIUM_SHIFT : PATH_OUTSIDE); }
uvec2 media_at_eye() { return HAS_NESTED ? params.eye_media : NO_MEDIA; }

// What the solid that the path has come through lets pass over `distance`.
vec3 transmittance(uint flags, uvec2 media, Surface surface, float distance) {
    uint medium = medium_before(flags, media, surface);
    return medium == PATH_NO_MEDIUM ? vec3(1.0) : exp(-distance * absorption_of(medium));
}

// A lobe was followed: the flags and media of the path beyond, where it has gone through the boundary of a solid.
void pass_boundary(inout uint flags, inout uvec2 media, Bsdf bsdf, uint lobe, Surface surface) {
    if ((HAS_VOLUME || HAS_NESTED) && lobe == LOBE_TRANSMISSION && !bsdf.thin) cross_boundary(flags, media, surface);
}

// True of the back of an opaque surface that is not double-sided (glTF 2.0, 3.9.6) on a path from the camera that has
// not been sent elsewhere yet: it goes on as if nothing was there. To all other light the back is there, or walls that
// face a room would let in the sun.
bool is_culled(uint flags, Surface surface, SurfaceMaterial material) {
    return has(material, SURFACE_CULLED) && !surface.front && (flags & PATH_BOUNCES) == 0u;
}

// True where the lobe goes straight on, through a pane or a boundary that bends nothing. That is no bounce: what a path
// is through counts for as little as what is not there.
bool goes_straight(Bsdf bsdf, uint lobe) {
    return HAS_TRANSMISSION && lobe == LOBE_TRANSMISSION && (is_pane(bsdf) || (!bsdf.thin && bsdf.eta == 1.0));
}

// True where the lobe goes straight on through a pane: the path has met nothing, for rays to lights pass it too.
bool passes_pane(Bsdf bsdf, uint lobe) { return !HAS_SPLIT && lobe == LOBE_TRANSMISSION && is_pane(bsdf); }

// The flags of an eye path after a lobe of that density (DELTA or not) was followed.
uint leave_lobe(uint flags, float density) {
    if (density != DELTA) return flags & ~(PATH_STRAIGHT | PATH_CAUSTIC);
    return (flags & PATH_STRAIGHT) != 0u ? flags : flags | PATH_CAUSTIC;
}

// The index of refraction that the path meets. At its first dispersive surface it is given its wavelength.
float index_for_path(SurfaceMaterial material, uint stream, uint path, inout uint flags, inout vec3 throughput) {
    if (!HAS_DISPERSION || material.cauchy == 0.0) return material.ior;
    float wavelength = wavelength_of(stream, path);
    if ((flags & PATH_DISPERSED) == 0u) throughput *= wavelength_weight(wavelength);
    flags |= PATH_DISPERSED;
    return index_at(material.ior, material.cauchy, wavelength);
}

// How the surface scatters the path that meets it. The boundary of a solid refracts by the index to what lies about it,
// the air or another solid; within a solid of higher priority it is not seen.
Bsdf bsdf_for_path(SurfaceMaterial material, Surface surface, uint stream, uint path, inout uint flags, uvec2 media,
                   inout vec3 throughput) {
    float about = 1.0;
    bool seen = true;
    if (HAS_NESTED && is_solid(material)) {
        uint medium = medium_about(flags, media, surface);
        if (medium != PATH_NO_MEDIUM) {
            SurfaceMaterial other = materials_at(medium);
            seen = other.priority < material.priority;
            if (seen) about = index_for_path(other, stream, path, flags, throughput);
        }
    }
    float ior = 1.0;
    if (seen) ior = index_for_path(material, stream, path, flags, throughput);
    Bsdf b = bsdf_of(material, HAS_NESTED ? ior / about : ior, surface.front);
    if (HAS_NESTED && !seen) b = clear_boundary();
    return b;
}

#endif
