// Every kernel, shaders/kernels/NAME.comp, a row each, pass by pass, as --stats lists them. What CMake compiles and the
// program holds, and how the host names, compiles, times and resumes it, follow from the rows; the launches, and their
// order, stand in host/render/integrator.cpp (and path_tracer.cpp). CMake reads the rows, too: one a line, indented by
// four.
//
// ROW(name, pass, forms, modules, unfinished)
//   pass        of PASSES: whose it is
//   forms       in which it is worth compiling on a GPU (host/render/kernel_choice.h): one; groups: work groups of
//               several sizes; groups_and_waits: where lanes wait for each other, too
//   modules     one; each: one an estimator, with its hooks (shaders/estimators/estimator.glsl)
//   unfinished  PASS_*: it runs out of steps and goes on in a further round; 0: it does not
#ifdef __cplusplus
#pragma once
#endif

// Of an iteration, in its order; `picture`: of none, and not on a render's clock; `trace`: of the path tracer.
#define PASSES(ROW) ROW(photon) ROW(grid) ROW(eye) ROW(knn) ROW(area) ROW(gather) ROW(update) ROW(picture) ROW(trace)

// clang-format off
#define KERNELS(ROW)                                                  \
    ROW(photon,        photon,  groups_and_waits, one,  PASS_PHOTON) \
    ROW(grid_plan,     grid,    one,              one,  0u)          \
    ROW(grid_clear,    grid,    one,              one,  0u)          \
    ROW(grid_key,      grid,    one,              one,  0u)          \
    ROW(grid_order,    grid,    one,              one,  0u)          \
    ROW(scan_sums,     grid,    one,              one,  0u)          \
    ROW(scan_blocks,   grid,    one,              one,  0u)          \
    ROW(scan_apply,    grid,    one,              one,  0u)          \
    ROW(radix_count,   grid,    one,              one,  0u)          \
    ROW(radix_scatter, grid,    one,              one,  0u)          \
    ROW(eye,           eye,     groups,           one,  PASS_EYE)    \
    ROW(searches,      knn,     one,              one,  0u)          \
    ROW(knn,           knn,     one,              each, PASS_KNN)    \
    ROW(area,          area,    groups,           one,  PASS_AREA)   \
    ROW(gather,        gather,  groups,           each, PASS_GATHER) \
    ROW(update,        update,  one,              each, 0u)          \
    ROW(advance,       update,  one,              one,  0u)          \
    ROW(resolve,       picture, one,              one,  0u)          \
    ROW(path,          trace,   one,              one,  PASS_TRACE)
// clang-format on

// Bits of Status::blocked: what passes behind wait for. The first are of kernels that have run out of their step
// budget.
#define PASS_EYE 1u
#define PASS_PHOTON 2u
#define PASS_KNN 4u
#define PASS_GATHER 8u
#define PASS_AREA 16u
#define PASS_TRACE 32u
#define PASS_CAPACITY 64u  // a lane stored more photons than it has slots
#define PASS_LEVELS 128u    // the grid is to have more levels than there is room for
