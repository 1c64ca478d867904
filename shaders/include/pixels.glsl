// What a pixel remembers between iterations: its radius and, for estimators with sectors, its tally.
layout(binding = BIND_PIXELS, scalar) buffer PixelBlock { PixelState pixels[]; };
layout(binding = BIND_TALLY, scalar) buffer TallyBlock { uint tally[]; };  // [bin x P]

// A radius is never smaller than the rounding error of a position in the scene frame.
const float RADIUS2_MIN = 1e-12;

uint tally_index(uint bin, uint pixel) { return bin * pixel_count() + pixel; }

void clear_tally(uint pixel) {
    for (uint bin = 0u; bin < RINGS * SECTORS; ++bin) tally[tally_index(bin, pixel)] = 0u;
}
