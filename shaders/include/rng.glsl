// Counter-based random numbers: a pure function of (seed, iteration, stream, path, dimension), so that the same seed
// gives the same bits in any order of execution. PCG4D: Jarzynski and Olano, "Hash Functions for GPU Rendering",
// JCGT 9(3), 2020.
#ifndef RNG_GLSL
#define RNG_GLSL

#define STREAM_EYE 0u
#define STREAM_PHOTON 1u
#define STREAM_GATHER 2u
#define STREAM_PATH 3u
#define STREAMS 4u
// Of the shifts of stratified(): dimensions below STRATIFIED_DIMENSIONS of iteration 0, where the path tracer draws
// nothing. They have its number because the pictures of every seed hang on it.
#define STREAM_SHIFT STREAM_PATH

uvec4 pcg4d(uvec4 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v ^= v >> 16u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

// Four random words. `path` is a pixel or light path, `dimension` a bounce.
uvec4 random_words(uint seed, uint iteration, uint stream, uint path, uint dimension) {
    return pcg4d(uvec4(path, dimension, iteration * STREAMS + stream, seed));
}

#define ULP_OF_UNITS 5.9604644775390625e-8  // 2^-24
#define LARGEST_UNIT 0.99999994             // the largest float below 1

// Numbers in [0, 1), the upper 24 bits of words.
float unit_float(uint word) { return float(word >> 8u) * ULP_OF_UNITS; }
vec4 unit_floats(uvec4 words) { return vec4(words >> 8u) * ULP_OF_UNITS; }

vec4 random4(uint seed, uint iteration, uint stream, uint path, uint dimension) {
    return unit_floats(random_words(seed, iteration, stream, path, dimension));
}

// Where the random numbers begin of the surface that a path meets as number `met`, with `each` for one, up to 4: a path
// goes straight through any number of surfaces, and dimensions of other uses begin at 4096. After 1024 surfaces they go
// on beyond all of those, 65536.
uint dimension_of(uint met, uint each) { return each * (met & 1023u) + (met >> 10u << 16u); }

// Dimensions of an eye path that are stratified over the iterations of a pixel.
#define STRATIFIED_DIMENSIONS 8u

// Steps of additive recurrences modulo 1, times 2^32: two powers of the inverse of the plastic number for the place in
// the pixel, then the square roots of 13, 43, 59, 257, 1237 and 7649. Rationally independent, so the dimensions are
// equidistributed together (Weyl 1916); of the square roots of primes the first whose pairs are more even than random
// numbers after few iterations too.
const uint RECURRENCE[STRATIFIED_DIMENSIONS] = uint[](0xc13fa9a9u, 0x91e10da5u, 0x9b05688cu, 0x8eb44a87u, 0xae5f9156u,
                                                      0x07fe00ffu, 0x2bc75cf6u, 0x75644b49u);

// Term `i` of an additive recurrence in [0, 1), shifted at random for every pixel and dimension.
float recurrence(uint seed, uint i, uint pixel, uint dimension, uint step) {
    uint shift = pcg4d(uvec4(pixel, dimension, STREAM_SHIFT, seed)).x;
    return unit_float(shift + i * step);
}

// A number in [0, 1) for dimension `dimension` of the eye path of `pixel`: over the iterations a low-discrepancy
// sequence; independent numbers beyond the stratified dimensions.
float stratified(uint seed, uint iteration, uint pixel, uint dimension) {
    if (dimension >= STRATIFIED_DIMENSIONS) return random4(seed, iteration, STREAM_EYE, pixel, dimension).x;
    return recurrence(seed, iteration, pixel, dimension, RECURRENCE[dimension]);
}

// A hash of the bits of a number in [0, 1), of which each depends on those above it alone: Owen's scrambling (1995)
// with the hash of Laine and Karras (2011) in the form of Vegdahl (2021). Equidistribution in dyadic intervals is kept.
uint owen_scrambled(uint x, uint seed) {
    uint v = bitfieldReverse(x);
    v ^= v * 0x3d20adeau;
    v += seed;
    v *= (seed >> 16u) | 1u;
    v ^= v * 0x05526c56u;
    v ^= v * 0x53a22864u;
    return bitfieldReverse(v);
}

// Pair i of the (0,2)-sequence of Sobol' (1967), as 32-bit fractions, scrambled: of the first 2^m, and of every 2^m
// that follow, one lies in each dyadic box of area 2^-m. The second generator matrix is Pascal's triangle modulo 2,
// which is a Kronecker power and so takes five steps.
uvec2 sobol_pair(uint i, uvec2 seeds) {
    uint x = i;
    x ^= (x >> 1u) & 0x55555555u;
    x ^= (x >> 2u) & 0x33333333u;
    x ^= (x >> 4u) & 0x0f0f0f0fu;
    x ^= (x >> 8u) & 0x00ff00ffu;
    x ^= (x >> 16u) & 0x0000ffffu;
    return uvec2(owen_scrambled(bitfieldReverse(i), seeds.x), owen_scrambled(bitfieldReverse(x), seeds.y));
}

#endif
