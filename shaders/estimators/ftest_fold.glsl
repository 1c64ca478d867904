// The F-test on folded sectors: contributions of opposite sectors are added first, as cppm-fold counts photons.
#include "estimators/ftest.glsl"
