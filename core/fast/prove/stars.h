#pragma once

#include <cstdint>
#include <vector>

#include "core/fast/look/local_positions.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// Proofs for pairs of adjacent triangles, by the star of a vertex that they share.
//
// The *star* of a vertex is the set of the triangles at that vertex. A star is *flat* if it is the graph of a
// function over one plane at every t. Two triangles of a flat star touch nowhere but in what they share,
// whatever the start. The proof needs no cluster.
//
// How flatness is proven. Only a star that is one closed fan is considered. Seen along the plane's normal,
// all its triangles have positive area at every t. So the angles under which the triangles are seen from the
// vertex sum to a whole number of full turns, and that number cannot change while the areas stay positive. At
// t = 0 some direction lies in the sector of one triangle alone, so the number is one. Therefore the sectors
// never overlap.
class Stars {
 public:
  explicit Stars(const TriangleMesh& mesh);

  // True is a proof that the star of the vertex is flat in the interval of these positions. False says
  // nothing.
  bool flat(VertexId vertex, const LocalPositions& positions) const;
  // Reads the stars into the cache, for a caller who is going to ask about most vertices.
  void bring_near() const;

 private:
  std::vector<std::int32_t> offset_;  // [vertices + 1]; where the ring of each vertex begins in `ring_`
  std::vector<std::int32_t> ring_;    // the vertices round a vertex, in order; none if its star is no fan
};

}  // namespace cscd::fast
