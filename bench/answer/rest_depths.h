#pragma once

#include <span>
#include <utility>
#include <vector>

#include "core/base/vec3.h"
#include "core/crossing/overlaps.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::bench {

// How deep the pieces of a surface that cross at rest lie in each other there, place by place.
class RestDepths {
 public:
  RestDepths() = default;  // nothing crosses at rest
  // `rest`, [vertices], is the pose at rest, and `pairs` are all pairs of triangles that meet there, sorted.
  RestDepths(const TriangleMesh& mesh, OverlapFinder& finder, std::span<const Vec3> rest,
             std::span<const CrossingPair> pairs);

  // Returns the largest depth of the overlaps at rest that an overlap of another pose may continue, because a
  // pair of its triangles lies within RestCrossings::kRings rings round theirs: the depth that is known, or
  // where none is, what no point exceeds. Returns 0 where there is no such overlap.
  double most_near(const CrossingCurves& all, const Overlap& overlap) const;

 private:
  std::vector<double> depth_;                             // [overlaps at rest]
  std::vector<std::pair<TriangleId, std::size_t>> near_;  // triangles, and overlaps near them; sorted
};

}  // namespace cscd::bench
