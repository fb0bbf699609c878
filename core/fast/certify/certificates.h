#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include "core/detect/counts.h"
#include "core/detect/radial_view.h"
#include "core/fast/certify/tall_rings.h"
#include "core/fast/classify/patch_lanes.h"
#include "core/fast/contour/capped_clusters.h"

namespace cscd::fast {

// What the covers certify in one interval. In the first cover, each triangle is certified by itself: whether
// it is positive, or negative, towards the observer of its cluster. In every other cover a triangle is
// certified only if all triangles round its corners belong to its cluster and all of them are positive, or
// all are negative.
//
// Two triangles that one cover certifies with one sign need not be held against each other. Why several
// covers may do this together, and why the rule for the first cover may be weaker, is the second theorem of
// core/soundness.md (rule one-field). With capped clusters none of this is needed: those keep all contacts
// (capped_clusters.h).
class Certificates {
 public:
  // With `capped`, one for each cover, no contact is lost whatever the start (use_contour_test). Without, the
  // first contact of an embedded start is kept. `tree` and `covers` must outlive the certificates.
  Certificates(const TriangleMesh& mesh, const PatchTree& tree, const Covers& covers,
               std::vector<CappedClusters> capped = {});

  // Chooses what certifies triangles from the next interval on. With `all`, that is the contour test of
  // capped clusters, which keeps all contacts; the capped clusters must have been given to the constructor.
  // Without `all`, signs alone certify. Certificates begin with the contour test where capped clusters were
  // given.
  void use_contour_test(bool all);
  // Looks from the first `count` covers alone, at least one, from the next interval on.
  void use_covers(std::size_t count);
  // The number of orientation passes in an interval. A pass is the orientation of one patch's triangles
  // towards the observer of one cover.
  std::size_t orientation_passes() const;

  // The next four are called between two intervals, after whoever owns the first cover and the tree has
  // changed them (adaptive_cover.h).
  //
  // Takes over how many clusters the first cover has.
  void resize_first_cover();
  // Takes over the clusters of patches [first, last) of the tree, and forgets what was certified of them.
  void relabel(std::size_t first, std::size_t last);
  // Rebuilds the capped cluster of one cluster of the first cover, after the triangles or the observer of
  // that cluster have changed (CappedClusters::set_cluster). Does nothing where no capped clusters were
  // given.
  void set_cluster(std::size_t cluster, CapBuilder& builder, const TriangleMesh& mesh,
                   std::span<const TriangleId> triangles, std::span<const TriangleId> targets,
                   std::span<const Vec3> positions);
  // Gives the last cluster of the first cover the number of another one.
  void rename_last(std::size_t cluster) {
    if (!capped_.empty()) capped_[0].rename_last(cluster);
  }

  // An interval is one call of `start`, then one call of `classify` for every patch, in any order and from
  // any thread, then one call of `finish`. With a thickness above 0, in local units, what is certified stays
  // farther apart than that.
  void start(const LocalPositions& positions, const ThreadPool& pool = ThreadPool(), float thickness = 0);
  void classify(std::size_t patch, const PatchLanes& lanes);
  void finish(const ThreadPool& pool = ThreadPool());

  // With a thickness, signs say nothing of pairs that are near on the surface (tall_rings.h). Calls
  // take(triangle, triangle) for those among them that nothing else settles.
  template <class Take>
  void for_each_unsettled_pair(const Take& take) const {
    if (thickness_ > 0 && !keeps_all_ && positions_->known()) rings_.for_each_unsettled_pair(take);
  }

  // Whether no triangle below node `a` has to be held against a triangle below node `b`; for a == b, whether
  // no pair below the node has to be.
  bool skip(std::size_t a, std::size_t b) const {
    const Label one = label_[a], other = label_[b];
    const Label both =
        ((one ^ other) >> one_is_enough_ == 0) & (one != kNone) & ((one & other & one_is_enough_) == 0);
    const auto any = reinterpret_cast<Halves>(both);
    return (any[0] | any[1]) != 0;
  }
  // Sets of triangles of two patches p and q. No triangle of p in one of the sets has to be held against a
  // triangle of q in the same set.
  struct Shared {
    std::array<Mask16, 2 * kCovers> p, q;
    Mask16 lanes_q;  // all triangles of q

