#include "core/fast/certify/tall_rings.h"

#include <algorithm>

#include "core/mesh/adjacency.h"

namespace cscd::fast {

void TallRings::start(std::size_t covers) {
  covers_ = covers;
  if (!known_) find_inner();
  known_ = true;
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
    for (std::size_t c = 0; c < kCovers; ++c) all[p][c] = patch.cluster[c] == kNone ? Mask16{0} : closed;
  }
  shrink(all, inner_[0]);
  for (std::size_t ring = 1; ring < kRings; ++ring) shrink(inner_[ring - 1], inner_[ring]);
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
      for (std::size_t c = 0; c < kCovers; ++c) {
        const unsigned kept = other.cluster[c] == patch.cluster[c] ? from[q][c] : 0U;
        bad[c] |= common.places(static_cast<Mask16>(other.lanes & ~kept));
      }
    });
    for (std::size_t c = 0; c < kCovers; ++c)
      to[p][c] = static_cast<Mask16>(from[p][c] & ~static_cast<unsigned>(own->lanes(bad[c])));
  }
}

void TallRings::spread(std::size_t rings) {
  rings_ = rings;
  front_.clear();
  for (std::size_t p = 0; p < spoiled_.size(); ++p) {
    unsigned any = 0;
    for (std::size_t c = 0; c < kCovers; ++c) {
      if (c >= covers_ || tree_.patches[p].cluster[c] == kNone) spoiled_[p][c] = tree_.patches[p].lanes;
      // What lies outside of clusters does not spread: the rings of those beside it end there anyway.
      fresh_[p][c] = c < covers_ && tree_.patches[p].cluster[c] != kNone ? spoiled_[p][c] : Mask16{0};
      any |= fresh_[p][c];
    }
    if (any != 0) front_.push_back(static_cast<std::int32_t>(p));
  }
  for (std::size_t ring = 0; ring < rings; ++ring) {
    next_front_.clear();
    for (const std::int32_t at : front_) {
      const auto p = static_cast<std::size_t>(at);
      const Patch& patch = tree_.patches[p];
      std::array<Mask16, kCovers> corners{};
      for (std::size_t c = 0; c < covers_; ++c) corners[c] = patch.corners_of(fresh_[p][c]);
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
  }
  for (const std::int32_t at : front_) fresh_[static_cast<std::size_t>(at)] = {};
  if (rings == kRings) find_unsettled();
}

void TallRings::find_unsettled() {
  if (near_offset_.empty()) find_near();
  for (const TriangleId t : unsettled_) is_unsettled_[+t] = 0;
  unsettled_.clear();
  for (std::size_t p = 0; p < spoiled_.size(); ++p) {
    unsigned settled = 0;
    for (std::size_t c = 0; c < covers_; ++c) settled |= left(p, c);
    for_each_lane(tree_.patches[p].lanes & ~settled, [&](std::size_t lane) {
      const TriangleId t = tree_.triangles[p][lane];
      is_unsettled_[+t] = 1;
      unsettled_.push_back(t);
    });
  }
}

void TallRings::find_near() {
  const std::size_t count = mesh_.triangle_count();
  near_offset_.assign(1, 0);
  near_.clear();
  is_unsettled_.assign(count, 0);
  std::vector<std::int32_t> seen(count, -1);
  for (std::size_t t = 0; t < count; ++t) {
    const TriangleId a{static_cast<std::int32_t>(t)};
    const auto first = static_cast<std::ptrdiff_t>(near_.size());
    seen[t] = static_cast<std::int32_t>(t);
    for_each_neighbour(mesh_, a, [&](TriangleId beside) {
      const auto take = [&](TriangleId b) {
        if (seen[+b] == static_cast<std::int32_t>(t)) return;
        seen[+b] = static_cast<std::int32_t>(t);
        if (+b > t) near_.push_back(b);
      };
      take(beside);
      for_each_neighbour(mesh_, beside, take);
    });
    std::ranges::sort(near_.begin() + first, near_.end());
    near_offset_.push_back(static_cast<std::int32_t>(near_.size()));
  }
}

}  // namespace cscd::fast
