#pragma once

#include <span>
#include <utility>
#include <vector>

#include "core/detect/contact.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// Two different triangles of one mesh, the smaller index first.
using CrossingPair = std::pair<TriangleId, TriangleId>;

// The triangle pairs that cross in one pose. Two triangles *cross* if they meet outside the
// vertices and edges that they share.
struct Crossings {
  std::vector<CrossingPair> pairs;  // sorted; incomplete if more pairs cross than the caller wanted to keep
  std::size_t total = 0;            // number of all pairs that cross

  bool all_kept() const { return pairs.size() == total; }
  bool contains(const CrossingPair& pair) const;
};

// Returns the triangle pairs that carry a feature pair: one triangle has the first feature, and
// the other has the second feature.
std::vector<CrossingPair> carriers(const TriangleMesh& mesh, const FeaturePair& pair);

}  // namespace cscd
