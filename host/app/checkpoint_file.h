#pragma once
// A checkpoint on disk, with what it is of.

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "app/options.h"
#include "core/image.h"
#include "render/checkpoint.h"
#include "scene/scene.h"

namespace vkcppm {

/// What a picture's bits follow from, but for device and driver, and the iterations: names and values, for people to
/// read where two differ.
using Identity = std::vector<std::pair<std::string, std::string>>;

/// FNV-1a of its pixels.
std::uint64_t hash_of(const Image& image);

/// Of a render: program and kernels, the content of the scene and what was done to it, settings, the reference.
/// `settings` must be resolved; reference: null where the render is not measured.
Identity identity_of(const SceneOptions& options, const Scene& scene, const Settings& settings, const Image* reference);

/// Throws Error(usage) with every name of which the two have other values. in: what `there` stands in, such as "the
/// checkpoint".
void require_same(const Identity& there, const Identity& asked, const std::filesystem::path& file,
                  const std::string& in);

/// Replaces `file` by the checkpoint: whole, or not at all (io/atomic_file.h). Throws Error(cannot_write).
///
/// The file: "vkcppmck", then little-endian words of 64 bits: format, bytes of the header, bytes of the state; the
/// header; the state; FNV-1a of all before it. The header: identity, report, curve.
void write_checkpoint(const std::filesystem::path& file, const Identity& identity, const Checkpoint& checkpoint);

/// Throws Error(no_input) where there is no such file, Error(bad_input) where it is no checkpoint, of another format,
/// cut off or damaged, or its state is larger than that of a picture of `pixels`, Error(usage) with what differs where
/// it is not of `identity`. Takes no more memory than the file has bytes, and of another render none for its state.
Checkpoint read_checkpoint(const std::filesystem::path& file, const Identity& identity, std::size_t pixels);

}  // namespace vkcppm
