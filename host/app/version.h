#pragma once
// Which program this is.

#include <string>

namespace vkcppm {

/// The version of the program: what checkpoints, jobs and frames that are gone on from must agree in.
std::string version();

/// The commit that it was built from, with "-dirty" where files differ from it; empty where the build does not know.
std::string commit();

}  // namespace vkcppm
