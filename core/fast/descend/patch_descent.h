#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <new>
#include <span>
#include <type_traits>
#include <vector>

#include "core/detect/culler.h"
#include "core/fast/look/grid_bounds.h"
#include "core/fast/prove/certificates.h"
#include "core/fast/prove/parting.h"
#include "core/fast/prove/stars.h"

namespace cscd::fast {

// Two nodes of a tree over patches. They stand for all pairs that have one triangle below each node. The same
// node twice stands for all pairs of two triangles below that node.
struct NodePair {
  std::size_t a, b;
};

// The data that all descents of one interval read. Several threads read them at the same time.
struct DescentInput {
  const PatchTree& tree;
  const LocalPositions& positions;
  const Certificates& certificates;
  const Stars* stars;  // null: stars prove nothing
  bool time_linear;    // bounds of triangles at both ends; false: swept bounds
  bool planes;         // whether planes may part pairs
};

// Cache of per-patch results that are computed on demand, because an interval needs them for few patches.
// Holds the results of the last 64 patches, because a descent stays near where it is. A result that is needed
// again later is computed again, which takes less time than to write and read memory that other work has
// driven from the caches.
template <class T>
class OnDemand {
  static_assert(std::is_trivially_destructible_v<T>);

 public:
  explicit OnDemand(std::size_t patches) : at_(patches, kNone), made_(kMost), patch_(kMost, kNone) {}
  void start_interval() {
    for (std::int32_t& patch : patch_) forget(patch);
  }
  // Returns the result for a patch, computed by `make` if the cache does not hold it. The reference is valid
  // until the next call that computes a result, which may evict this one.
  template <class Make>
  const T& of(std::size_t patch, const Make& make) {
    std::int32_t& at = at_[patch];
    if (at == kNone) {
      forget(patch_[next_]);
      patch_[next_] = static_cast<std::int32_t>(patch);
      at = static_cast<std::int32_t>(next_);
      ::new (&made_[next_]) T(make());  // in place, because results are large
      next_ = (next_ + 1) % kMost;
    }
    return made_[static_cast<std::size_t>(at)];
  }

 private:
  static constexpr std::size_t kMost = 64;  // fit the second-level cache; few results are computed twice

  void forget(std::int32_t& patch) {
    if (patch != kNone) at_[static_cast<std::size_t>(patch)] = kNone;
    patch = kNone;
  }

  std::vector<std::int32_t> at_;     // [patches]; index of the patch's result in `made_`, or kNone
  std::vector<T> made_;              // [kMost]
  std::vector<std::int32_t> patch_;  // [kMost]; the patch of each result, or kNone
  std::size_t next_ = 0;             // index in `made_` for the next result
};

// The descent over a tree of patches: finds the pairs of triangles that nothing proves apart. Drops pairs by
// certificates and bounds of nodes, then by bounds of triangles, by stars and by planes. Bounds of triangles
// and flatness of stars are computed when the descent first asks for them in an interval.
class alignas(64) PatchDescent {  // shares no cache line with the descent of another thread
 public:
  // Everything that `input` refers to must outlive the descent.
  explicit PatchDescent(const DescentInput& input);

  // `bounds`, [nodes], in steps of `grid`, must stay in place until the last descent of the interval.
  void start_interval(std::span<const NodeBounds> bounds, const Grid& grid);
  // Passes on those pairs of triangles, of all that the two nodes stand for, that are not proven apart.
  void descend(NodePair at, TrianglePairSink& sink);
  // True if one of the two nodes is no leaf.
  bool can_open(NodePair at) const { return !(nodes_[at.a].is_leaf() && nodes_[at.b].is_leaf()); }
  // Takes the first step of a descent from two nodes that can be opened. Appends the pairs of nodes from
  // which the descent would go on, in the order in which it would visit them.
  void open(NodePair at, std::vector<NodePair>& below);
  // The number of overlap tests of bounds in this interval so far.
  std::uint64_t tests() const { return tests_; }

 private:
  enum class Star : std::uint8_t { unknown, flat, uncertain };

  enum class Depth { one, all };

  template <Depth kDepth>
  void visit(NodePair at);
  template <Depth kDepth>
  void visit_self(std::size_t n);
  template <Depth kDepth, std::size_t kA, std::size_t kB>
  void step(std::size_t a, std::size_t b);
  template <Depth kDepth>
  void found(NodePair below);
  void inside(std::size_t p);
  void between(std::size_t a, std::size_t b);
  void row(std::size_t p, std::size_t lane, std::size_t q, Mask16 wanted, const Common* common);
  Mask16 not_flat(std::size_t p, std::size_t lane, Mask16 wanted, const Common& common);
  bool flat(VertexId vertex);
  void pass_on(std::size_t p, std::size_t lane, std::size_t q, Mask16 lanes);
  void pass_on_waiting();
  Mask16 near_counted(const TriangleBounds& triangles, Mask16 mask, const NodeBounds& other);
  Mask16 near_triangle(std::size_t q, Mask16 wanted, std::size_t p, std::size_t lane);
  const TriangleBounds& bounds_of_triangles(std::size_t p);

  const DescentInput input_;
  const std::span<const PatchTree::Node> nodes_;
  const std::span<const Patch> patches_;
  std::span<const NodeBounds> bounds_;
  Grid grid_{1};
  std::vector<Star> star_;  // [vertices]
  OnDemand<TriangleBounds> triangle_bounds_;
  TrianglePairSink* sink_ = nullptr;
  // Pairs that wait until there are sixteen, to be held against the planes of their triangles all at once.
  // The entries from `waiting_count_` on are left over from earlier pairs.
  std::array<TrianglePair, kLanes16> waiting_{};
  PairLanes waiting_vertices_;
  std::size_t waiting_count_ = 0;
  std::vector<NodePair>* opened_ = nullptr;
  std::uint64_t tests_ = 0;
};

}  // namespace cscd::fast
