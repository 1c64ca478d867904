#include "support/files/places.h"

#include <cstdlib>

namespace vkcppm::test {

std::filesystem::path source_folder() {
    const char* elsewhere = std::getenv("VKCPPM_TEST_SOURCE");
    return elsewhere ? elsewhere : VKCPPM_SOURCE_DIR;
}

std::string program() { return VKCPPM_PROGRAM; }

std::string fault_layer_folder() { return VKCPPM_FAULT_LAYER; }

std::string spirv_val() { return VKCPPM_SPIRV_VAL; }

std::filesystem::path failure_folder() {
    const char* elsewhere = std::getenv("VKCPPM_TEST_FAILURES");
    const std::filesystem::path folder = elsewhere ? elsewhere : VKCPPM_FAILURES;
    std::filesystem::create_directories(folder);
    return folder;
}

}  // namespace vkcppm::test
