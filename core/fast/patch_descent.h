#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <new>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "core/base/thread_pool.h"
#include "core/detect/culler.h"
#include "core/fast/certify/certificates.h"
#include "core/fast/certify/one_rings.h"
#include "core/fast/certify/parting.h"
#include "core/fast/classify/grid_bounds.h"

namespace cscd::fast {

// Two nodes of a tree over patches stand for all pairs of triangles with one triangle below each; one node
// given twice stands for all pairs below it.
struct NodePair {
  std::size_t a, b;
};

// What the descents of one interval read, several of them at a time.
struct DescentInput {
  const PatchTree& tree;
  const LocalPositions& positions;
  const Certificates& certificates;
  const OneRings* one_rings;  // null: without one-rings
  bool time_linear;
  // Whether planes of triangles are asked. They prove that nothing touches, so they are not asked where
  // bounds have a margin.
  bool planes;
};

// A cache of results per patch that are computed on demand, because an interval needs them for few patches.
// It holds the results of the last patches alone, as a descent stays near where it is. A patch that the
// descent meets again later is computed again, which takes less time than writing and reading memory that
// others have driven from the caches.
template <class T>
class OnDemand {
  static_assert(std::is_trivially_destructible_v<T>);

 public:
  explicit OnDemand(std::size_t patches) : at_(patches, kNone), made_(kMost), patch_(kMost, kNone) {}
  void start_interval() {
    for (std::int32_t& patch : patch_) forget(patch);
  }
  // Returns the result of a patch, and computes it with `make` if it is not held. The reference is valid
  // until the next call, which may evict it.
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
  static constexpr std::size_t kMost =
      64;  // these fit the second-level cache, and few results are computed twice

  void forget(std::int32_t& patch) {
    if (patch != kNone) at_[static_cast<std::size_t>(patch)] = kNone;
    patch = kNone;
  }

  std::vector<std::int32_t> at_;  // [patches]: where its result is held, or kNone
  std::vector<T> made_;
  std::vector<std::int32_t> patch_;  // [kMost]: the patch of each result, or kNone
  std::size_t next_ = 0;
};

// The descent over the tree of patches. It passes on the pairs of triangles that no cover certifies and that
// bounds, one-rings and planes do not prove apart. Bounds of triangles, and which one-rings are flat, are
// computed on demand.
class alignas(64) PatchDescent {  // aligned so that no cache line is shared with another thread's descent
 public:
  // Everything that `input` refers to must outlive the descent.
  explicit PatchDescent(const DescentInput& input);

  // `bounds`, [nodes] in steps of `grid`, must stay until the last descent of the interval.
  // A descent that has made more than `most` overlap tests stops, and has then passed on only some pairs.
  void start_interval(std::span<const NodeBounds> bounds, const Grid& grid, std::uint64_t most);
  // Passes on the pairs of triangles below two nodes that are not proven apart.
  void descend(NodePair at, TrianglePairSink& sink);
  // Whether one of the two nodes has children.
  bool can_split(NodePair at) const { return !(nodes_[at.a].is_leaf() && nodes_[at.b].is_leaf()); }
  // Appends the pairs of nodes into which a descent from two nodes that can be split falls apart, in the
  // order of the descent.
  void split(NodePair at, std::vector<NodePair>& below);
  // The number of overlap tests in this interval so far.
  std::uint64_t tests() const { return tests_; }
  // Pairs of patches whose triangles were held against each other, and those of them that overlap at the
  // start.
  struct PatchPairs {
    std::uint64_t all = 0, at_start = 0;
  };
  const PatchPairs& patch_pairs() const { return patch_pairs_; }
  // From here on, stops after so many overlap tests of the interval.
  void stop_after(std::uint64_t tests) { most_tests_ = tests; }

 private:
  enum class OneRing : std::uint8_t { unknown, flat, uncertain };

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
  void row(std::size_t p, std::size_t lane, std::size_t q, Mask16 wanted, const SharedVertices* common);
  Mask16 not_flat(std::size_t p, std::size_t lane, Mask16 wanted, const SharedVertices& common);
  bool flat(VertexId vertex);
  void pass_on(std::size_t p, std::size_t lane, std::size_t q, Mask16 lanes);
  void ask_planes();
  void ask_edges();
  Mask16 near_counted(const TriangleBounds& triangles, Mask16 mask, const NodeBounds& other);
  Mask16 near_triangle(std::size_t q, Mask16 wanted, std::size_t p, std::size_t lane);
  const TriangleBounds& bounds_of_triangles(std::size_t p);

