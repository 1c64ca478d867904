#pragma once
// Faults of drivers that tests keep clear of.

#include <string_view>

namespace vkcppm::test {

/// True for lavapipe of Mesa 25.2 (Ubuntu 24.04), which ends with a segmentation fault in code of its own where kernels
/// read texels as storage: the eye pass reads a buffer's descriptor that no lane of the SIMD group has set. Nothing but
/// the fault layer makes it read them so. 25.0 and 22.3 do not. driver: DeviceInfo::driver, or what holds it.
inline bool faults_where_texels_are_storage(std::string_view driver) {
    return driver.find("llvmpipe Mesa 25.2.") != std::string_view::npos;
}
inline constexpr const char* why_storage_faults =
    "lavapipe of Mesa 25.2 ends in code of its own where texels are storage";

}  // namespace vkcppm::test
