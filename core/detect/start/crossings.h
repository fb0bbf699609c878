#pragma once

#include <span>
#include <utility>
#include <vector>

#include "core/detect/contact.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// Two different triangles of one mesh, the smaller number first.
using CrossingPair = std::pair<TriangleId, TriangleId>;

// The pairs of triangles that cross in one pose: pairs that meet outside the vertices and edges they share.
struct Crossings {
  std::vector<CrossingPair> pairs;  // sorted; all of them, unless there are more than the caller wanted kept
  std::size_t total = 0;

  bool all_kept() const { return pairs.size() == total; }
  bool contains(const CrossingPair& pair) const;
};

// The pairs of triangles that carry a feature pair: one triangle has the first feature, the other the second.
std::vector<CrossingPair> carriers(const TriangleMesh& mesh, const FeaturePair& pair);

}  // namespace cscd
