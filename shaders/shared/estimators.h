// Ids of the estimators: the value of the specialization constant SPEC_ESTIMATOR.
#ifdef __cplusplus
#pragma once
#endif
#define ESTIMATOR_CPPM 0
#define ESTIMATOR_SPPM 1
#define ESTIMATOR_SPPM_KZ 2
