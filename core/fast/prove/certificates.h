#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/detect/counts.h"
#include "core/detect/radial_view.h"
#include "core/fast/keep_all/capped_clusters.h"
#include "core/fast/look/patch_lanes.h"

namespace cscd::fast {

// The certificates of one interval: for every triangle and every cover, whether the radial view from that
// cover certifies the triangle, and with which sign.
//
// A *look* classifies the triangles of one patch towards the observer of the patch's cluster in one cover:
// each triangle is positive at every t, negative at every t, or neither for certain.
//
// - The first cover certifies a triangle with a sign if the triangle itself has that sign.
// - Any other cover certifies a triangle with a sign if all triangles round its corners, itself among them,
//   belong to its cluster there and have that sign.
//
// A pair of triangles is dropped if both lie in one cluster of one cover, and that cover certifies both with
// the same sign.
//
// Why the first contact is kept (rule one-field, core/soundness.md): a feature pair may be dropped only if
// one field certifies all triangles at both of its features. Here a feature is the smallest vertex, edge or
// triangle that holds the point of contact, so a vertex may touch a vertex. Let two features touch, and let
// every pair of triangles be dropped that has one triangle at the first feature and one at the second.
// Bounds, stars and planes drop no pair that carries a contact, so the covers have dropped all of these
// pairs.
//
// If a cover other than the first drops one of the pairs, that cover certifies all triangles round the
// corners of both triangles, and so all triangles at either feature. That is one field for all of them.
//
// Otherwise the first cover drops all of the pairs. Then every triangle at the first feature lies in one
// cluster with every triangle at the second feature, and has the same sign. That again is one field for all.
// (A triangle that is at both features has no area when they touch. It has no sign, so the pairs that contain
// it are not dropped.)
//
// Only one cover may certify triangles by themselves. If two covers did, each of them might drop some of the
// pairs, and no field would certify all triangles.
//
// With capped clusters none of this is needed: there a triangle is certified if it is clear
// (keep_all/capped_clusters.h), and a pair of triangles of one cluster is dropped if one of them is
// certified.
class Certificates {
 public:
  // With `capped`, one entry a cover, every contact is kept from any start. Without, the first contact is
  // kept from an embedded start (rule embedded-start, core/soundness.md). Tree and covers must outlive the
  // certificates. The first cover must hold every triangle.
  Certificates(const PatchTree& tree, const Covers& covers, std::vector<CappedClusters> capped = {});

  // From the next interval on, looks from the first `count` covers alone, at least one.
  void use_covers(std::size_t count);
  // The number of looks in an interval. A patch has one look from each cover in which it belongs to a
  // cluster.
  std::size_t looks_per_interval() const;

  // One interval: call `start`, then `look` for every patch, in any order and from any thread, then `finish`.
  // `look` takes all looks at the patch; `lanes` are its positions.
  void start(const LocalPositions& positions);
  void look(std::size_t patch, const PatchLanes& lanes);
  void finish();

  // True if all pairs are dropped that have one triangle below each of two nodes. With a == b: all pairs of
  // two triangles below the node.
  bool skip(std::size_t a, std::size_t b) const {
    const Label both = (label_[a] == label_[b]) & (label_[a] != kNone);
    const auto any = reinterpret_cast<Halves>(both);
    return (any[0] | any[1]) != 0;
  }
  // The certificates that two patches p and q share, as sets of their triangles. A pair of a triangle in p[s]
  // and a triangle in q[s] is dropped, for every s.
  struct Shared {
    std::array<Mask16, 2 * kCovers> p, q;
    Mask16 lanes_q;  // all triangles of q

    // Returns the triangles of q whose pairs with triangle `lane` of p are not dropped.
    Mask16 needed(std::size_t lane) const {
      unsigned dropped = 0;
      for (std::size_t s = 0; s < p.size(); ++s) dropped |= p[s] >> lane & 1 ? q[s] : 0U;
      return static_cast<Mask16>(lanes_q & ~dropped);
    }
    // Returns the same sets with p and q exchanged. `lanes_p` are all triangles of p.
    Shared turned(Mask16 lanes_p) const { return {q, p, lanes_p}; }
  };
  Shared shared(std::size_t p, std::size_t q) const {
    Shared sets{{}, {}, cell_[q].lanes};
    for (std::size_t c = 0; c < kCovers; ++c)
      if (cell_[p].cluster[c] == cell_[q].cluster[c] && cell_[p].cluster[c] != kNone && !capped_.empty()) {
        // One clear triangle of a pair is enough.
        sets.p[2 * c] = certified_[p][c].positive, sets.q[2 * c] = cell_[q].lanes;
        sets.p[2 * c + 1] = cell_[p].lanes, sets.q[2 * c + 1] = certified_[q][c].positive;
      } else if (cell_[p].cluster[c] == cell_[q].cluster[c]) {
        const Signs &a = certified_[p][c], &b = certified_[q][c];
        sets.p[2 * c] = a.positive, sets.p[2 * c + 1] = a.negative;
        sets.q[2 * c] = b.positive, sets.q[2 * c + 1] = b.negative;
      }
    return sets;
  }
  // The numbers of triangles that the first cover certifies as positive and as negative, and the number of
  // triangles that no cover certifies.
  const RadialCounts& counts() const { return counts_; }
  // The clusters of the first cover, and the triangles that it certifies as positive.
  RadialView view() const;

 private:
  // For each cover, the cluster and sign with which it certifies all triangles below a node, as one number;
  // kNone if it does not certify all of them alike. The labels of all covers fit one register.
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

  // A patch is *usual* if all its looks find all its triangles positive, and no triangle of a patch round it
  // takes a certificate from it. Most patches are usual from one interval to the next, so their certificates
  // and labels are left as they are.
  enum class State : std::uint8_t {
    usual,       // its certificates and its label stand
    unlabelled,  // usual again in this interval: its label is still that of the last interval
    spoiled,     // its certificates are not those of a usual patch, because of a patch beside it or forget()
    seen         // a look found a triangle that is not positive; or there are capped clusters
  };
  template <class Take>  // (patch)
  void for_each_unusual(const Take& take) const;

  struct Cell {  // a copy of the few facts about a patch that are needed of all patches, close together
    std::array<std::int32_t, kCovers> cluster;
    std::array<Mask16, kCovers> inside;
    Mask16 lanes;
  };

  struct Own {  // classes of single triangles, whatever is round them; empty for a patch that is not `seen`
    Mask16 not_positive, negative;
  };

  const PatchTree& tree_;
  const Covers& covers_;
  std::size_t covers_used_ = 0;
  const LocalPositions* positions_ = nullptr;
  std::vector<Cell> cell_;
  std::array<std::vector<Viewpoint>, kCovers> viewpoint_;
  std::vector<std::array<Signs, kCovers>> certified_;   // [patches][covers]
  std::vector<std::array<Own, kCovers>> own_;           // [patches][covers]
  std::vector<State> state_;                            // [patches], filled up with `usual` to whole words
  std::vector<Label> label_;                            // [nodes]
  std::vector<CappedClusters> capped_;                  // [covers] or empty
  std::vector<std::array<bool, kCovers>> crosses_ray_;  // [patches][covers]; whether it may cross
  RadialCounts counts_;
};

}  // namespace cscd::fast
