#pragma once
// What the kernels of one pass have cost.

#include <span>

#include "render/kernels.h"
#include "render/report.h"

namespace vkcppm::test {

/// The sum over the kernels of that pass; form: of the last that has one.
inline PassReport report_of(std::span<const PassReport> reports, Pass pass) {
    PassReport sum;
    for (const KernelRow& kernel : kernel_rows()) {
        for (const PassReport& of : reports) {
            if (kernel.pass != pass || of.name != kernel.name) continue;
            sum.calls += of.calls;
            sum.device_seconds += of.device_seconds;
            if (!of.form.empty()) sum.form = of.form;
        }
    }
    return sum;
}

}  // namespace vkcppm::test
