// The family of estimators, a row each: names, help, thresholds and buffers of the host follow from the rows, and so do
// the modules that CMake compiles: every kernel of modules `each` (shared/kernels.h) once an estimator, with the hooks
// of shaders/estimators/NAME.glsl (`_` for `-`). Their contract: estimators/estimator.glsl. CMake reads the
// rows, too: one a line, indented by four.
//
// ROW(name, statistic, folded, fitted, later, summary)
//   name       as --estimator takes it; the first is the default
//   statistic  of STATISTICS: what it keeps of a pixel
//   folded     true: opposite sectors of the disc are one cell
//   fitted     parameters of the density that are fitted before a chi-squared test
//   later      of LATER: how radii go on after a pilot, where iterations are shared out (host/render/schedule.h)
//   summary    one line for --help and the README
#ifdef __cplusplus
#pragma once
// clang-format off
#define ESTIMATORS(ROW)                                                                                                \
    ROW("cppm", tally, false, 0, third, "chi-squared test of a uniform density (Lin et al. 2020)")                     \
    ROW("sppm", none, false, 0, alpha, "shared statistics (Hachisuka and Jensen 2009)")                                \
    ROW("sppm-kz", none, false, 0, alpha, "one schedule for all pixels (Knaus and Zwicker 2011)")                      \
    ROW("appm", derivative, false, 0, third, "balance of variance and bias (Kaplanyan and Dachsbacher 2013)")          \
    ROW("cppm-lf", tally, false, 2, third, "chi-squared test of a linear density (Lin et al. 2020, supplementary)")    \
    ROW("cppm-gof", tally, false, 0, third, "chi-squared test of a generalised odd density (the same)")                \
    ROW("cppm-fold", tally, true, 0, third, "the hypothesis of cppm-gof by folding, without random flips")             \
    ROW("cppm-null", none, false, 0, batches, "shrinks with every batch, without a test: the ablation")                \
    ROW("ftest", contribution, false, 0, third, "analysis of variance of contributions (after Lin et al. 2025)")       \
    ROW("ftest-fold", contribution, true, 0, third, "the same on folded sectors")
// clang-format on
#endif

// What an estimator keeps of a pixel besides PixelState: rows of the buffers tally (counters) and moments (floats),
// each of one word a pixel, on a disc of `cells` cells in `rings` rings. Kernels declare the buffers by it.
//   none          a schedule: no test
//   tally         photons a cell; chi-squared with cells - 1 - fitted degrees of freedom
//   derivative    APPM_MOMENTS, below
//   contribution  sums, means and squares of contributions a cell; F(cells - 1, cells (m - 1)) after m samples
#define STATISTICS(ROW) ROW(none) ROW(tally) ROW(derivative) ROW(contribution)
#define KEEPS_none(IN_TALLY, IN_MOMENTS, cells, rings)
#define KEEPS_tally(IN_TALLY, IN_MOMENTS, cells, rings) IN_TALLY(cells)
#define KEEPS_derivative(IN_TALLY, IN_MOMENTS, cells, rings) IN_MOMENTS(APPM_MOMENTS)
#define KEEPS_contribution(IN_TALLY, IN_MOMENTS, cells, rings) IN_MOMENTS(3u * (cells) + 2u * (rings))

// Exponents e of R^2 ~ i^-e over the iterations.
//   alpha    1 - alpha, the law of sppm and sppm-kz
//   batches  that of discs which shrink with every batch, by k and beta
//   third    1/3: of appm the law, of those that test their discs the mean of what they do
#define LATER(ROW) ROW(alpha) ROW(batches) ROW(third)

// Rows of the moments that appm keeps.
#define APPM_SECOND_MOMENT_NOW 0u  // this iteration's (1/J) sum Y^2 K_r
#define APPM_LAPLACIAN_NOW 1u      // this iteration's (1/J) sum Y D_rd
#define APPM_SECOND_MOMENT 2u      // mean over iterations: V
#define APPM_LAPLACIAN 3u          // mean over iterations: Delta
#define APPM_FIRST_RADIUS2 4u      // r_1^2
#define APPM_SECOND_MOMENT_LOW 5u  // low parts of the means
#define APPM_LAPLACIAN_LOW 6u
#define APPM_MOMENTS 7u

// Quantiles of the F distribution: samples of a row, uniform in 1 / (m - 1) over [0, 1/2].
#define F_QUANTILES 129
