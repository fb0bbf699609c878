#include "core/fast/descend/shared_descent.h"

#include <algorithm>

#include "core/base/bring_near.h"

namespace cscd::fast {
namespace {

// The work below a pair of nodes differs widely from pair to pair. So each range holds enough pairs that the
// ranges even out, and there are enough ranges that the others do not wait long for the last one.
constexpr std::size_t kRangesAThread = 16, kPairsARange = 8;

// A descent that made more than this many tests per patch has met nearly all patches, and so will the next
// descent.
constexpr std::size_t kTestsWhereAllAreMet = 32;

}  // namespace

SharedDescent::SharedDescent(const DescentInput& input, const Team& team)
    : input_(input), team_(team), by_thread_(team.threads(), PatchDescent(input)) {
  if (team.threads() > 1) kept_.resize(kRangesAThread * team.threads());
}

std::uint64_t SharedDescent::run(std::span<const NodeBounds> bounds, const Grid& grid,
                                 TrianglePairSink& sink) {
  team_.each(by_thread_.size(),
             [&](std::size_t i, std::size_t) { by_thread_[i].start_interval(bounds, grid); });
  if (tests_ > kTestsWhereAllAreMet * input_.tree.patches.size()) bring_near();
  opened_.assign(1, {0, 0});
  if (kept_.empty()) {
    by_thread_[0].descend(opened_[0], sink);
  } else {
    open();
    team_.each(kept_.size(), [&](std::size_t range, std::size_t thread) {
      const std::size_t first = opened_.size() * range / kept_.size();
      const std::size_t last = opened_.size() * (range + 1) / kept_.size();
      for (std::size_t i = first; i < last; ++i) by_thread_[thread].descend(opened_[i], kept_[range]);
    });
    join(sink);
  }
  tests_ = 0;
  for (const PatchDescent& descent : by_thread_) tests_ += descent.tests();
  return tests_;
}

// Reads into the cache all that a descent asks of patches that touch.
void SharedDescent::bring_near() const {
  cscd::bring_near(std::span(input_.tree.adjacent_offset));
  cscd::bring_near(std::span(input_.tree.adjacent));
  cscd::bring_near(std::span(input_.tree.common));
  if (input_.stars != nullptr) input_.stars->bring_near();
}

// Opens the pairs of nodes level by level, until there are enough for all ranges or none can be opened.
void SharedDescent::open() {
  bool any = true;
  while (any && opened_.size() < kPairsARange * kept_.size()) {
    any = false;
    next_.clear();
    for (const NodePair pair : opened_) {
      const bool can = by_thread_[0].can_open(pair);
      any |= can;
      if (can)
        by_thread_[0].open(pair, next_);
      else
        next_.push_back(pair);
    }
    opened_.swap(next_);
  }
}

void SharedDescent::join(TrianglePairSink& sink) {
  for (Kept& kept : kept_) {
    kept.flush();
    for (const TrianglePair& pair : kept.pairs) sink.add(pair.a, pair.b);
    kept.pairs.clear();
    kept.restart();
  }
}

}  // namespace cscd::fast
