// What a pixel remembers between iterations: its radius and the statistics of its estimator.
layout(binding = BIND_PIXELS, scalar) writeonly buffer PixelBlock { PixelState pixels[]; };
layout(binding = BIND_TALLY, scalar) writeonly buffer TallyBlock { uint tally[]; };  // [bin x P] photons
layout(binding = BIND_PIXEL_TEXELS) uniform usamplerBuffer pixel_states;
layout(binding = BIND_TALLY_TEXELS) uniform usamplerBuffer tallies;
layout(binding = BIND_MOMENT_TEXELS) uniform usamplerBuffer moment_words;
layout(binding = BIND_MOMENTS, scalar) writeonly buffer MomentBlock { float moments[]; };  // [row x P]

// A radius is never smaller than the rounding error of a position in the scene frame.
const float RADIUS2_MIN = 1e-12;

// Photons with which a batch is full however large it is, and a tally starts again: what is added to it in an iteration
// leaves it below 2^31.
const float MOST_PHOTONS = 1073741824.0;

bool batch_is_full(PixelState state) { return float(state.total) >= min(state.batch, MOST_PHOTONS); }

PixelState pixel_at(uint pixel) {
    uvec4 a = texelFetch(pixel_states, int(pixel) * 3);
    uvec4 b = texelFetch(pixel_states, int(pixel) * 3 + 1);
    uvec4 c = texelFetch(pixel_states, int(pixel) * 3 + 2);
    return PixelState(uintBitsToFloat(a.x), a.y, uintBitsToFloat(a.z), a.w, uintBitsToFloat(b.x), b.y, b.z, b.w,
                      uintBitsToFloat(c.x), uintBitsToFloat(c.y), uintBitsToFloat(c.z), 0u);
}

// Row `row` of a pixel, of the tally or of the moments: neighbours in a row stand together in memory.
uint row_of(uint row, uint pixel) { return row * pixel_count() + pixel; }

uint tally_at(uint bin, uint pixel) { return texelFetch(tallies, int(row_of(bin, pixel))).x; }

float moment_at(uint row, uint pixel) { return uintBitsToFloat(texelFetch(moment_words, int(row_of(row, pixel))).x); }
