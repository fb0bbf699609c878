#include "core/fast/certify/tall_rings.h"

namespace cscd::fast {

void TallRings::start(std::size_t covers) {
  if (known_ && covers == covers_) return;
  covers_ = covers;
  find_inner();
  known_ = true;
  pairs_known_ = false;
}

// The rings that lie inside clusters, whatever an interval says. A vertex at an edge that has not two
// triangles has no closed fan, and no triangle at such a vertex has a first ring.
void TallRings::find_inner() {
  std::vector<std::uint8_t> open(mesh_.vertex_count());
  for (std::size_t e = 0; e < mesh_.edge_count(); ++e) {
    const EdgeId edge{static_cast<std::int32_t>(e)};
    if (mesh_.triangles_at(edge).size() != 2)
      for (const VertexId v : mesh_.ends(edge)) open[+v] = 1;
  }
  Masks all(tree_.patches.size());
  for (std::size_t p = 0; p < all.size(); ++p) {
    const Patch& patch = tree_.patches[p];
    Mask16 closed = 0;
    for_each_lane(patch.lanes, [&](std::size_t lane) {
      bool any_open = false;
      for (const Places16& corner : patch.corner)
        any_open |= open[static_cast<std::size_t>(patch.vertex[corner[lane]])] != 0;
      if (!any_open) closed |= static_cast<Mask16>(1U << lane);
    });
    for (std::size_t c = 0; c < covers_; ++c) all[p][c] = patch.cluster[c] == kNone ? Mask16{0} : closed;
  }
  shrink(all, inner_[0]);
  shrink(inner_[0], inner_[1]);
  spoiled_.assign(all.size(), {});
  fresh_.assign(all.size(), {});
  next_.assign(all.size(), {});
}

// Keeps the triangles that share vertices only with triangles of their cluster that are in `from` too.
void TallRings::shrink(const Masks& from, Masks& to) const {
  to.assign(from.size(), {});
  for (std::size_t p = 0; p < from.size(); ++p) {
    const Patch& patch = tree_.patches[p];
    std::array<Mask16, kCovers> bad{};  // places of vertices
    const SharedVertices* own = nullptr;
    tree_.for_each_adjacent(p, [&](std::size_t q, const SharedVertices& common) {
      if (q == p) own = &common;
      const Patch& other = tree_.patches[q];
      for (std::size_t c = 0; c < covers_; ++c) {
        const unsigned kept = other.cluster[c] == patch.cluster[c] ? from[q][c] : 0U;
        bad[c] |= common.places(static_cast<Mask16>(other.lanes & ~kept));
      }
    });
    for (std::size_t c = 0; c < covers_; ++c)
      to[p][c] = static_cast<Mask16>(from[p][c] & ~static_cast<unsigned>(own->lanes(bad[c])));
  }
}

// What lies outside of clusters does not spread: the rings of those beside it end there anyway.
void TallRings::begin_spread() {
  for (const std::int32_t p : front_) fresh_[static_cast<std::size_t>(p)] = {};
  front_.clear();
  for (std::size_t p = 0; p < spoiled_.size(); ++p) {
    const Patch& patch = tree_.patches[p];
    unsigned any = 0;
    for (std::size_t c = 0; c < covers_; ++c) {
      if (patch.cluster[c] == kNone) continue;
      fresh_[p][c] = spoiled_[p][c];
      any |= spoiled_[p][c];
    }
    if (any != 0) front_.push_back(static_cast<std::int32_t>(p));
  }
  spread_over_ = front_;
}

void TallRings::spread_ring() {
  next_front_.clear();
  for (const std::int32_t at : front_) {
    const auto p = static_cast<std::size_t>(at);
    std::array<Mask16, kCovers> corners{};
    for (std::size_t c = 0; c < covers_; ++c) corners[c] = tree_.patches[p].corners_of(fresh_[p][c]);
    fresh_[p] = {};
    tree_.for_each_adjacent(p, [&](std::size_t q, const SharedVertices& common) {
      unsigned before = 0, any = 0;
      for (std::size_t c = 0; c < covers_; ++c) {
        const auto more = static_cast<Mask16>(common.lanes(corners[c]) &
                                              ~static_cast<unsigned>(spoiled_[q][c] | next_[q][c]));
        before |= next_[q][c];
        next_[q][c] |= more;
        any |= more;
      }
      if (before == 0 && any != 0) next_front_.push_back(static_cast<std::int32_t>(q));
    });
  }
  for (const std::int32_t at : next_front_) {
    const auto q = static_cast<std::size_t>(at);
    for (std::size_t c = 0; c < covers_; ++c) spoiled_[q][c] |= next_[q][c];
    fresh_[q] = next_[q];
    next_[q] = {};
  }
  front_.swap(next_front_);
  spread_over_.insert(spread_over_.end(), front_.begin(), front_.end());
}

void TallRings::find_one_rings() {
  begin_spread();
  spread_ring();
}

void TallRings::find_unsettled() {
  if (!pairs_known_) find_never_settled();
  pairs_known_ = true;
  for (const TriangleId t : touched_) rings_of_[+t] = inner_rings_[+t];
  touched_.clear();
  begin_spread();
  spread_ring();
  clear_rings(0);
  spread_ring();
  clear_rings(kSecondRing);
}

// Takes one of the two rings from all triangles that the spread has reached.
void TallRings::clear_rings(unsigned ring) {
  for (const std::int32_t at : spread_over_) {
    const auto p = static_cast<std::size_t>(at);
    for (std::size_t c = 0; c < covers_; ++c)
      for_each_lane(spoiled_[p][c], [&](std::size_t lane) {
        const TriangleId t = tree_.triangles[p][lane];
        const auto less = static_cast<RingBits>(rings_of_[+t] & ~(1U << (ring + c)));
        if (rings_of_[+t] == inner_rings_[+t] && less != rings_of_[+t]) touched_.push_back(t);
        rings_of_[+t] = less;
      });
  }
}

void TallRings::find_never_settled() {
  if (!near_) near_.emplace(mesh_);
  inner_rings_.assign(mesh_.triangle_count(), 0);
  for (std::size_t p = 0; p < tree_.patches.size(); ++p)
    for (std::size_t c = 0; c < covers_; ++c)
      for (std::size_t ring = 0; ring < 2; ++ring)
        for_each_lane(inner_[ring][p][c], [&](std::size_t lane) {
          inner_rings_[+tree_.triangles[p][lane]] |= static_cast<RingBits>(1U << (ring * kSecondRing + c));
        });
  rings_of_ = inner_rings_;
  touched_.clear();
  never_settled_.clear();
  for (std::size_t t = 0; t < inner_rings_.size(); ++t) {
    const TriangleId a{static_cast<std::int32_t>(t)};
    for (const TriangleId b : near_->of(a))
      if (t < +b && !settled(inner_rings_[t], inner_rings_[+b])) never_settled_.emplace_back(a, b);
  }
}

}  // namespace cscd::fast
