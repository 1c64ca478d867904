// What a path carries from bounce to bounce besides its ray and its throughput: its flags, one word (PATH_*), which say
// how it came here, whether it has a wavelength, and the medium, the solid that it is in.
#ifndef PATH_GLSL
#define PATH_GLSL

#include "include/kernel.glsl"
#include "include/bsdf.glsl"
#include "include/scene.glsl"
#include "include/surface.glsl"
#include "include/wavelength.glsl"

#define PATH_OUTSIDE (PATH_NO_MEDIUM << PATH_MEDIUM_SHIFT)

// What the solid that the path is in lets through over `distance`. A boundary that is met from inside names its own
// solid: the eye may stand in one, and after nested solids the flags are of the inner one.
vec3 transmittance(uint flags, Surface surface, float distance) {
    uint medium = flags >> PATH_MEDIUM_SHIFT;
    if (!surface.front) {
        SurfaceMaterial material = materials_at(surface.material);
        if (material.transmission > 0.0 && !has(material, SURFACE_THIN)) medium = surface.material;
    }
    return medium == PATH_NO_MEDIUM ? vec3(1.0) : exp(-distance * absorption_of(medium));
}

// The flags after a lobe was followed: through the boundary of a solid lies its inside, or the outside.
uint pass_boundary(uint flags, Bsdf bsdf, uint lobe, Surface surface) {
    if (!HAS_VOLUME || lobe != LOBE_TRANSMISSION || bsdf.thin) return flags;
    uint medium = surface.front ? surface.material : PATH_NO_MEDIUM;
    return (flags & ((1u << PATH_MEDIUM_SHIFT) - 1u)) | medium << PATH_MEDIUM_SHIFT;
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

#endif
