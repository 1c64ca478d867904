#pragma once
// Any bytes through the reader that takes them, and what must hold whatever they are.

#include <string>

#include "support/files/temporary_folder.h"

namespace vkcppm::test {

/// Reads `bytes` as what their beginning says: OpenEXR or Radiance as a picture and as an environment, PNG, JPEG or
/// WebP as a texture, all else as glTF, which is diagnosed and, where it is small, flattened for the kernels. Returns
/// what is wrong about how that went, or nothing. Right is:
/// - a sound scene or finite picture, or Error(bad_input) in one short line that begins with the file's name and does
///   not leave the explanation to what a library threw;
/// - no other exception, which passes through.
std::string misbehaviour(const std::string& bytes);

}  // namespace vkcppm::test
