#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/detect/start/crossings.h"

namespace cscd {

// Returns all triangles within some rings round one triangle, that triangle included, in ascending order. A
// ring: all triangles that share a vertex with those inside.
std::vector<TriangleId> within_rings(const TriangleMesh& mesh, TriangleId center, int rings);

// Triangles that cross at rest are how a surface is made, and no collision: eyes in sockets, teeth in gums,
// clothes in skin. This class says which crossings and contacts they explain.
//
// A pair of triangles that crosses at rest explains itself. Where the two belong to different components, the
// line along which they cross shifts by a triangle or two as both bend. The pair then also explains every
// pair of triangles of which one lies within kRings rings round the first and the other within kRings rings
// round the second. (The pairs alone, or one ring, leave the teeth of a shark crossing its gums in some
// frames.) Inside one component only the pairs themselves count, so that a limb that crosses its own crease
// elsewhere is still reported.
//
// Two exceptions keep collisions from being explained away:
// - Triangles that only touch at rest explain nothing. A box that lies on a box touches that box, and may be
//   pressed into it.
// - Pairs that cross at rest explain something as long as their *place* has not parted. A place is a set of
//   pairs that hang together along the line on which two pieces cross: neighbours in it share a vertex on
//   both sides. A place has parted once no pair that it explains crosses in a pose that follow() was told.
//   What has parted and comes back is a collision.
class RestCrossings {
 public:
  static constexpr int kRings = 2;

  RestCrossings() = default;  // explains nothing
  // Takes the pairs that pass through each other at rest (Meetings), all of which must be kept. `mesh` must
  // outlive the object.
  RestCrossings(const TriangleMesh& mesh, const Crossings& at_rest);

  bool empty() const { return pairs_.pairs.empty(); }

  // Takes the pairs that cross in the next pose of a motion that began at rest. Where not all of them are
  // kept, nothing is known to have parted.
  void follow(const Crossings& pose);

  // Returns whether a triangle pair that crosses is explained.
  bool explains(const CrossingPair& pair) const;
  // Whether a pair of triangles that is explained carries the feature pair.
  bool explains(const FeaturePair& pair) const;

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  // Returns the crossings at rest that are near a triangle, in ascending order. Number 2 i means that the
  // triangle is near the first triangle of pair i, number 2 i + 1 that it is near the second.
  std::span<const std::uint32_t> near(TriangleId triangle) const;
  // Divides the pairs into places.
  void find_places();
  // Returns the number of a pair that crosses at rest, or kNone.
  std::size_t number_of(const CrossingPair& pair) const;

  const TriangleMesh* mesh_ = nullptr;
  Crossings pairs_;
  std::vector<std::uint32_t> offset_, near_;  // row of triangle t: near_[offset_[t] .. offset_[t + 1])
  std::vector<std::size_t> place_;            // [pairs_]
  std::vector<bool> parted_;                  // [places]
  std::vector<CrossingPair> witness_;  // [places], a pair that it explains and that crossed in the last pose
};

}  // namespace cscd