    // Returns the triangles of patch q that have to be held against triangle `lane` of patch p.
    Mask16 needed(std::size_t lane) const {
      unsigned dropped = 0;
      for (std::size_t s = 0; s < p.size(); ++s) dropped |= p[s] >> lane & 1 ? q[s] : 0U;
      return static_cast<Mask16>(lanes_q & ~dropped);
    }
    // Returns the sets with p and q exchanged; `lanes_p` are all triangles of p.
    Shared swapped(Mask16 lanes_p) const { return {q, p, lanes_p}; }
  };
  Shared shared(std::size_t p, std::size_t q) const {
    Shared sets{{}, {}, patch_[q].lanes};
    for (std::size_t c = 0; c < kCovers; ++c)
      if (patch_[p].cluster[c] == patch_[q].cluster[c] && patch_[p].cluster[c] != kNone && keeps_all_) {
        // One clear triangle of the two is enough.
        sets.p[2 * c] = certified_[p][c].positive, sets.q[2 * c] = patch_[q].lanes;
        sets.p[2 * c + 1] = patch_[p].lanes, sets.q[2 * c + 1] = certified_[q][c].positive;
      } else if (patch_[p].cluster[c] == patch_[q].cluster[c]) {
        const Signs &a = certified_[p][c], &b = certified_[q][c];
        sets.p[2 * c] = a.positive, sets.p[2 * c + 1] = a.negative;
        sets.q[2 * c] = b.positive, sets.q[2 * c + 1] = b.negative;
      }
    return sets;
  }
  // Visits the patches with triangles that no cover certified in the last interval, or that the first cover
  // alone certified, as negative.
  template <class Take>  // (patch, triangles without a certificate, those negative triangles)
  void for_each_uncertified(const Take& take) const {
    for_each_unusual([&](std::size_t p) {
      unsigned some = 0;
      for (const Signs& signs : certified_[p]) some |= signs.positive | signs.negative;
      unsigned negative = certified_[p][0].negative;
      for (std::size_t c = 1; c < kCovers; ++c)
        negative &= ~static_cast<unsigned>(certified_[p][c].positive | certified_[p][c].negative);
      if (const unsigned rest = patch_[p].lanes & ~some; (rest | negative) != 0)
        take(p, static_cast<Mask16>(rest), static_cast<Mask16>(negative));
    });
  }
  // The numbers of triangles that the first cover certifies, and of those that no cover certifies.
  const RadialCounts& counts() const { return counts_; }
  // How the covers in use saw the surface; who is positive is said of the first cover alone.
  RadialView view() const;

 private:
  // What is known of everything below a node, in each cover, with all covers in one register: twice the
  // cluster for positive triangles and one more for negative ones, or kNone. With capped clusters it is twice
  // the cluster for triangles that are all clear, one more for others of that cluster.
  using Label = std::int32_t __attribute__((vector_size(16)));
  using Halves = std::int64_t __attribute__((vector_size(16)));
  static_assert(kCovers <= sizeof(Label) / sizeof(std::int32_t));

  std::vector<RadialView::Observer> observers(std::size_t cover) const;
  void place_viewpoints(std::span<const LocalPositions::Record> records);
  void forget();
  void make_usual(std::size_t patch);
  void certify_all_round();
  void certify_by_rings(std::size_t patch);
  Mask16 positive(std::size_t patch, std::size_t cover) const;
  void certify_clear(const ThreadPool& pool);
  void take_all(std::size_t cover);
  void certify_clear(std::size_t patch);
  void label_nodes(const ThreadPool& pool);
  void classify_at_distance(std::size_t patch, const PatchLanes& lanes,
                            const Viewpoint* const (&from)[kCovers], Signs (&seen)[kCovers]);
  void keep_clear_one_rings();

  // What is known of a patch. Nearly all stay `usual` from one interval to the next: every cover sees all of
  // the patch as positive, and what was certified of it before still holds.
  enum class State : std::uint8_t {
    usual,
    unlabelled,  // became usual again; its label is still that of the last interval
    spoiled,     // all positive by itself, but not certified because of triangles around it
    seen         // not all positive by itself
  };
  static constexpr std::size_t kTogether = sizeof(std::uint64_t);  // states that are looked at together
  template <class Take>                                            // (patch)
  void for_each_unusual(const Take& take) const {
    for (std::size_t first = 0; first < state_.size(); first += kTogether) {
      std::uint64_t states = 0;
      std::memcpy(&states, &state_[first], sizeof states);
      if (states == 0) continue;
      for (std::size_t p = first; p < first + kTogether; ++p)
        if (state_[p] != State::usual) take(p);
    }
  }

  struct PatchRecord {  // [patches]: what is needed of every patch, side by side in memory
    std::array<std::int32_t, kCovers> cluster;
    std::array<Mask16, kCovers> inside;
    Mask16 lanes;
  };

  struct SingleTriangleSigns {  // signs of triangles by themselves; empty for a patch that is all positive
    Mask16 not_positive, negative;
  };

  const PatchTree& tree_;
  const Covers& covers_;
  std::size_t covers_used_ = 0;
  const LocalPositions* positions_ = nullptr;
  std::vector<PatchRecord> patch_;
  std::array<std::vector<Viewpoint>, kCovers> viewpoint_;
  std::vector<std::array<Signs, kCovers>> certified_;                            // of each patch
  std::vector<std::array<SingleTriangleSigns, kCovers>> single_triangle_signs_;  // of each patch
  std::vector<State> state_;        // [patches], padded with usual ones to a whole word
  std::vector<Label> label_;        // of each node
  bool keeps_all_ = false;          // by capped clusters
  std::int32_t one_is_enough_ = 0;  // 1 by capped clusters: one clear triangle of two is enough
  std::vector<CappedClusters> capped_;
  std::vector<std::uint8_t>
      may_cross_ray_;  // [patches]: the covers whose ray the patch may cross, a bit each
  RadialCounts counts_;
  float thickness_ = 0;  // in local units
  TallRings rings_;      // looked at only with a thickness
};

}  // namespace cscd::fast
