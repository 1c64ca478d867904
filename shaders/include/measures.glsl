// How far the area of a pixel's disc is measured (kernels/area.comp). It is kept in the record of the pixel's search,
// which is over by then.
#ifndef MEASURES_GLSL
#define MEASURES_GLSL

#include "include/kernel.glsl"

SEARCH_STATES(UPDATES)

struct Measure {
    float excess;  // the sum so far, without its first term
    float term;    // the latest of it
    uint lines;    // that were followed, or as many as there can be where it is done
};

Measure load_measure(uint pixel) {
    SearchState state = search_states[pixel];
    return Measure(state.largest, state.radius, state.kept);
}

void store_measure(uint pixel, Measure m) { search_states[pixel] = SearchState(m.excess, 0u, m.term, m.lines); }

#endif
