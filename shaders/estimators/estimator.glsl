// The family's one switch. An estimator has these hooks:
//   record(pixel, photon, inside): a photon was accepted; `inside`: within R, else within search_radius2 only. It
//   adds to registers of the invocation; begin(pixel) and flush(pixel) stand before and after the walk, in every round;
//   update(pixel, diffuse, found, state): after an iteration in which `found` photons were accepted within R
//   (`diffuse`: the pixel saw a surface to gather on); decides state.radius2 for the next one;
//   clear_statistics(pixel): forgets what was recorded, when a radius begins;
// and appm alone: kernel_weight (pi R^2 times its kernel), which references have one of too, and search_radius2.
// All share the accumulator acc += Phi / (pi R^2) of the update kernel; only the rule of the radius differs.

struct Accepted {
    vec2 v;        // offset in the unit disc
    float q;       // |offset|^2 / R^2
    vec3 power;    // W (frame-scaled), with the correction for shading normals
    uint index;    // into the sorted photons
};

#include "estimators/sectors.glsl"
#include "estimators/sppm.glsl"
#include "estimators/sppm_kz.glsl"
#include "estimators/cppm.glsl"
#include "estimators/cppm_lf.glsl"
#include "estimators/cppm_gof.glsl"
#include "estimators/cppm_fold.glsl"
#include "estimators/cppm_null.glsl"
#include "estimators/appm.glsl"
#include "estimators/ftest.glsl"
#include "estimators/algorithm1.glsl"

void begin(uint pixel) {
    switch (ESTIMATOR) {
        case ESTIMATOR_APPM: appm_begin(pixel); break;
        case ESTIMATOR_FTEST:
        case ESTIMATOR_FTEST_FOLD: ftest_begin(pixel); break;
        default: tally_begin(); break;
    }
}

void record(uint pixel, Accepted photon, bool inside) {
    switch (ESTIMATOR) {
        case ESTIMATOR_CPPM:
        case ESTIMATOR_CPPM_LF: cppm_record(photon); break;
        case ESTIMATOR_CPPM_GOF: cppm_gof_record(pixel, photon); break;
        case ESTIMATOR_CPPM_FOLD: cppm_fold_record(photon); break;
        case ESTIMATOR_APPM: appm_record(photon, inside); break;
        case ESTIMATOR_FTEST:
        case ESTIMATOR_FTEST_FOLD: ftest_record(photon); break;
        default: break;
    }
}

void update(uint pixel, bool diffuse, uint found, inout PixelState state) {
    switch (ESTIMATOR) {
        case ESTIMATOR_SPPM: sppm_update(found, state); break;
        case ESTIMATOR_SPPM_KZ: sppm_kz_update(state); break;
        case ESTIMATOR_CPPM_NULL: cppm_null_update(found, state); break;
        case ESTIMATOR_APPM: appm_update(pixel, diffuse, found, state); break;
        case ESTIMATOR_FTEST:
        case ESTIMATOR_FTEST_FOLD: ftest_sample(pixel, diffuse, state); algorithm1_update(pixel, found, state); break;
        default: algorithm1_update(pixel, found, state); break;
    }
}

void flush(uint pixel) {
    switch (ESTIMATOR) {
        case ESTIMATOR_APPM: appm_flush(pixel); break;
        case ESTIMATOR_FTEST:
        case ESTIMATOR_FTEST_FOLD: ftest_flush(pixel); break;
        case ESTIMATOR_CPPM:
        case ESTIMATOR_CPPM_LF:
        case ESTIMATOR_CPPM_GOF:
        case ESTIMATOR_CPPM_FOLD: tally_flush(pixel); break;
        default: break;
    }
}

const float FIRST_NARROWER = 4.0;  // than the discs of other photons are those of photons at their first rough surface

// first: the photon has met its first surface that is not smooth; what comes after that is less sharp by far.
float kernel_weight(float q, bool first) {
    if ((FEATURES & FEATURE_SPLIT) != 0u) {
        // Twice the estimate of a disc of half the area less that of the whole: the bias in R^2 cancels (Richardson
        // 1911).
        float scale = first ? FIRST_NARROWER * FIRST_NARROWER : 1.0;
        return q * scale < 0.5 ? 3.0 * scale : q * scale < 1.0 ? -scale : 0.0;
    }
    return ESTIMATOR == ESTIMATOR_APPM ? appm_kernel_weight(q) : 1.0;
}

float search_radius2(uint pixel, float radius2) {
    return ESTIMATOR == ESTIMATOR_APPM ? appm_search_radius2(pixel, radius2) : radius2;
}
