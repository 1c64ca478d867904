#pragma once
// What --validate promises.

#include "vk/device.h"

namespace vkcppm {

/// Throws Error(no_device) where the validation layer was asked for and is not installed.
void require_validation(const Device::Options& options, const Device& device);

/// Prints the messages of the validation layer; throws Error(internal) where there are any.
void check_validation(const Device& device);

}  // namespace vkcppm
