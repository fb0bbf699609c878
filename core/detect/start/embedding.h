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

// Decides exactly whether a frame is embedded: no two triangles meet except in the vertices and edges they
// share. (No feature pair touches, and no edge pierces a face.) The theorem behind the guarantee
// `first_contact` needs it.
class EmbeddingTest {
 public:
  // `reference` shapes the tree; any frame will do.
  EmbeddingTest(const TriangleMesh& mesh, std::span<const Vec3> reference);

  // Returns two triangles that meet, or nothing if the frame is embedded.
  std::optional<CrossingPair> find_intersection(std::span<const Vec3> positions);
  bool embedded(std::span<const Vec3> positions) { return !find_intersection(positions); }

  // Counts all pairs that meet, and keeps up to `most` of them.
  Crossings find_all(std::span<const Vec3> positions, std::size_t most);

 private:
  // Calls found(pair) for every pair that meets until it returns false.
  template <class Found>
  void search(std::span<const Vec3> positions, const Found& found);

  const TriangleMesh& mesh_;
  Tree tree_;
  SweptBounds bounds_;
};

}  // namespace cscd
