#pragma once

#include <deque>

#include "core/base/team.h"
#include "core/fast/descend/patch_descent.h"

namespace cscd::fast {

// The descent of one interval by a team of threads. With more than one thread, the descent is first opened
// level by level into a list of pairs of nodes, in the order of the descent. Ranges of that list are shared
// out among the threads. Each thread has a PatchDescent of its own, and each range a list of triangle pairs
// of its own. These lists are joined in order. So the sink sees the same pairs in the same order, and the
// counters are the same, on any number of threads.
class SharedDescent {
 public:
  // Everything that `input` refers to, and the team, must outlive the descent.
  SharedDescent(const DescentInput& input, const Team& team);

  // Passes on all pairs of triangles that are not proven apart. Returns the number of overlap tests.
  // `bounds`, [nodes], are in steps of `grid`.
  std::uint64_t run(std::span<const NodeBounds> bounds, const Grid& grid, TrianglePairSink& sink);

 private:
  // The triangle pairs of one range.
  class Kept : public TrianglePairSink {
   public:
    Kept() : TrianglePairSink(1 << 9) {}
    std::vector<TrianglePair> pairs;

   private:
    void take(const std::vector<TrianglePair>& block) override {
      pairs.insert(pairs.end(), block.begin(), block.end());
    }
  };
  void bring_near() const;
  void open();
  void join(TrianglePairSink& sink);

  const DescentInput input_;
  const Team& team_;
  std::vector<PatchDescent> by_thread_;
  std::deque<Kept> kept_;                // [ranges]; empty for one thread
  std::vector<NodePair> opened_, next_;  // the pairs of nodes of this level, and of the next
  std::uint64_t tests_ = 0;              // of the last interval
};

}  // namespace cscd::fast
