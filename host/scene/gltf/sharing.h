#pragma once
// Which meshes are stored once and shown by instances.
//
// A mesh is shared where copies cost more than they spare. Iterations through instances take 1.1 to 1.5 times as long
// (tests/bench/results/speed.md), and a copied triangle takes some 400 bytes and 7 microseconds to load: so all is
// copied while that is some 100 MB and 2 seconds. Beyond that each mesh is shared that is used more than once, has more
// than a few triangles, and does not emit.

namespace vkcppm {

enum class Sharing {
    by_cost,
    never,   // for comparison: what instances show is what copies show
    always,  // of all that can be shared
};

}  // namespace vkcppm
