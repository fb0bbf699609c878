#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/fast/prepare/patches.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::fast {

// Which triangles have nothing but tall triangles of one cluster (classify/patch_lanes.h) round them, within
// one ring or three. The first ring of a triangle is all triangles that share a vertex with it, and each
// further ring all that share a vertex with the ring before.
//
// Two features are *near on the surface* if some triangle has a vertex of both. If all pairs start farther
// apart than the thickness, and the three rings of a triangle are tall, no feature near one of its features is
// the first to come within the thickness ("Theorem: tall rings", core/soundness.md). Such a triangle is
// *settled*. Two triangles that carry features near on the surface lie in each other's second ring.
class TallRings {
 public:
  static constexpr std::size_t kRings = 3;

  // Both must outlive the object.
  TallRings(const TriangleMesh& mesh, const PatchTree& tree) : mesh_(mesh), tree_(tree) {}

  // An interval is one call of `start`, one call of `take` for every patch and cover, from any thread, and one
  // call of `spread`. `covers` are those in use.
  void start(std::size_t covers);
  void take(std::size_t patch, std::size_t cover, Mask16 tall) {
    const Mask16 lanes = tree_.patches[patch].lanes;
    spoiled_[patch][cover] = static_cast<Mask16>(lanes & ~static_cast<unsigned>(tall));
  }
  // Takes out a triangle that is clear of others no longer, before `spread`.
  void spoil(std::size_t patch, std::size_t cover, Mask16 triangles) {
    spoiled_[patch][cover] |= triangles;
  }
  void spread(std::size_t rings);

  // The triangles of a patch that have tall triangles of their cluster in all rings that `spread` was asked
  // for.
  Mask16 left(std::size_t patch, std::size_t cover) const {
    return static_cast<Mask16>(inner_[rings_ - 1][patch][cover] &
                               ~static_cast<unsigned>(spoiled_[patch][cover]));
  }
  // Calls take(a, b) for all pairs of triangles within two rings of each other that are not settled, in a fixed
  // order.
  template <class Take>
  void for_each_unsettled_pair(const Take& take) const {
    for (const TriangleId a : unsettled_)
      for (const TriangleId b : near(a))
        if (is_unsettled_[+b]) take(a, b);
  }

  // Clusters of the first cover have changed.
  void forget_clusters() { known_ = false; }

 private:
  using Masks = std::vector<std::array<Mask16, kCovers>>;  // [patches][covers]
  void find_inner();
  void shrink(const Masks& from, Masks& to) const;
  void find_near();
  void find_unsettled();
  // The triangles within two rings that have a larger number.
  std::span<const TriangleId> near(TriangleId a) const {
    const auto first = static_cast<std::size_t>(near_offset_[+a]);
    return std::span(near_).subspan(first, static_cast<std::size_t>(near_offset_[+a + 1]) - first);
  }

  const TriangleMesh& mesh_;
  const PatchTree& tree_;
  std::size_t covers_ = 0, rings_ = 1;
  bool known_ = false;                  // whether inner_ is that of the clusters
  std::array<Masks, kRings> inner_;     // triangles with so many rings inside their cluster
  Masks spoiled_;                       // triangles that are not tall, or have such in a ring
  Masks fresh_, next_;                  // those of the last ring, and of the next one
  std::vector<std::int32_t> front_, next_front_;  // the patches of these
  std::vector<std::int32_t> near_offset_;         // [triangles + 1]
  std::vector<TriangleId> near_;
  std::vector<std::uint8_t> is_unsettled_;  // [triangles]
  std::vector<TriangleId> unsettled_;
};

}  // namespace cscd::fast
