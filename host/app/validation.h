#pragma once
// What --validate promises.

#include "vk/device.h"

namespace vkcppm {

/// Prints the messages of the validation layer; throws Error(internal) where there are any.
void check_validation(const Device& device);

}  // namespace vkcppm
