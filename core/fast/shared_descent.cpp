#include <algorithm>

#include "core/base/warm_cache.h"
#include "core/fast/descent.h"

namespace cscd::fast {
namespace {

// The work below a pair of nodes differs widely. There are enough pairs in a range that the ranges even out,
// and enough ranges that nobody waits long for the last one.
constexpr std::size_t kRangesAThread = 16, kPairsARange = 8;

// A descent that made so many tests for each patch has met nearly all patches, and the next descent will too.
constexpr std::size_t kTestsWhereAllAreMet = 32;

// So many tests take some hundred microseconds, so that waking other threads pays. The next descent makes
// about as many tests as the last one.
#ifdef __SANITIZE_THREAD__
constexpr std::uint64_t kTestsWorthWaking = 0;  // ThreadSanitizer is to see every descent shared out
#else
constexpr std::uint64_t kTestsWorthWaking = 20'000;
#endif

}  // namespace

SharedDescent::SharedDescent(const DescentInput& input, const Team& team)
    : input_(input), team_(team), by_thread_(team.threads(), PatchDescent(input)) {
  if (team.threads() > 1) kept_.resize(kRangesAThread * team.threads());
}

std::uint64_t SharedDescent::run(std::span<const NodeBounds> bounds, const Grid& grid, TrianglePairSink& sink,
                                 std::uint64_t most) {
  const Team alone;
  const Team& team = tests_ < kTestsWorthWaking ? alone : team_;
  team.parallel_for(by_thread_.size(),
                    [&](std::size_t i, std::size_t) { by_thread_[i].start_interval(bounds, grid, most); });
  if (tests_ > kTestsWhereAllAreMet * input_.tree.patches.size()) warm_cache();
  subtrees_.assign(1, {0, 0});
  if (kept_.empty()) {
    by_thread_[0].descend(subtrees_[0], sink);
  } else {
    split_into_subtrees();
    team.parallel_for(kept_.size(), [&](std::size_t range, std::size_t thread) {
      const std::size_t first = subtrees_.size() * range / kept_.size();
      const std::size_t last = subtrees_.size() * (range + 1) / kept_.size();
      for (std::size_t i = first; i < last; ++i) by_thread_[thread].descend(subtrees_[i], kept_[range]);
    });
    pass_on_in_order(sink);
  }
  tests_ = 0;
  for (const PatchDescent& descent : by_thread_) tests_ += descent.tests();
  return tests_;
}

// Reads from end to end what a descent asks of pairs of patches that touch.
void SharedDescent::warm_cache() const {
  cscd::warm_cache(std::span(input_.tree.adjacent_offset));
  cscd::warm_cache(std::span(input_.tree.adjacent));
  cscd::warm_cache(std::span(input_.tree.common));
  if (input_.stars != nullptr) input_.stars->warm_cache();
}

// Splits pairs of nodes level by level, until there are enough for all ranges.
void SharedDescent::split_into_subtrees() {
  bool any = true;
  while (any && subtrees_.size() < kPairsARange * kept_.size()) {
    any = false;
    next_.clear();
    for (const NodePair pair : subtrees_) {
      const bool can = by_thread_[0].can_split(pair);
      any |= can;
      if (can)
        by_thread_[0].split(pair, next_);
      else
        next_.push_back(pair);
    }
    subtrees_.swap(next_);
  }
}

void SharedDescent::pass_on_in_order(TrianglePairSink& sink) {
  for (KeptPairs& kept : kept_) {
    kept.flush();
    for (const TrianglePair& pair : kept.pairs) sink.add(pair.a, pair.b);
    kept.pairs.clear();
    kept.restart();
  }
}

}  // namespace cscd::fast
