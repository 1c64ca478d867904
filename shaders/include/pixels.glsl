// What a pixel remembers between iterations: its radius and the statistics of its estimator.
layout(binding = BIND_PIXELS, scalar) buffer PixelBlock { PixelState pixels[]; };
layout(binding = BIND_TALLY, scalar) buffer TallyBlock { uint tally[]; };        // [bin x P] photons
layout(binding = BIND_MOMENTS, scalar) buffer MomentBlock { float moments[]; };  // [row x P]

// A radius is never smaller than the rounding error of a position in the scene frame.
const float RADIUS2_MIN = 1e-12;

// Photons with which a batch is full however large it is, and a tally starts again: what is added to it in an iteration
// leaves it below 2^32.
const float MOST_PHOTONS = 2147483648.0;

bool batch_is_full(PixelState state) { return float(state.total) >= min(state.batch, MOST_PHOTONS); }

// Row `row` of a pixel, of the tally or of the moments: neighbours in a row stand together in memory.
uint row_of(uint row, uint pixel) { return row * pixel_count() + pixel; }
