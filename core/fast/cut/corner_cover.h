#pragma once

#include <cstdint>
#include <vector>

#include "core/fast/cut/patches.h"

namespace cscd::fast {

// Returns the clusters of the third cover, [triangles], made of whole patches. A cluster begins as a
// connected group of patches that hold a triangle inside no cluster of the first two covers (`tree.inside` of
// those has to be filled in), and takes in a few rings of patches about them.
std::vector<std::int32_t> corner_clusters(const TriangleMesh& mesh, const PatchTree& tree);

}  // namespace cscd::fast
