#pragma once

#include <span>

#include "core/crossing/overlaps.h"
#include "core/crossing/pieces.h"
#include "core/detect/exclusions.h"
#include "core/detect/start/embedding.h"
#include "core/mesh/triangle_mesh.h"

#include "cscd/cscd.h"

namespace cscd {

// Answers SelfCollision::crossings() for one mesh, and says what lies within its overlaps.
class CrossingSearch {
 public:
  CrossingSearch(const TriangleMesh& mesh, std::span<const Vec3> reference)
      : mesh_(mesh), pairs_(mesh, reference), finder_(mesh) {}

  SelfCollision::Crossings find(std::span<const Vec3> positions, const Exclusions& excluded);
  // The pieces of all overlaps that are not excluded, for Exclusions::ongoing.
  OverlapPieces find_pieces(std::span<const Vec3> positions, const Exclusions& excluded);

 private:
  // All overlaps of a pose.
  Overlaps overlaps(std::span<const Vec3> positions, bool each_way);
  // Whether most of the pairs of an overlap are excluded.
  bool excludes(const Exclusions& excluded, const CrossingCurves& all, const Overlap& overlap) const;

  const TriangleMesh& mesh_;
  EmbeddingTest pairs_;
  OverlapFinder finder_;
};

}  // namespace cscd
