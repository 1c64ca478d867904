#include "app/interrupt.h"

#include <array>
#include <atomic>
#include <csignal>

namespace vkcppm {
namespace {

std::atomic<bool> signalled = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may touch lock-free atomics alone");

constexpr std::array signals = {SIGINT, SIGTERM, SIGHUP};

void on_signal(int) {
    signalled = true;
    for (const int signal : signals) std::signal(signal, SIG_DFL);
}

}  // namespace

void catch_interrupts() {
    for (const int signal : signals) {
        // Under nohup the end of the terminal stays without a meaning.
        if (std::signal(signal, on_signal) == SIG_IGN) std::signal(signal, SIG_IGN);
    }
}

bool interrupted() { return signalled; }

}  // namespace vkcppm
