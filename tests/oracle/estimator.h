#pragma once
// The update rules of every estimator as pure functions in double precision. Tests are decided by p-values from
// Boost's distribution functions (the renderer compares with quantiles), model cells are integrated by quadrature.
// Literature: Hachisuka and Jensen 2009 (sppm), Knaus and Zwicker 2011 (sppm-kz), Lin et al. 2020 (cppm, -lf, -gof),
// Kaplanyan and Dachsbacher 2013 (appm), Lin et al. 2025, arXiv:2504.04411 (ftest).

#include <cstdint>
#include <span>
#include <vector>

namespace vkcppm::oracle {

/// What an iteration does to a pixel after its photons were counted with the old radius.
struct Decision {
    double area_factor = 1.0;   // on R^2
    bool clear = false;         // start the statistics anew
    double batch_factor = 1.0;  // on B
    bool operator==(const Decision&) const = default;
};

// -- radius schedules ---------------------------------------------------------------------------------------------

/// sppm: R^2 *= (N + alpha M) / (N + M) and N += alpha M for M photons found; nothing where M = 0.
struct SppmUpdate {
    double area_factor = 1.0;
    double count = 0.0;  // the new N
};
SppmUpdate sppm_update(double count, double found, double alpha);

/// sppm-kz: R_{i+1}^2 / R_i^2 = (i + alpha) / (i + 1) after iteration i = 1, 2, ...
double sppm_kz_area_factor(std::uint64_t iteration, double alpha);

// -- tests on tallies -----------------------------------------------------------------------------------------------

/// Rings times sectors of equal area, ring-major, the innermost ring first.
struct Cells {
    std::uint32_t rings = 2, sectors = 6;
};

struct TestParameters {
    double k = 0.8;     // area factor where no inner disc passes
    double beta = 1.2;  // growth of the batch after a rejection
    double significance = 0.05;
};

/// p-value of Pearson's test that the first cells.rings * cells.sectors tallies are uniform; 1 where all are zero.
double constant_p_value(std::span<const std::uint32_t> tallies, const Cells& cells);

/// p-value of Pearson's test against the best linear density on the disc (least squares, held positive): two degrees
/// of freedom fewer. 1 where all tallies are zero.
double linear_p_value(std::span<const std::uint32_t> tallies, const Cells& cells);

/// Probabilities of the cells under density 1/pi + k1 x + k2 y on the unit disc; sum 1 (supplement, equation (9)).
std::vector<double> linear_cell_probabilities(const Cells& cells, double k1, double k2);

/// Sectors s and s + sectors/2 added: what the folded tests count. `sectors` even.
std::vector<std::uint32_t> fold(std::span<const std::uint32_t> tallies, const Cells& cells);

/// cppm, and cppm-gof on tallies whose photons were flipped at random: where total >= batch and the full disc fails,
/// R^2 becomes that of the largest inner disc that passes, or k R^2 where none does.
Decision cppm_update(std::span<const std::uint32_t> tallies, const Cells& cells, double total, double batch,
                     const TestParameters& parameters);

/// cppm-lf: the same with the linear test.
Decision cppm_lf_update(std::span<const std::uint32_t> tallies, const Cells& cells, double total, double batch,
                        const TestParameters& parameters);

/// cppm-fold: the constant test on fold(tallies); `cells` are those of the unfolded tallies.
Decision cppm_fold_update(std::span<const std::uint32_t> tallies, const Cells& cells, double total, double batch,
                          const TestParameters& parameters);

/// cppm-null: every batch shrinks by k, without a test.
Decision cppm_null_update(double total, double batch, const TestParameters& parameters);

// -- tests on contributions -----------------------------------------------------------------------------------------

/// Sums over `samples` iterations of what fell into a cell in one iteration.
struct FTestState {
    std::vector<double> sums;     // [rings x sectors] of x
    std::vector<double> squares;  // [rings] of x^2, over the ring's sectors
    std::uint32_t samples = 0;    // iterations since the radius last changed
};

/// p-value of the analysis of variance over the first cells.rings rings; 1 below three samples, where all sums are
/// equal, and 0 where the cells differ but no cell varies.
double f_test_p_value(const FTestState& state, const Cells& cells);

/// ftest; and ftest-fold, for which state and cells are those of the folded sectors (half as many, the two opposite
/// cells added before the square is taken).
Decision f_test_update(const FTestState& state, const Cells& cells, double total, double batch,
                       const TestParameters& parameters);

// -- APPM -------------------------------------------------------------------------------------------------------------

/// A kernel on the unit disc: K(t), normalised, its second moment kappa = int x_1^2 K and roughness R = int K^2.
struct Kernel {
    double (*value)(double t);
    double second_moment;
    double roughness;
};
extern const Kernel box_kernel, cone_kernel, epanechnikov_kernel, biweight_kernel, smootherstep_kernel;

/// Discrete Laplacian of the smootherstep kernel at offset (x, y) with bandwidth and step r, in 1/m^4: the average
/// over photons of Y times this estimates the Laplacian of the radiance.
double laplacian_stencil(double x, double y, double r);

/// Bandwidth of the Laplacian in iteration n: c r_1 n^(-1/8).
double appm_pilot_radius(double first_radius, std::uint64_t iteration, double c = 0.5);

/// Radius of least mean squared error from `paths` light paths in all: [2 R V / (N kappa^2 D^2)]^(1/6).
double appm_optimal_radius(const Kernel& kernel, double second_moment, double laplacian, double paths);

/// What APPM keeps of a pixel.
struct AppmState {
    double sum_second_moment = 0.0;  // of (1/J) sum Y^2 K_r over iterations
    double sum_laplacian = 0.0;      // of (1/J) sum Y D_rd
    std::uint64_t iterations = 0;    // n
    double photons = 0.0;            // seen in all
    double first_radius = 0.0;       // m
};

/// The radius for iteration n + 1: the optimal one for n J paths inside [low, high] n^(-1/6), times the first radius;
/// the first radius until ten photons were seen. `least_laplacian_squared` keeps flat fields finite.
double appm_radius(const AppmState& state, const Kernel& kernel, double paths_per_iteration, double low, double high,
                   double least_laplacian_squared);

}  // namespace vkcppm::oracle
