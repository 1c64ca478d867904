#include "core/process.h"

#include <chrono>
#include <fstream>
#include <limits>
#include <string>
#include <thread>

#include <sys/resource.h>
#include <unistd.h>

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

std::uint64_t total_memory() { return std::uint64_t(sysconf(_SC_PHYS_PAGES)) * std::uint64_t(sysconf(_SC_PAGESIZE)); }

std::uint64_t available_memory() {
    std::ifstream meminfo("/proc/meminfo");
    for (std::string name; meminfo >> name;) {
        std::uint64_t kilobytes = 0;
        if (name == "MemAvailable:" && meminfo >> kilobytes) return kilobytes * 1024;
        meminfo.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    }
    return std::numeric_limits<std::uint64_t>::max();
}

std::string processor() {
    std::ifstream cpuinfo("/proc/cpuinfo");
    std::string name = "unknown", flags;
    for (std::string line; std::getline(cpuinfo, line) && flags.empty();) {
        const std::size_t colon = line.find(": ");
        if (colon == std::string::npos) continue;
        if (line.starts_with("model name")) name = line.substr(colon + 2);
        if (line.starts_with("flags")) flags = line.substr(colon + 1) + " ";
    }
    std::string text = name + ", " + std::to_string(std::thread::hardware_concurrency()) + " threads";
    if (flags.empty()) return text;
    for (const char* flag : {"fma", "avx2"}) {
        text += flags.find(std::string(" ") + flag + " ") == std::string::npos ? ", without " : ", with ";
        text += flag;
    }
    return text;
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
