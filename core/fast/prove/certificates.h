#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/detect/counts.h"
#include "core/detect/radial_view.h"
#include "core/fast/keep_all/capped_clusters.h"
#include "core/fast/look/patch_lanes.h"

namespace cscd::fast {

// What radial views certify in one interval: of every triangle, whether it is positive, or negative, towards
// the observer of its cluster in the first cover; and of every other cover, whether all triangles at its
// corners belong to its cluster there and all are positive, or all negative.
//
// Two triangles that one cover certifies with one sign need not be looked at. The theorem (soundness
// contract) asks that one field certifies everything incident to a feature pair that is dropped. A feature
// is here the least vertex, edge or triangle that holds the point where the two touch, so that a vertex may
// meet a vertex. A pair of features that touches is dropped only if all pairs of triangles at one and at the
// other are, and those by covers alone, as bounds, stars and planes drop none that carries a contact. If
// another cover than the first drops one of them, it certifies all around the corners of both, and so all
// that is at either feature. If none does, the first drops all of them: any triangle at one feature lies in
// one cluster with any at the other, and has its sign. (One triangle at both has no area when they touch:
// it has no sign, so its pairs with the others are not dropped.) Between two covers neither of which looks at
// what surrounds a triangle that would not hold: each might drop some of the pairs (rule one-field). With
// capped clusters none of this is needed (capped_clusters.h).
class Certificates {
 public:
  // With `capped`, one of each cover, no contact is lost whatever the start; without, the first of an
  // embedded start is kept.
  Certificates(const PatchTree& tree, const Covers& covers, std::vector<CappedClusters> capped = {});

  // From the next interval on looks at the first `count` covers alone, at least one.
  void use_covers(std::size_t count);
  // How often a patch is looked at in an interval, from one cover each.
  std::size_t looks_per_interval() const;

  // One interval: `start`, then `look` at every patch, in any order and from any thread, then `finish`.
  void start(const LocalPositions& positions);
  void look(std::size_t patch, const PatchLanes& lanes);
  void finish();

  // Whether no pair of triangles, one below each node, has to be looked at; a == b: no pair below the node.
  bool skip(std::size_t a, std::size_t b) const {
    const Label both = (label_[a] == label_[b]) & (label_[a] != kNone);
    const auto any = reinterpret_cast<Halves>(both);
    return (any[0] | any[1]) != 0;
  }
  // What certifies triangles of two patches: no triangle of p in one of these sets has to be held against one
  // of q in the same set.
  struct Shared {
    std::array<Mask16, 2 * kCovers> p, q;
    Mask16 lanes_q;

    // Triangles of patch q that have to be held against triangle `lane` of patch p.
    Mask16 needed(std::size_t lane) const {
      unsigned dropped = 0;
      for (std::size_t s = 0; s < p.size(); ++s) dropped |= p[s] >> lane & 1 ? q[s] : 0U;
      return static_cast<Mask16>(lanes_q & ~dropped);
    }
    // The same of the patches in turn; `lanes_p`: all triangles of p.
    Shared turned(Mask16 lanes_p) const { return {q, p, lanes_p}; }
  };
  Shared shared(std::size_t p, std::size_t q) const {
    Shared sets{{}, {}, cell_[q].lanes};
    for (std::size_t c = 0; c < kCovers; ++c)
      if (cell_[p].cluster[c] == cell_[q].cluster[c] && cell_[p].cluster[c] != kNone && !capped_.empty()) {
        // One of both is enough.
        sets.p[2 * c] = certified_[p][c].positive, sets.q[2 * c] = cell_[q].lanes;
        sets.p[2 * c + 1] = cell_[p].lanes, sets.q[2 * c + 1] = certified_[q][c].positive;
      } else if (cell_[p].cluster[c] == cell_[q].cluster[c]) {
        const Signs &a = certified_[p][c], &b = certified_[q][c];
        sets.p[2 * c] = a.positive, sets.p[2 * c + 1] = a.negative;
        sets.q[2 * c] = b.positive, sets.q[2 * c + 1] = b.negative;
      }
    return sets;
  }
  // Triangles certified by the first cover, and those that no cover certifies.
  const RadialCounts& counts() const { return counts_; }
  // The first cover.
  RadialView view() const;

 private:
  // Cluster and sign of all below a node in each cover, or kNone. All covers in one register.
  using Label = std::int32_t __attribute__((vector_size(16)));
  using Halves = std::int64_t __attribute__((vector_size(16)));
  static_assert(kCovers <= sizeof(Label) / sizeof(std::int32_t));

  void place_viewpoints(std::span<const LocalPositions::Record> records);
  void forget();
  void make_usual(std::size_t patch);
  void certify_all_round();
  void look_round(std::size_t patch);
  void certify_clear();
  void label_nodes();

  // Most patches are all positive in every cover, from one interval to the next. What is known of them stays.
  enum class State : std::uint8_t {
    usual,
    unlabelled,  // is usual again
    spoiled,     // by what is around it
    seen         // by itself it is not all positive
  };
  template <class Take>  // (patch)
  void for_each_unusual(const Take& take) const;

  struct Cell {  // of a patch: what is needed of all of them, together
    std::array<std::int32_t, kCovers> cluster;
    std::array<Mask16, kCovers> inside;
    Mask16 lanes;
  };

  struct SingleTriangleSigns {  // of triangles by themselves; none where the patch was not seen otherwise
    Mask16 not_positive, negative;
  };

  const PatchTree& tree_;
  const Covers& covers_;
  std::size_t covers_used_ = 0;
  const LocalPositions* positions_ = nullptr;
  std::vector<Cell> cell_;
  std::array<std::vector<Viewpoint>, kCovers> viewpoint_;
  std::vector<std::array<Signs, kCovers>> certified_;                            // of each patch
  std::vector<std::array<SingleTriangleSigns, kCovers>> single_triangle_signs_;  // of each patch
  std::vector<State> state_;  // of each patch; then usual ones up to a whole word
  std::vector<Label> label_;  // of each node
  std::vector<CappedClusters> capped_;
  std::vector<std::array<bool, kCovers>> crosses_ray_;  // of each patch: whether it may
  RadialCounts counts_;
};

}  // namespace cscd::fast
