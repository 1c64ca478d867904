#pragma once
// Files that are nearly right.

#include <cstdint>
#include <string>

namespace vkcppm::test {

/// `bytes` with up to four changes that follow from `seed`. Of a .gltf or .glb mostly values of its JSON are changed:
/// replaced by what is seldom right (-1, 2^31, 1e300, null, an empty array, "../x", ...), moved by one, removed,
/// repeated, swapped, or put where glTF has members that are rare. Else bytes are flipped, set, removed, repeated or
/// the file is cut. The same on every machine.
std::string mutation(const std::string& bytes, std::uint32_t seed);

}  // namespace vkcppm::test