  const DescentInput input_;
  const std::span<const PatchTree::Node> nodes_;
  const std::span<const Patch> patches_;
  std::span<const NodeBounds> bounds_;
  Grid grid_{1};
  std::vector<OneRing> one_ring_;  // [vertices]: what is known of its one-ring
  OnDemand<TriangleBounds> triangle_bounds_;
  TrianglePairSink* sink_ = nullptr;
  // Pairs that wait until there are sixteen to ask about together. Behind them stand pairs of earlier rounds.
  struct Waiting {
    std::array<TrianglePair, kLanes16> pairs{};
    PairLanes vertices;
    std::size_t count = 0;
  };
  Waiting for_planes_, for_edges_;  // the latter are those that no triangle's plane parts
  std::vector<NodePair>* split_into_ = nullptr;
  std::uint64_t tests_ = 0, most_tests_ = 0;
  PatchPairs patch_pairs_;
};

// A pair of triangles that is passed on to the elementary test costs about as much as so many overlap tests.
inline constexpr std::uint64_t kTestsOfPair = 40;

// The descent of one interval by a pool of threads. The descent from the root is split into pairs of nodes,
// in the order of the descent, and ranges of these are shared out. Each thread has its own scratch memory,
// and each range its own list of pairs of triangles. The lists are joined in order, so the sink sees the same
// pairs in the same order, and the counters are the same, for any number of threads.
class SharedDescent {
 public:
  // Whatever `input` refers to, and the pool, must outlive the descent.
  SharedDescent(const DescentInput& input, const ThreadPool& pool);

  // Runs the descent of one interval and returns the number of overlap tests. `bounds`, [nodes], are in steps
  // of `grid`. A descent that takes more than `most` tests may stop, and has then passed on only some pairs.
  std::uint64_t run(std::span<const NodeBounds> bounds, const Grid& grid, TrianglePairSink& sink,
                    std::uint64_t most = kAnyNumber);
  // Does what run() does in ranges, and calls `cut_short` after each of them: returns true where it has moved
  // the end of the interval, and `bounds` and `grid` with it. The ranges that are left are then about the new
  // interval. `patience` bounds what the ranges may be expected to take together, in tests, with each pair
  // that is passed on as kTestsOfPair of them, where most of it is due to motion. A descent that would take
  // more stops, and has then passed on only some pairs. What is passed on, and the number of tests, does not
  // depend on the number of threads.
  struct Outcome {
    std::uint64_t tests = 0;
    bool stopped = false;
    double growth = 1;  // pairs of patches that overlap during the interval, for each that does at its start
  };
  Outcome run_in_ranges(std::span<const NodeBounds> bounds, const Grid& grid, TrianglePairSink& sink,
                        const std::function<std::optional<std::uint64_t>()>& cut_short,
                        std::uint64_t patience);
  static constexpr std::uint64_t kAnyNumber = std::numeric_limits<std::uint64_t>::max();

 private:
  class KeptPairs : public TrianglePairSink {
   public:
    KeptPairs() : TrianglePairSink(1 << 9) {}
    std::vector<TrianglePair> pairs;
    std::uint64_t cost() const { return kTestsOfPair * count(); }
    void clear() {
      pairs.clear();
      restart();
    }

   private:
    void take(const std::vector<TrianglePair>& block) override {
      pairs.insert(pairs.end(), block.begin(), block.end());
    }
  };
  void warm_cache() const;
  void split_into_subtrees(std::size_t ranges);
  std::span<const NodePair> subtrees_of(std::size_t range, std::size_t ranges) const;
  static void pass_on(KeptPairs& kept, TrianglePairSink& sink);

  const DescentInput input_;
  const ThreadPool& pool_;
  std::vector<PatchDescent> by_thread_;
  std::deque<KeptPairs> kept_;  // [ranges]: the pairs that a range passed on
  struct RangeWork {
    std::uint64_t tests;
    PatchDescent::PatchPairs pairs;
  };
  std::vector<RangeWork> work_of_;  // [ranges], of a descent that may stop
  std::vector<NodePair> subtrees_, next_;
  std::uint64_t tests_ = 0;  // overlap tests of the last interval
};

}  // namespace cscd::fast
