#include "app/version.h"

namespace vkcppm {

std::string version() { return VKCPPM_VERSION; }

std::string commit() { return VKCPPM_COMMIT; }

}  // namespace vkcppm
