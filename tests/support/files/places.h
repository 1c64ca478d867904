#pragma once
// Where the project and what is built of it are. Only places.cpp is compiled with their names: no other file has to be
// compiled again where they differ. The environment's VKCPPM_TEST_SOURCE and VKCPPM_TEST_FAILURES go before what was
// compiled in, for test programs that run on another machine than the one that they were built on.

#include <filesystem>
#include <string>

namespace vkcppm::test {

/// The repository.
std::filesystem::path source_folder();

/// The built program.
std::string program();

/// Holds layer.json of the Vulkan layer that injects faults.
std::string fault_layer_folder();

/// The program that validates modules.
std::string spirv_val();

/// Where a failed test leaves what explains it; made where it is not there.
std::filesystem::path failure_folder();

}  // namespace vkcppm::test
