#pragma once

#include "core/engine/patches.h"

namespace cscd::fast {

// The last cover, made of whole patches: those that lie inside no cluster of the cutting covers, those of
// them that touch each other together, and rings of patches about them. Fills in `cover` and the patches.
void cover_corners(const TriangleMesh& mesh, std::span<const Vec3> reference, PatchTree& tree, Cover& cover);

}  // namespace cscd::fast
