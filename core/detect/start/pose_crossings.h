#pragma once

#include <span>
#include <vector>

#include "core/detect/contact.h"
#include "core/detect/start/crossings.h"
#include "core/detect/start/embedding.h"

namespace cscd {

// The crossing pairs of triangles of a surface in one pose after another.
//
// Finding them from nothing tests every neighbourhood of the surface with exact predicates, which takes many
// times as long as a query. But two triangles begin or cease to cross only at a moment at which a feature
// pair that they carry touches (theorem "what crosses at a start follows from what touched before it" in
// core/soundness.md). So a caller who knows all feature pairs that touched on the way from a known pose has
// to look at their carriers alone. Where nothing touched, the same pairs cross as before: in particular, an
// embedded pose stays embedded.
class PoseCrossings {
 public:
  // `reference` shapes the tree; any frame will do. At most `most` pairs are kept for a pose.
  PoseCrossings(const TriangleMesh& mesh, std::span<const Vec3> reference, std::size_t most);

  // Whether the crossings of these very positions, bit for bit, are known without work.
  bool knows(std::span<const Vec3> positions) const;

  // The positions last asked for, and what crosses there.
  std::span<const Vec3> positions() const { return positions_; }
  const Crossings& crossings() const { return crossings_; }

  // Finds the crossings from nothing.
  const Crossings& find(std::span<const Vec3> positions);

  // Derives them from the pose last asked for: every vertex moved from there in a straight line, and
  // `touched` holds all feature pairs that touched on the way, decided or not. Finds them from nothing where
  // the last pose's pairs are not all known.
  const Crossings& follow(std::span<const Vec3> positions, const ContactSet& touched);

 private:
  const TriangleMesh& mesh_;
  EmbeddingTest test_;
  std::size_t most_;
  std::vector<Vec3> positions_;
  Crossings crossings_;
};

}  // namespace cscd
