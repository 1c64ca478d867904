// A resumable walk over the photons of the cells that a ball touches, segment of a row by segment. Reads the grid, the
// cell starts and the sorted photons.
#ifndef SEARCH_GLSL
#define SEARCH_GLSL

#include "include/kernel.glsl"
#include "include/frame.glsl"
#include "include/grid.glsl"

COUNTERS(TEXELS)
SORTED(RECORDS)
CURSORS(UPDATES)

// Photons arriving at surfaces that turn away from the pixel's by more than acos(0.1) light another wall.
const float NORMAL_AGREEMENT = 0.1;

struct CellBox {
    GridLevel level;
    ivec3 low;
    ivec3 high;
};

CellBox cell_box(GridLevel level, vec3 centre, float radius) {
    float reach = radius * 1.0001;  // beyond the rounding of the distance test
    return CellBox(level, clamp_cell(level, cell_of(level, centre - reach)),
                   clamp_cell(level, cell_of(level, centre + reach)));
}

// A walk goes through the box segment by segment: z, then y, then runs along x, each a range of sorted photons.
struct Walk {
    ivec3 cell;   // first cell of the segment
    int last_x;   // its last cell
    uint first;   // photons [first, last) of the segment
    uint last;
};

// The segment that starts at `cell`: the whole row where rows are dense, else what lies in one run of the hash.
Walk walk_segment(CellBox box, ivec3 cell) {
    Walk walk;
    walk.cell = cell;
    walk.last_x = box.level.dims.w == 0u ? box.high.x : min(box.high.x, cell.x | (HASH_RUN - 1));
    int start = int(cell_index(box.level, cell));
    walk.first = texelFetch(counters_texels, start).x;
    walk.last = texelFetch(counters_texels, start + walk.last_x - cell.x + 1).x;
    return walk;
}

// A bucket of the hash holds photons of other cells too: only those of this segment count here.
bool in_segment(GridLevel level, Walk walk, vec3 position) {
    ivec3 cell = clamp_cell(level, cell_of(level, position));
    return level.dims.w == 0u || (cell.yz == walk.cell.yz && cell.x / HASH_RUN == walk.cell.x / HASH_RUN);
}

// Of a surface where a photon lies and of the pixel's, on the side they were seen from; photons on the other side count
// too where a rough surface transmits. n: of any length.
bool agrees(vec3 n, vec3 normal, bool both_sides) {
    float d = dot(n, normal);
    if (HAS_ROUGH && HAS_TRANSMISSION) d = both_sides ? abs(d) : d;
    return d > 0.0 && d * d >= NORMAL_AGREEMENT * NORMAL_AGREEMENT * dot(n, n);
}

// Whether a pixel accepts the photon of a segment: within reach2 of its position, on its side. squared: the distance.
bool accepts(GridLevel level, Walk walk, Photon photon, vec3 position, float reach2, vec3 normal, bool both_sides,
             out float squared) {
    vec3 offset = photon.position - position;
    squared = dot(offset, offset);
    return squared < reach2 && agrees(unpack_octahedron(photon.normal), normal, both_sides) &&
           in_segment(level, walk, photon.position);
}

// Loops over the segments of a box from `cursor` on while `steps` last and ROOM holds: cursor then says where to go on.
// PHOTONS goes through photons [walk.first, walk.last) of the segment at hand while it has steps, one a photon; a
// segment costs one more. Loops instead of branches: software Vulkan runs every branch of a loop body for every lane,
// so rows are kept out of the inner one. A macro, because PHOTONS is a loop of the kernel's own and GLSL has no
// lambdas. It takes the names cell and begin, and PHOTONS sees them.
#define FOR_SEGMENTS(box, cursor, walk, steps, ROOM, PHOTONS)                                         \
    for (ivec3 cell = cursor_cell(cursor, box); cell.z <= box.high.z && steps > 0 && (ROOM);) {       \
        walk = walk_segment(box, cell);                                                               \
        uint begin = walk.first;                                                                      \
        walk.first += cursor.photon;                                                                  \
        PHOTONS                                                                                       \
        cursor = Cursor(uvec3(cell), walk.first - begin);                                             \
        if (walk.first >= walk.last) {                                                                \
            cell.x = walk.last_x + 1;                                                                 \
            if (cell.x > box.high.x) cell = ivec3(box.low.x, cell.y + 1, cell.z);                     \
            if (cell.y > box.high.y) cell = ivec3(box.low.x, box.low.y, cell.z + 1);                  \
            cursor = Cursor(uvec3(cell), 0u);                                                         \
        }                                                                                             \
        --steps;                                                                                      \
    }

ivec3 cursor_cell(Cursor cursor, CellBox box) { return cursor.cell.x == CURSOR_START ? box.low : ivec3(cursor.cell); }

bool walked(Cursor cursor, CellBox box) { return int(cursor.cell.z) > box.high.z; }

#endif
