// What a pixel remembers between iterations: its radius and the statistics of its estimator.
PIXELS(STORES)
TALLY(STORES)
PIXELS(RECORDS)
TALLY(TEXELS)
MOMENTS(TEXELS)
MOMENTS(STORES)

// A radius is never smaller than the rounding error of a position in the scene frame.
const float RADIUS2_MIN = 1e-12;

// Photons with which a batch is full however large it is, and a tally starts again: what is added to it in an iteration
// leaves it below 2^31.
const float MOST_PHOTONS = 1073741824.0;

bool batch_is_full(PixelState state) { return float(state.total) >= min(state.batch, MOST_PHOTONS); }

// Row `row` of a pixel, of the tally or of the moments: neighbours in a row stand together in memory.
uint row_of(uint row, uint pixel) { return row * pixel_count() + pixel; }

uint tally_at(uint bin, uint pixel) { return texelFetch(tally_texels, int(row_of(bin, pixel))).x; }

float moment_at(uint row, uint pixel) { return uintBitsToFloat(texelFetch(moments_texels, int(row_of(row, pixel))).x); }
