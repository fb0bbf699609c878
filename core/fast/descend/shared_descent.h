#pragma once

#include <deque>
#include <limits>

#include "core/base/team.h"
#include "core/fast/descend/patch_descent.h"

namespace cscd::fast {

// The descent of one interval by a team of threads. The descent from the root is split into pairs of nodes,
// in the order of the descent, and ranges of these are shared out. Each thread has its own scratch memory,
// and each range its own list of pairs of triangles. The lists are joined in order, so the sink sees the same
// pairs in the same order, and the counters are the same, for any number of threads.
class SharedDescent {
 public:
  // Whatever `input` refers to, and the team, must outlive the descent.
  SharedDescent(const DescentInput& input, const Team& team);

  // Runs the descent of one interval and returns the number of overlap tests. `bounds`, [nodes], are in steps
  // of `grid`. A descent that takes more than `most` tests may stop, and has then passed on only some pairs.
  std::uint64_t run(std::span<const NodeBounds> bounds, const Grid& grid, TrianglePairSink& sink,
                    std::uint64_t most = kAnyNumber);
  static constexpr std::uint64_t kAnyNumber = std::numeric_limits<std::uint64_t>::max();

 private:
  class KeptPairs : public TrianglePairSink {
   public:
    KeptPairs() : TrianglePairSink(1 << 9) {}
    std::vector<TrianglePair> pairs;

   private:
    void take(const std::vector<TrianglePair>& block) override {
      pairs.insert(pairs.end(), block.begin(), block.end());
    }
  };
  void bring_near() const;
  void split_into_subtrees();
  void pass_on_in_order(TrianglePairSink& sink);

  const DescentInput input_;
  const Team& team_;
  std::vector<PatchDescent> by_thread_;
  std::deque<KeptPairs> kept_;  // [ranges]: the pairs that a range passed on
  std::vector<NodePair> subtrees_, next_;
  std::uint64_t tests_ = 0;  // overlap tests of the last interval
};

}  // namespace cscd::fast
