// CPPM with folded sectors: the hypothesis of cppm-gof, p(x) + p(-x) constant, tested without random numbers. Opposite
// sectors are one cell (as its row says); half as many cells hold twice as many photons each, and no power is lost to
// the flips.
#include "estimators/cppm.glsl"
