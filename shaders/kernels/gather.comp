#version 460
// One invocation a pixel: sums the photons in its disc with the radius in force before this iteration's photons were
// looked at, and bins them for the estimator. Reads hits, pixels, grid, sorted photons; writes gathered, tally,
// cursors. O(photons in the cells that the disc touches). Fails by running out of steps: goes on next round.
// In glossy scenes every photon is weighed by the BSDF for its direction, made from the surface of the hit again.
// Acceptance: |y - x| < R strictly (appm looks further for its derivative), and the photon's geometric normal agrees
// with the pixel's shading normal, both on the side they were seen from; the distance is that in space, the kernel is
// 1 / (pi R^2), but for appm's.
#include "include/kernel.glsl"
#include "include/bsdf.glsl"
#include "include/frame.glsl"
#include "include/hits.glsl"
#include "include/path.glsl"
#include "include/pixels.glsl"
#include "include/rng.glsl"
#include "include/sampling.glsl"
#include "include/search.glsl"
#include "include/sum.glsl"
#include "include/surface.glsl"
#include "estimators/estimator.glsl"

SORTED_FLUX(RECORDS)

// The surface that the eye path ended on, as it met it.
void glossy_hit(uint pixel, out Surface surface, out Bsdf bsdf, out vec3 outgoing) {
    HitSurface record = hit_surface_at(pixel);
    outgoing = unpack_direction(record.outgoing);
    Hit hit = Hit(0.0, record.triangle, record.barycentric);
    surface = surface_at(hit, -outgoing);
    SurfaceMaterial material = material_at(hit, -outgoing, surface);
    uint memory = PATH_OUTSIDE;
    vec3 weight = vec3(1.0);
    bsdf = bsdf_of(material, index_for_path(material, STREAM_EYE, pixel, memory, weight), surface.front);
}

// Runs of at most 32 photons that wait to be weighed, those accepted marked in a word. The test of the distance takes
// all lanes through all photons of the cells, of which it accepts a third; weighing them apart takes each lane through
// its own alone. That is most of the work where photons are weighed by a BSDF.
#define QUEUE 16u

void main() {
    uint pixel = invocation_pixel();
    if (pixel >= pixel_count() || blocked(PASS_GATHER)) return;
    Cursor cursor = Cursor(uvec3(CURSOR_START), 0u);
    Gathered sum = Gathered(vec3(0.0), 0u, vec3(0.0), 0u);
    HitPosition hit = hit_position_at(pixel);
    if (!gathers(hit)) {
        gathered[pixel] = sum;
        return;
    }
    if (launch.round > 0u) {
        cursor = cursors[pixel];
        if (cursor.cell.x == CURSOR_DONE) return;
        sum = gathered_at(pixel);
    }

    vec3 position = hit.position;
    vec3 normal = unpack_direction(hit_weight_at(pixel).normal);
    bool both_sides = (hit.state & HIT_MASK) == HIT_BOTH_SIDES;
    float radius2 = pixels_at(pixel).radius2;
    float inverse_radius = inversesqrt(radius2);
    vec3 tangent, bitangent;
    tangents(normal, tangent, bitangent);
    tangent *= inverse_radius;
    bitangent *= inverse_radius;

    Surface surface;
    Bsdf bsdf;
    vec3 outgoing;
    if (HAS_GLOSS) glossy_hit(pixel, surface, bsdf, outgoing);

    begin(pixel);
    int steps = int(params.step_budget);
    float reach2 = search_radius2(pixel, radius2);
    CellBox box = cell_box(level_for(sqrt(reach2)), position, sqrt(reach2));
    Walk walk;
    uvec2 queue[QUEUE + 1u];  // first photon, marks; one more, for a store of nothing when it is full
    while (!walked(cursor, box) && steps > 0) {
        uint queued = 0u;
        FOR_SEGMENTS(box, cursor, walk, steps, queued < QUEUE, {
            uvec2 run = uvec2(walk.first, 0u);
            // Left at its end, for software Vulkan runs the body of a loop once more where it is left at its start.
            // There, lanes that have left go through the rest of the trips with what they had: the body makes the same
            // of it.
            uint bit = walk.first < walk.last ? 1u : 0u;
            do {
                Photon photon = sorted_at(bit != 0u ? walk.first : 0u);
                float squared;
                run.y |= accepts(box.level, walk, photon, position, reach2, normal, both_sides, squared) ? bit : 0u;
                walk.first += uint(bit != 0u);
                steps -= int(bit != 0u);
                bit <<= 1u;
            } while (bit != 0u && walk.first < walk.last && steps > 0);
            // A store by all lanes: a branch for each would guess wrong.
            queue[queued] = run;
            queued += uint(run.y != 0u);
        })
        uvec2 run = uvec2(0u);
        for (uint taken = 0u; run.y != 0u || taken < queued;) {
            uvec2 next = queue[taken];
            bool ended = run.y == 0u;
            run = ended ? next : run;
            taken += uint(ended);
            uint index = run.x + uint(findLSB(run.y));
            run.y &= run.y - 1u;
            Photon photon = sorted_at(index);
            PhotonFlux flux = sorted_flux_at(index);
            vec3 offset = photon.position - position;
            float squared = dot(offset, offset);
            vec3 power = abs(flux.power);
            vec3 towards = unpack_direction(flux.direction);
            if (HAS_SMOOTH) {
                // Photons arrive per area of the true surface, the BRDF is that of the shaded one.
                vec3 geometric = unpack_direction(photon.normal);
                float cos_shading = dot(towards, normal);
                power *= max(0.0, both_sides ? abs(cos_shading) : cos_shading) / max(0.01, dot(towards, geometric));
            }
            if (HAS_GLOSS) {
                uint part = (floatBitsToUint(flux.power.r) & 0x80000000u) != 0u ? PART_ALL : PART_GATHERED;
                power *= PI * rough_bsdf(bsdf, surface, outgoing, towards, part);
            }
            bool inside = squared < radius2;
            float q = squared * inverse_radius * inverse_radius;
            add_corrected(sum.flux, sum.excess,
                          inside ? power * photon_weight(q, (floatBitsToUint(flux.power.g) & 0x80000000u) != 0u) : vec3(0.0));
            sum.count += inside ? 1u : 0u;
            --steps;
            record(pixel, Accepted(vec2(dot(offset, tangent), dot(offset, bitangent)), q, power, index), inside);
        }
    }
    flush(pixel);
    gathered[pixel] = sum;
    if (walked(cursor, box)) {
        cursor.cell.x = CURSOR_DONE;
    } else {
        block_after(PASS_GATHER);
    }
    cursors[pixel] = cursor;
}
