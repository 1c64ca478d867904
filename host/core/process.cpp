#include "core/process.h"

#include <chrono>

#include <sys/resource.h>

namespace vkcppm {
namespace {

rusage usage_now() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage;
}

double seconds(const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); }

}  // namespace

double wall_now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

double cpu_now() {
    const rusage usage = usage_now();
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::uint64_t peak_memory() {
#ifdef __APPLE__
    constexpr std::uint64_t unit = 1;  // B
#else
    constexpr std::uint64_t unit = 1024;
#endif
    return std::uint64_t(usage_now().ru_maxrss) * unit;
}

}  // namespace vkcppm
