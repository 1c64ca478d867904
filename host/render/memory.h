#pragma once
// What the memory of a render is for.

#include <vector>

#include "render/report.h"
#include "render/scene_buffers.h"

namespace vkcppm {

/// The buffers by what they hold an entry of; what has no such measure comes last. Their bytes sum to all buffers'.
std::vector<MemoryReport> memory_of(const SceneBuffers& buffers);

}  // namespace vkcppm
