// The solids that a path is in, where solids touch, overlap or hold one another (FEATURE_NESTED): that of the highest
// priority counts, and boundaries of others within it are not seen (Schmidt and Budge, "Simple Nested Dielectrics in
// Ray Traced Images", Journal of Graphics Tools 7(2), 2002). Materials stand for solids, those of one priority for the
// same, as on a body of several; one that is entered twice is there twice. The first stands in the flags of the path,
// four more in `media`, 16 bits each, in any order. Elsewhere the flags alone say it. Reads materials.
#ifndef MEDIA_GLSL
#define MEDIA_GLSL

#include "include/kernel.glsl"
#include "include/scene.glsl"
#include "include/surface.glsl"

#define PATH_OUTSIDE (PATH_NO_MEDIUM << PATH_MEDIUM_SHIFT)
#define NO_MEDIA uvec2(0xffffffffu)
#define MEDIA_SLOTS 4u  // of `media`

bool is_solid(SurfaceMaterial material) { return material.transmission > 0.0 && !has(material, SURFACE_THIN); }

uint medium_of(uint flags) { return flags >> PATH_MEDIUM_SHIFT; }

uint with_medium(uint flags, uint medium) {
    return (flags & ((1u << PATH_MEDIUM_SHIFT) - 1u)) | medium << PATH_MEDIUM_SHIFT;
}

uint medium_in(uvec2 media, uint slot) { return media[slot >> 1u] >> 16u * (slot & 1u) & 0xffffu; }

void put_medium(inout uvec2 media, uint slot, uint medium) {
    uint shift = 16u * (slot & 1u);
    uint word = slot >> 1u;
    media[word] = (media[word] & ~(0xffffu << shift)) | medium << shift;
}

// That of a material; of none: 0, below all.
uint priority_of(uint medium) { return medium == PATH_NO_MEDIUM ? 0u : materials_at(medium).priority; }

// The slot that holds a solid of the priority, or of 0 nothing; MEDIA_SLOTS: none does.
uint slot_of(uvec2 media, uint priority) {
    uint found = MEDIA_SLOTS;
    for (uint i = 0u; i < MEDIA_SLOTS; ++i) found = priority_of(medium_in(media, i)) == priority ? i : found;
    return found;
}

// The path goes into the solid. Of more than five the last one is forgotten.
void enter_medium(inout uint flags, inout uvec2 media, uint medium) {
    uint first = medium_of(flags);
    bool counts = priority_of(medium) >= priority_of(first);
    uint slot = slot_of(media, 0u);
    if (first != PATH_NO_MEDIUM && slot != MEDIA_SLOTS) put_medium(media, slot, counts ? first : medium);
    if (counts) flags = with_medium(flags, medium);
}

// It goes out of the solid, if it was known to be in it.
void leave_medium(inout uint flags, inout uvec2 media, uint medium) {
    uint own = priority_of(medium);
    uint slot = slot_of(media, own);
    if (own == priority_of(medium_of(flags))) {
        uint most = 0u;
        slot = MEDIA_SLOTS;
        for (uint i = 0u; i < MEDIA_SLOTS; ++i) {
            uint priority = priority_of(medium_in(media, i));
            slot = priority > most ? i : slot;
            most = max(most, priority);
        }
        flags = with_medium(flags, slot == MEDIA_SLOTS ? PATH_NO_MEDIUM : medium_in(media, slot));
    }
    if (slot != MEDIA_SLOTS) put_medium(media, slot, PATH_NO_MEDIUM);
}

// What lies about the solid whose boundary the path has met: of the others that it is in the one that counts.
uint medium_about(uint flags, uvec2 media, Surface surface) {
    if (!surface.front) leave_medium(flags, media, surface.material);
    return medium_of(flags);
}

// The flags after a path has gone through the boundary of a solid: it is inside, or outside.
void cross_boundary(inout uint flags, inout uvec2 media, Surface surface) {
    if (!HAS_NESTED) {
        flags = with_medium(flags, surface.front ? surface.material : PATH_NO_MEDIUM);
    } else if (surface.front) {
        enter_medium(flags, media, surface.material);
    } else {
        leave_medium(flags, media, surface.material);
    }
}

// The solid through which a path has come to a surface. A boundary that is met from inside names its own: the eye or a
// light may stand in one, and without priorities the flags are of the inner one after nested solids.
uint medium_before(uint flags, uvec2 media, Surface surface) {
    uint medium = medium_of(flags);
    if (!surface.front) {
        SurfaceMaterial own = materials_at(surface.material);
        bool named = is_solid(own);
        if (HAS_NESTED) {
            bool unknown = slot_of(media, own.priority) == MEDIA_SLOTS;
            named = named && unknown && own.priority > priority_of(medium);
        }
        medium = named ? surface.material : medium;
    }
    return medium;
}

#endif
