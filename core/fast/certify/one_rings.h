#pragma once

#include <cstdint>
#include <vector>

#include "core/fast/classify/local_positions.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// The one-ring of a vertex is the set of triangles at the vertex. A one-ring is flat in an interval if it is
// the graph of a function over some plane at every t. Two triangles of a flat one-ring touch nowhere but in
// what they share, whatever the start, so flat one-rings settle pairs of adjacent triangles without any
// cluster.
//
// Why: the one-ring is one closed fan (nothing is said of other one-rings). Seen along the normal of the
// plane, all its triangles have positive area, so the angles under which they are seen at the vertex sum to a
// whole number of turns, which cannot change as long as the areas stay positive. At t = 0 some direction lies
// in one triangle alone, so the number is one: the sectors of the triangles never overlap.
//
// Seen along that normal, features of two triangles of a flat one-ring that share no vertex are as far apart
// as the least height of its triangles ("Theorem: flat one-rings keep a distance", core/soundness.md).
class OneRings {
 public:
  explicit OneRings(const TriangleMesh& mesh);

  // Whether the one-ring of the vertex is certainly flat in the interval of these positions, and features of
  // two of its triangles that share no vertex are certainly farther apart than a distance, in local units.
  // False proves nothing.
  bool flat(VertexId vertex, const LocalPositions& positions, float distance = 0) const;
  // Reads everything once from end to end, for a caller who is going to ask about most vertices.
  void warm_cache() const;

 private:
  std::vector<std::int32_t> offset_;  // [vertices]: where the ring of a vertex begins in `ring_`
  std::vector<std::int32_t>
      ring_;  // the vertices round each vertex in the order of its triangles; none if they are no closed fan
};

}  // namespace cscd::fast
