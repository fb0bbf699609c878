#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/fast/prepare/patches.h"
#include "core/mesh/near_triangles.h"

namespace cscd::fast {

// Which triangles have nothing but tall triangles of one cluster (classify/patch_lanes.h) round them. The
// first ring of a triangle is all triangles that share a vertex with it, and the second ring all that share a
// vertex with the first.
//
// Two features are *near on the surface* if some triangle has a vertex of both. Then any two triangles that
// carry them lie in each other's second ring. If all pairs start farther apart than the thickness, and one
// cover has tall triangles alone in two rings round one of the two triangles and in one ring round the other,
// the two features are not the first to come within the thickness ("Theorem: tall rings",
// core/soundness.md). Such a pair of triangles is *settled*.
class TallRings {
 public:
  // Both must outlive the object.
  TallRings(const TriangleMesh& mesh, const PatchTree& tree) : mesh_(mesh), tree_(tree) {}

  // An interval is one call of `start`, one call of `take` for every patch and cover, from any thread, and
  // one call of find_one_rings() or of find_unsettled(). The first `covers` are in use.
  void start(std::size_t covers);
  // Takes the tall triangles of a patch, none where it is in no cluster.
  void take(std::size_t patch, std::size_t cover, Mask16 tall) {
    spoiled_[patch][cover] = static_cast<Mask16>(tree_.patches[patch].lanes & ~static_cast<unsigned>(tall));
  }

  // Takes out triangles that are not clear of others (contour/capped_clusters.h), before find_one_rings().
  void spoil(std::size_t patch, std::size_t cover, Mask16 triangles) { spoiled_[patch][cover] |= triangles; }
  void find_one_rings();
  // The triangles of a patch whose first ring is tall and clear.
  Mask16 one_rings(std::size_t patch, std::size_t cover) const {
    return static_cast<Mask16>(inner_[0][patch][cover] & ~static_cast<unsigned>(spoiled_[patch][cover]));
  }

  void find_unsettled();
  // Calls take(a, b) for all pairs of triangles in each other's second ring that are not settled, in an order
  // that depends on the interval alone. Some may come twice.
  template <class Take>
  void for_each_unsettled_pair(const Take& take) const {
    for (const auto& [a, b] : never_settled_) take(a, b);
    for (const TriangleId a : touched_)
      for (const TriangleId b : near_->of(a))
        if (!(b < a && is_touched(b)) && !settled(rings_of_[+a], rings_of_[+b])) take(a, b);
  }

  // Clusters of the first cover have changed.
  void forget_clusters() { known_ = false; }

 private:
  using Masks = std::vector<std::array<Mask16, kCovers>>;  // [patches][covers]
  // The covers in which one ring is tall, a bit each, and above them those in which two are.
  using RingBits = std::uint8_t;
  static constexpr unsigned kSecondRing = 4;
  static_assert(kCovers <= kSecondRing);
  static bool settled(RingBits a, RingBits b) {
    return ((a >> kSecondRing & b) | (a & b >> kSecondRing)) != 0;
  }

  bool is_touched(TriangleId t) const { return rings_of_[+t] != inner_rings_[+t]; }

  void find_inner();
  void shrink(const Masks& from, Masks& to) const;
  void begin_spread();
  void spread_ring();
  void find_never_settled();
  void clear_rings(unsigned ring);
  const TriangleMesh& mesh_;
  const PatchTree& tree_;
  std::size_t covers_ = 0;
  bool known_ = false;          // whether what follows is that of the clusters
  std::array<Masks, 2> inner_;  // triangles with one ring, and with two, inside their cluster
  std::vector<std::pair<TriangleId, TriangleId>> never_settled_;  // by their clusters
  bool pairs_known_ = false;                                      // whether these are found
  std::vector<RingBits> inner_rings_;                             // [triangles]: what inner_ says of each

  Masks spoiled_;                                 // triangles that are not tall, or have such in a ring
  Masks fresh_, next_;                            // those of the last ring, and of the next one
  std::vector<std::int32_t> front_, next_front_;  // the patches of these
  std::vector<std::int32_t> spread_over_;         // all patches so far
  std::vector<RingBits> rings_of_;                // [triangles]
  std::vector<TriangleId> touched_;    // triangles of which the interval says less than the clusters
  std::optional<NearTriangles> near_;  // made when first needed
};

}  // namespace cscd::fast
