// Who brings direct light: light that has met nothing since it left its source, or panes alone, thin smooth glass,
// which lets it go straight on. Where it is asked for (FEATURE_DIRECT) eye paths bring it at every surface with a lobe
// of width above 0: they ask for a point of the lights (next-event estimation), and what a rough lobe meets that was
// followed is weighed against that by the balance heuristic (multiple importance sampling; Veach and Guibas 1995).
// Photons bring all other light, and that of emitting surfaces which are so close that a sample would seldom find the
// place and then weigh much: where the density of asking, if their lamp was the only one, is below LEAST_DENSITY. That
// is a rule on the two points alone, so that each light is brought once. How often the lamp is asked for is no part of
// it: among others that bring as much a sample of it weighs no more than theirs (tests/bench/results/transport.md).
// Elsewhere (FEATURE_DIRECT is not set) photons bring direct light too. Pure functions.
#ifndef DIRECT_GLSL
#define DIRECT_GLSL

#include "include/kernel.glsl"

const float LEAST_DENSITY = 0.1;  // 1/sr

// True where eye paths bring the direct light of an emitting surface that is asked for with this density where its lamp
// is, 1/sr.
bool asks_emitter(float of_lamp) { return of_lamp >= LEAST_DENSITY; }

// The distance from an emitter within which photons bring its direct light. density: of asking for the point where its
// lamp is, per area; cosine: to the emitter's normal. The density per solid angle is that per area times
// distance^2 / cosine.
float near_emitter(float density, float cosine) { return sqrt(LEAST_DENSITY * cosine / density); }

#endif
