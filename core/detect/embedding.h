#pragma once

#include <optional>
#include <span>
#include <utility>

#include "core/hierarchy/bounds.h"
#include "core/hierarchy/tree.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// Decides exactly whether a frame is embedded: no two triangles meet except in the vertices and edges they
// share. (No feature pair touches, and no edge pierces a face.) The theorem behind the guarantee
// `first_contact` needs it.
class EmbeddingTest {
 public:
  // `reference` shapes the tree; any frame will do.
  EmbeddingTest(const TriangleMesh& mesh, std::span<const Vec3> reference);

  // Two triangles that meet, or nothing if the frame is embedded.
  std::optional<std::pair<TriangleId, TriangleId>> find_intersection(std::span<const Vec3> positions);
  bool embedded(std::span<const Vec3> positions) { return !find_intersection(positions); }

 private:
  const TriangleMesh& mesh_;
  Tree tree_;
  SweptBounds bounds_;
};

}  // namespace cscd
