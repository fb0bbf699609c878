#pragma once

#include <optional>
#include <span>

#include "core/detect/start/crossings.h"
#include "core/hierarchy/bounds.h"
#include "core/hierarchy/tree.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// Whether two different triangles meet in these positions, except in the vertices and edges they share.
// Exact.
bool triangles_meet(const TriangleMesh& mesh, std::span<const Vec3> positions, const CrossingPair& pair);

// Decides exactly whether a frame is *embedded*: no two triangles meet outside the vertices and edges that
// they share. In an embedded frame no feature pair touches and no edge pierces a face. The theorem behind the
// guarantee `first_contact` needs an embedded start (rule embedded-start, core/soundness.md).
class EmbeddingTest {
 public:
  // Builds a tree from the positions `reference` ([vertices]); any frame will do.
  // `mesh` must outlive the object.
  EmbeddingTest(const TriangleMesh& mesh, std::span<const Vec3> reference);

  // Returns two triangles that meet, or nothing if the frame is embedded.
  std::optional<CrossingPair> find_intersection(std::span<const Vec3> positions);
  bool embedded(std::span<const Vec3> positions) { return !find_intersection(positions); }

  // Counts all pairs that meet, and keeps up to `most` of them.
  Crossings find_all(std::span<const Vec3> positions, std::size_t most);

 private:
  // Calls found(pair) for every triangle pair that meets, until found() returns false.
  template <class Found>
  void search(std::span<const Vec3> positions, const Found& found);

  const TriangleMesh& mesh_;
  Tree tree_;
  SweptBounds bounds_;
};

}  // namespace cscd
