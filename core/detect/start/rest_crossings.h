#pragma once

#include <cstdint>
#include <vector>

#include "core/detect/start/crossings.h"

namespace cscd {

// Says which crossings and contacts are explained by crossings in the rest pose. Those belong to the way in
// which a surface is made (eyes in sockets, teeth in gums, clothes in skin) and are no collisions.
//
// A triangle pair that crosses at rest explains itself. If its two triangles belong to different components,
// the line along which the components cross shifts by a triangle or two as both bend. Such a pair therefore
// also explains every triangle pair of which one triangle lies within kRings rings round the first triangle
// and the other within kRings rings round the second. (With fewer rings, the teeth of a shark still cross its
// gums in some frames.) Within one component, a pair explains only itself, so that a limb that crosses its
// own crease in another place is still reported.
class RestCrossings {
 public:
  static constexpr int kRings = 2;  // a ring: all triangles that share a vertex with those inside

  RestCrossings() = default;  // explains nothing
  // Takes the crossings at rest, all of which must be kept. `mesh` must outlive the object.
  RestCrossings(const TriangleMesh& mesh, const Crossings& at_rest);

  bool empty() const { return pairs_.pairs.empty(); }
  // Returns whether a triangle pair that crosses is explained.
  bool explains(const CrossingPair& pair) const;
  // Returns whether some triangle pair that carries the feature pair is explained.
  bool explains(const FeaturePair& pair) const;

 private:
  // Returns the crossings at rest that are near a triangle, in ascending order. Number 2 i means that the
  // triangle is near the first triangle of pair i, number 2 i + 1 that it is near the second.
  std::span<const std::uint32_t> near(TriangleId triangle) const;

  const TriangleMesh* mesh_ = nullptr;
  Crossings pairs_;
  std::vector<std::uint32_t> offset_, near_;  // row of triangle t: near_[offset_[t] .. offset_[t + 1])
};

}  // namespace cscd
