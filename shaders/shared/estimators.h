// Ids of the estimators: the value of the specialization constant SPEC_ESTIMATOR.
#ifdef __cplusplus
#pragma once
#endif
#define ESTIMATOR_CPPM 0
#define ESTIMATOR_SPPM 1
#define ESTIMATOR_SPPM_KZ 2
#define ESTIMATOR_CPPM_LF 3
#define ESTIMATOR_CPPM_GOF 4
#define ESTIMATOR_CPPM_FOLD 5
#define ESTIMATOR_CPPM_NULL 6
#define ESTIMATOR_APPM 7
#define ESTIMATOR_FTEST 8
#define ESTIMATOR_FTEST_FOLD 9

// Moments that appm keeps of a pixel, rows of the moment buffer.
#define APPM_SECOND_MOMENT_NOW 0   // this iteration's (1/J) sum Y^2 K_r
#define APPM_LAPLACIAN_NOW 1       // this iteration's (1/J) sum Y D_rd
#define APPM_SECOND_MOMENT 2       // mean over iterations: V
#define APPM_LAPLACIAN 3           // mean over iterations: Delta
#define APPM_FIRST_RADIUS2 4       // r_1^2
#define APPM_SECOND_MOMENT_LOW 5   // low parts of the means
#define APPM_LAPLACIAN_LOW 6
#define APPM_MOMENTS 7

// Quantiles of the F distribution: samples of a row, uniform in 1 / (m - 1) over [0, 1/2].
#define F_QUANTILES 129
