#pragma once
// What a reference was, as text.

#include <string>

#include "app/options.h"
#include "io/exr.h"
#include "scene/scene.h"
#include "study/reference.h"

namespace vkcppm {

/// The EXR's attributes, named "vkcppm.*": what makes it again, and its expected error.
ExrAttributes reference_attributes(const ReferenceOptions& options, const Scene& scene, const Reference& reference);

/// R, G, B, their standard error StdErr, root mean square over channels, the same of means over blocks of 8, 64, ...
/// pixels, StdErr.8, StdErr.64, ..., at all pixels of a block, and Trust, 1 or 0.
ExrChannels reference_channels(const Reference& reference);

/// A JSON object: settings, error, and where there is room for them (`stats`) times of the passes.
std::string reference_json(const ReferenceOptions& options, const Scene& scene, const Reference& reference, bool stats);

/// ", relMSE about 0.0034": how far a reference is; nothing while that is not known.
std::string relmse_text(const ReferenceProgress& progress);

/// The summary to read.
std::string reference_summary(const Reference& reference);

}  // namespace vkcppm
