// Dispersion: a path that meets a dispersive surface has one wavelength from then on. Pure functions.
#ifndef WAVELENGTH_GLSL
#define WAVELENGTH_GLSL

#include "include/kernel.glsl"
#include "include/rng.glsl"

#define WAVELENGTH_DIMENSION 0xffffu  // beyond every bounce
// The step of its recurrence, that of the square root of 7: beside those of RECURRENCE its pairs are as even as theirs.
#define WAVELENGTH_STEP 0xa54ff53au

// Uniform in 0.4 to 0.7 micrometres; the same for every bounce of a path. Over the paths of a pixel the spectrum is
// covered evenly: as one wavelength shows but one colour, that is most of the noise of what light splits in.
float wavelength_of(uint stream, uint path) {
    float u = random4(params.seed, launch.iteration, stream, path, WAVELENGTH_DIMENSION).x;
    if (stream == STREAM_EYE) {
        u = recurrence(params.seed, launch.iteration, path, WAVELENGTH_DIMENSION, WAVELENGTH_STEP);
    } else if (stream == STREAM_PATH) {
        uint pixels = params.width * params.height;
        uint number = launch.iteration * launch.paths + path / pixels;
        u = recurrence(params.seed, number, path % pixels, WAVELENGTH_DIMENSION, WAVELENGTH_STEP);
    }
    return 0.4 + 0.3 * u;
}

// How much light of a wavelength there is in each channel: triangles about 0.65, 0.55 and 0.45 micrometres that reach
// to their neighbours, cut at the ends of the spectrum and of mean 1 over it, so that white stays white.
vec3 wavelength_weight(float wavelength) {
    vec3 hat = max(vec3(0.0), 1.0 - abs(wavelength - vec3(0.65, 0.55, 0.45)) * 10.0);
    // Integrals over the spectrum: 0.1 for the whole triangle, 0.1 - 0.5 * 0.05 * 0.5 for those that are cut.
    return hat * (0.3 / vec3(0.0875, 0.1, 0.0875));
}

// Cauchy's n(l) = A + B / l^2 through the index at the helium d line.
float index_at(float ior, float cauchy, float wavelength) {
    return ior + cauchy * (1.0 / (wavelength * wavelength) - 1.0 / (0.5876 * 0.5876));
}

#endif
