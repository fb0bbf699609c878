#pragma once

#include "core/engine/patches.h"

namespace cscd::fast {

// The clusters of the last cover, made of whole patches: those with triangles that lie inside no cluster of
// the others, those of them that touch each other together, and rings of patches about them.
void cover_corners(const PatchTree& tree, Cover& cover);

}  // namespace cscd::fast
