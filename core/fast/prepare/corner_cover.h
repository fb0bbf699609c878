#pragma once

#include <cstdint>
#include <vector>

#include "core/fast/prepare/patches.h"

namespace cscd::fast {

// Returns the clusters of the third cover, [triangles], with kNone for a triangle without a cluster. A
// cluster is made of whole patches. It begins as a connected group of patches, each of which holds a triangle
// that lies inside no cluster of the first two covers. It then takes in a few rings of patches round the
// group. `tree.inside` must already say what lies inside the clusters of the first two covers.
std::vector<std::int32_t> corner_clusters(const TriangleMesh& mesh, const PatchTree& tree);

}  // namespace cscd::fast
