#pragma once
// Ctrl-C and its kin: the render ends early and keeps what it has.

namespace vkcppm {

/// From now on the first SIGINT, SIGTERM or SIGHUP makes interrupted() true; the second ends the process. A SIGHUP that
/// is ignored, as under nohup, stays so.
void catch_interrupts();

bool interrupted();

}  // namespace vkcppm
