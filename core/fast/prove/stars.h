#pragma once

#include <cstdint>
#include <vector>

#include "core/fast/look/local_positions.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// Vertices whose star, the triangles at them, is the graph of a function over some plane at every t. Two
// triangles of such a star touch nowhere but in what they share, whatever the start: a proof for pairs of
// adjacent triangles that needs no cluster.
//
// Why: the star is one closed fan (of others nothing is said). Seen along the plane's normal all its
// triangles have positive area, so the angles under which they are seen at the vertex sum to a multiple of a
// full turn, which cannot change as long as they stay positive. At t = 0 some direction lies in one of them
// alone, hence one turn: their sectors never overlap.
class Stars {
 public:
  explicit Stars(const TriangleMesh& mesh);

  // At the vertex, in the interval of these positions. False is no statement.
  bool flat(VertexId vertex, const LocalPositions& positions) const;
  // For who is going to ask about most vertices.
  void bring_near() const;

 private:
  std::vector<std::int32_t> offset_;  // of each vertex, in `ring_`
  std::vector<std::int32_t> ring_;  // the vertices round it, in the triangles' order; none where it is no fan
};

}  // namespace cscd::fast
