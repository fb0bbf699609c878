#include "core/fast/patch_descent.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace cscd::fast {

PatchDescent::PatchDescent(const DescentInput& input)
    : input_(input),
      nodes_(input.tree.nodes),
      patches_(input.tree.patches),
      one_ring_(input.positions.records().size()),
      triangle_bounds_(input.tree.patches.size()) {}

void PatchDescent::start_interval(std::span<const NodeBounds> bounds, const Grid& grid, std::uint64_t most) {
  bounds_ = bounds;
  most_tests_ = most;
  grid_ = grid;
  tests_ = 0;
  patch_pairs_ = {};
  triangle_bounds_.start_interval();
  std::fill(one_ring_.begin(), one_ring_.end(), OneRing::unknown);
}

void PatchDescent::descend(NodePair at, TrianglePairSink& sink) {
  sink_ = &sink;
  visit<Depth::all>(at);
  ask_planes();
  ask_edges();
}

void PatchDescent::split(NodePair at, std::vector<NodePair>& below) {
  split_into_ = &below;
  visit<Depth::one>(at);
}

// Descends into a pair of nodes. Two different nodes have been tested against each other already, and are
// near.
template <PatchDescent::Depth kDepth>
void PatchDescent::visit(NodePair at) {
  const auto [a, b] = at;
  if (tests_ > most_tests_) return;
  if (a == b) return visit_self<kDepth>(a);
  const PatchTree::Node first = nodes_[a], second = nodes_[b];
  if (!first.is_leaf() && !second.is_leaf()) return step<kDepth, 2, 2>(first.left(), second.left());
  if (!first.is_leaf()) return step<kDepth, 2, 1>(first.left(), b);
  if (!second.is_leaf()) return step<kDepth, 1, 2>(a, second.left());
  between(a, b);
}

template <PatchDescent::Depth kDepth>
void PatchDescent::visit_self(std::size_t n) {
  if (input_.certificates.skip(n, n)) return;
  const PatchTree::Node node = nodes_[n];
  if (node.is_leaf()) return inside(node.patch());
  found<kDepth>({node.left(), node.left()});
  found<kDepth>({node.right(), node.right()});
  step<kDepth, 1, 1>(node.left(), node.right());
}

// Descends from one node or two siblings against one node or two siblings. All pairs are tested before any is
// descended into.
template <PatchDescent::Depth kDepth, std::size_t kA, std::size_t kB>
void PatchDescent::step(std::size_t a, std::size_t b) {
  unsigned open = 0;
  for (std::size_t i = 0; i < kA; ++i)
    for (std::size_t j = 0; j < kB; ++j) {
      const bool asked = !input_.certificates.skip(a + i, b + j);
      tests_ += asked;
      open |= static_cast<unsigned>(asked & !apart(bounds_[a + i], bounds_[b + j])) << (i * kB + j);
    }
  for_each_lane(open, [&](std::size_t k) { found<kDepth>({a + k / kB, b + k % kB}); });
}

template <PatchDescent::Depth kDepth>
void PatchDescent::found(NodePair below) {
  if constexpr (kDepth == Depth::all)
    visit<kDepth>(below);
  else
    split_into_->push_back(below);
}

// Passes on pairs of triangles inside one patch.
inline void PatchDescent::inside(std::size_t p) {
  if (sink_->closed()) return;
  const Certificates::Shared shared = input_.certificates.shared(p, p);
  const SharedVertices* common = input_.tree.common_of(p, p);
  const Mask16 lanes = patches_[p].lanes;
  for (std::size_t lane = 0; lanes >> lane > 1; ++lane)
    row(p, lane, p, static_cast<Mask16>(shared.needed(lane) & ~((2U << lane) - 1)), common);
}

// Passes on pairs between the patches of two leaves. Only triangles that meet the bounds of the other patch
// are held against each other.
inline void PatchDescent::between(std::size_t a, std::size_t b) {
  if (sink_->closed()) return;
  ++patch_pairs_.all;
  patch_pairs_.at_start += !apart_at_start(bounds_[a], bounds_[b]);
  std::size_t p = nodes_[a].patch(), q = nodes_[b].patch();
  Certificates::Shared shared = input_.certificates.shared(p, q);
  Mask16 rows = patches_[p].lanes, columns = patches_[q].lanes;
  for (std::size_t s = 0; s < shared.p.size();
       ++s) {  // triangles that every triangle of the other patch drops
    if (shared.q[s] == patches_[q].lanes) rows &= static_cast<Mask16>(~shared.p[s]);
    if (shared.p[s] == patches_[p].lanes) columns &= static_cast<Mask16>(~shared.q[s]);
  }
  if (rows == 0 || columns == 0) return;
  // Drop the triangles that lie apart from the bounds of the other patch.
  rows = near_counted(bounds_of_triangles(p), rows, bounds_[b]);
  if (rows == 0) return;
  columns = near_counted(bounds_of_triangles(q), columns, bounds_[a]);
  if (columns == 0) return;
  if (std::popcount(columns) < std::popcount(rows)) {  // the side with fewer triangles makes less work
    std::swap(p, q), std::swap(rows, columns);
    shared = shared.swapped(patches_[q].lanes);
  }
  const SharedVertices* common = input_.tree.common_of(p, q);
  for_each_lane(rows, [&](std::size_t lane) {
    row(p, lane, q, static_cast<Mask16>(shared.needed(lane) & columns), common);
  });
}

