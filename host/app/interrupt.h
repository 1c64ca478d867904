#pragma once
// Ctrl-C and its kin: the render ends early and keeps what it has.

namespace vkcppm {

/// From now on the first SIGINT or SIGTERM makes interrupted() true; the second ends the process.
void catch_interrupts();

bool interrupted();

}  // namespace vkcppm
