#include "support/files/places.h"

namespace vkcppm::test {

std::filesystem::path source_folder() { return VKCPPM_SOURCE_DIR; }

std::string program() { return VKCPPM_PROGRAM; }

std::string fault_layer_folder() { return VKCPPM_FAULT_LAYER; }

std::string spirv_val() { return VKCPPM_SPIRV_VAL; }

std::filesystem::path failure_folder() {
    const std::filesystem::path folder = VKCPPM_FAILURES;
    std::filesystem::create_directories(folder);
    return folder;
}

}  // namespace vkcppm::test
