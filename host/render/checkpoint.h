#pragma once
// A render put down between two iterations, to be taken up again.

#include <cstddef>
#include <vector>

#include "core/curve.h"
#include "render/report.h"

namespace vkcppm {

struct Checkpoint {
    Report report;                 // of the iterations so far, over all runs; device and driver: of the last one
    Curve curve;                   // the snapshots so far, where the render is measured
    std::vector<std::byte> state;  // Integrator::save()
};

}  // namespace vkcppm