// Holds one triangle of patch p against some of patch q.
inline void PatchDescent::row(std::size_t p, std::size_t lane, std::size_t q, Mask16 wanted,
                              const SharedVertices* common) {
  if (wanted == 0) return;
  Mask16 left = 0;
  if (common != nullptr) {
    wanted = not_flat(p, lane, wanted, *common);
    left = static_cast<Mask16>(wanted &
                               common->beside(patches_[p], lane));  // bounds of neighbours always overlap
    wanted &= static_cast<Mask16>(~left);
  }
  if (wanted != 0) {
    tests_ += static_cast<unsigned>(std::popcount(wanted));
    left |= near_triangle(q, wanted, p, lane);
  }
  if (left != 0) pass_on(p, lane, q, left);
}

// Removes the triangles that the one-ring of a common corner proves apart.
inline Mask16 PatchDescent::not_flat(std::size_t p, std::size_t lane, Mask16 wanted,
                                     const SharedVertices& common) {
  if (input_.one_rings == nullptr) return wanted;
  const Patch& patch = patches_[p];
  for (const Places16& place : patch.corner) {
    const Mask16 sharing = common.at[place[lane]];
    if ((wanted & sharing) != 0 && flat(VertexId{patch.vertex[place[lane]]}))
      wanted &= static_cast<Mask16>(~sharing);
  }
  return wanted;
}

// Keeps pairs of one triangle of patch p and some of patch q until there are sixteen. This happens rarely, so
// it is not inlined into the caller.
[[gnu::noinline]] void PatchDescent::pass_on(std::size_t p, std::size_t lane, std::size_t q, Mask16 lanes) {
  const Patch &first = patches_[p], &second = patches_[q];
  for_each_lane(lanes, [&](std::size_t other) {
    Waiting& to = for_planes_;
    for (std::size_t k = 0; k < 3; ++k) {
      to.vertices.first[k][to.count] = first.vertex[first.corner[k][lane]];
      to.vertices.second[k][to.count] = second.vertex[second.corner[k][other]];
    }
    to.pairs[to.count++] = {input_.tree.triangles[p][lane], input_.tree.triangles[q][other]};
    if (to.count == kLanes16) ask_planes();
  });
}

// Keeps the waiting pairs that no triangle's plane parts, in the order in which they were found.
void PatchDescent::ask_planes() {
  Waiting &from = for_planes_, &to = for_edges_;
  unsigned left = (1U << from.count) - 1;
  from.count = 0;
  const bool asks = input_.planes && input_.positions.known() && !grid_.has_margin();
  if (left != 0 && asks)
    left &= not_parted(input_.positions.records(), from.vertices, input_.positions.error());
  for_each_lane(left, [&](std::size_t l) {
    if (!asks) return sink_->add(from.pairs[l].a, from.pairs[l].b);
    for (std::size_t k = 0; k < 3; ++k) {
      to.vertices.first[k][to.count] = from.vertices.first[k][l];
      to.vertices.second[k][to.count] = from.vertices.second[k][l];
    }
    to.pairs[to.count++] = from.pairs[l];
    if (to.count == kLanes16) ask_edges();
  });
}

// Passes on the waiting pairs that no plane parallel to an edge of each triangle parts, in the same order.
void PatchDescent::ask_edges() {
  unsigned left = (1U << for_edges_.count) - 1;
  for_edges_.count = 0;
  if (left == 0) return;
  left &= not_parted_by_edges(input_.positions.records(), for_edges_.vertices, input_.positions.error());
  for_each_lane(left, [&](std::size_t l) { sink_->add(for_edges_.pairs[l].a, for_edges_.pairs[l].b); });
}

inline Mask16 PatchDescent::near_counted(const TriangleBounds& triangles, Mask16 mask,
                                         const NodeBounds& other) {
  if (!input_.positions.known()) return mask;
  tests_ += static_cast<unsigned>(std::popcount(mask));
  return near(triangles, mask, other);
}

// Returns the triangles of patch q that are not proven apart from triangle `lane` of patch p.
inline Mask16 PatchDescent::near_triangle(std::size_t q, Mask16 wanted, std::size_t p, std::size_t lane) {
  if (!input_.positions.known()) return wanted;
  // Both are held, or one of them was computed last, because the caller has just asked for both. So to
  // compute the other evicts neither.
  const TriangleBounds& triangles = bounds_of_triangles(q);
  return near(triangles, wanted, bounds_of_triangles(p), lane);
}

const TriangleBounds& PatchDescent::bounds_of_triangles(std::size_t p) {
  return triangle_bounds_.of(p, [&] {
    const TriangleBounds bounds =
        grid_.bounds_of_triangles(load(input_.positions.records(), patches_[p].vertex), patches_[p]);
    return input_.time_linear ? bounds : swept(bounds);
  });
}

inline bool PatchDescent::flat(VertexId vertex) {
  OneRing& one_ring = one_ring_[+vertex];
  if (one_ring == OneRing::unknown)
    one_ring = input_.one_rings->flat(vertex, input_.positions, grid_.distance()) ? OneRing::flat
                                                                                  : OneRing::uncertain;
  return one_ring == OneRing::flat;
}

}  // namespace cscd::fast
