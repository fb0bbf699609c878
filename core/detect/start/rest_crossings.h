#pragma once

#include <cstdint>
#include <vector>

#include "core/detect/start/crossings.h"

namespace cscd {

// Crossings at rest are how a surface is made, and no collision: eyes in sockets, teeth in gums, clothes in
// skin. This class says which crossings and contacts they explain.
//
// A pair of triangles that crosses at rest explains itself. Where the two belong to different components, the
// line along which they cross shifts by a triangle or two as both bend. The pair then also explains every
// pair of triangles of which one lies within kRings rings round the first and the other within kRings rings
// round the second. (The pairs alone, or one ring, leave the teeth of a shark crossing its gums in some
// frames.) Inside one component only the pairs themselves count, so that a limb that crosses its own crease
// elsewhere is still reported.
class RestCrossings {
 public:
  static constexpr int kRings = 2;  // a ring: all triangles that share a vertex with those inside

  RestCrossings() = default;  // explains nothing
  // Takes the crossings at rest, all of which must be kept. `mesh` must outlive the object.
  RestCrossings(const TriangleMesh& mesh, const Crossings& at_rest);

  bool empty() const { return pairs_.pairs.empty(); }
  // Returns whether a triangle pair that crosses is explained.
  bool explains(const CrossingPair& pair) const;
  // Whether a pair of triangles that is explained carries the feature pair.
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
