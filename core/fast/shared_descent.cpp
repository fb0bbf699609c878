#include <algorithm>

#include "core/base/warm_cache.h"
#include "core/fast/patch_descent.h"

namespace cscd::fast {
namespace {

// The work below a pair of nodes differs widely. There are enough pairs in a range that the ranges even out,
// and enough ranges that nobody waits long for the last one.
constexpr std::size_t kRangesAThread = 16, kPairsARange = 8;
// A descent that may stop has so many ranges, on any number of threads, and looks after each whether it may.
constexpr unsigned kStopBits = 6;
constexpr std::size_t kStops = 1 << kStopBits;
// Returns the range that comes at a place in the order, which reverses the bits of the place: the first few
// ranges are then from all over the surface.
std::size_t place_of(std::size_t i) {
  std::size_t reversed = 0;
  for (unsigned bit = 0; bit < kStopBits; ++bit) reversed |= (i >> bit & 1) << (kStopBits - 1 - bit);
  return reversed;
}

// Where so many pairs of patches overlap during an interval for each that does at its start, its parts take
// less together.
constexpr double kWorthParts = 3;

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

SharedDescent::SharedDescent(const DescentInput& input, const ThreadPool& pool)
    : input_(input), pool_(pool), by_thread_(pool.threads(), PatchDescent(input)) {
  if (pool.threads() > 1) kept_.resize(std::max(kStops, kRangesAThread * pool.threads()));
}

std::uint64_t SharedDescent::run(std::span<const NodeBounds> bounds, const Grid& grid, TrianglePairSink& sink,
                                 std::uint64_t most) {
  const ThreadPool alone;
  const ThreadPool& pool = tests_ < kTestsWorthWaking ? alone : pool_;
  pool.parallel_for(by_thread_.size(),
                    [&](std::size_t i, std::size_t) { by_thread_[i].start_interval(bounds, grid, most); });
  if (tests_ > kTestsWhereAllAreMet * input_.tree.patches.size()) warm_cache();
  subtrees_.assign(1, {0, 0});
  const std::size_t ranges = pool_.threads() > 1 ? kRangesAThread * pool_.threads() : 0;
  if (ranges == 0) {
    by_thread_[0].descend(subtrees_[0], sink);
  } else {
    split_into_subtrees(ranges);
    pool.parallel_for(ranges, [&](std::size_t range, std::size_t thread) {
      for (const NodePair pair : subtrees_of(range, ranges)) by_thread_[thread].descend(pair, kept_[range]);
    });
    for (std::size_t range = 0; range < ranges; ++range) pass_on(kept_[range], sink);
  }
  tests_ = 0;
  for (const PatchDescent& descent : by_thread_) tests_ += descent.tests();
  return tests_;
}

SharedDescent::Outcome SharedDescent::run_in_ranges(
    std::span<const NodeBounds> bounds, const Grid& grid, TrianglePairSink& sink,
    const std::function<std::optional<std::uint64_t>()>& cut_short, std::uint64_t patience) {
  const ThreadPool alone;
  const ThreadPool& pool = tests_ < kTestsWorthWaking ? alone : pool_;
  const auto start = [&] {
    pool.parallel_for(by_thread_.size(), [&](std::size_t i, std::size_t) {
      by_thread_[i].start_interval(bounds, grid, kAnyNumber);
    });
  };
  start();
  if (kept_.size() < kStops) kept_.resize(kStops);
  work_of_.resize(kStops);
  subtrees_.assign(1, {0, 0});
  split_into_subtrees(kStops);
  tests_ = by_thread_[0].tests();
  std::uint64_t cost_of_pairs = 0;
  PatchDescent::PatchPairs pairs;
  Outcome out;
  for (std::size_t done = 0; done < kStops && !out.stopped && !sink.closed();) {
    const std::size_t first = done, last = std::min(first + pool.threads(), kStops);
    pool.parallel_for(last - first, [&](std::size_t i, std::size_t thread) {
      const std::size_t range = place_of(first + i);
      PatchDescent& descent = by_thread_[thread];
      const RangeWork before{descent.tests(), descent.patch_pairs()};
      if (patience != kAnyNumber) descent.stop_after(before.tests + patience);
      for (const NodePair pair : subtrees_of(range, kStops)) descent.descend(pair, kept_[range]);
      work_of_[range] = {descent.tests() - before.tests,
                         {descent.patch_pairs().all - before.pairs.all,
                          descent.patch_pairs().at_start - before.pairs.at_start}};
    });
    bool cut = false;
    while (done < last && !cut && !out.stopped && !sink.closed()) {
      KeptPairs& kept = kept_[place_of(done)];
      const RangeWork& work = work_of_[place_of(done)];
      tests_ += work.tests;
      cost_of_pairs += kept.cost();
      pairs.all += work.pairs.all, pairs.at_start += work.pairs.at_start;
      out.growth = static_cast<double>(pairs.all + 1) / static_cast<double>(pairs.at_start + 1);
      ++done;
      out.stopped =
          cost_of_pairs > patience || (tests_ + cost_of_pairs > patience && out.growth > kWorthParts);
      if (out.stopped) break;
      pass_on(kept, sink);
      sink.tell();
      if (done == kStops) break;
      if (const auto left = cut_short()) patience = *left, cut = true;
    }
    // What is left of this round is about the interval before the cut.
    for (std::size_t i = first; i < last; ++i) kept_[place_of(i)].clear();
    if (cut) start();
  }
  out.tests = tests_;
  return out;
}

// Reads from end to end what a descent asks of pairs of patches that touch.
void SharedDescent::warm_cache() const {
  cscd::warm_cache(std::span(input_.tree.adjacent_offset));
  cscd::warm_cache(std::span(input_.tree.adjacent));
  cscd::warm_cache(std::span(input_.tree.common));
  if (input_.one_rings != nullptr) input_.one_rings->warm_cache();
}

// Splits pairs of nodes level by level, until there are enough for all ranges.
void SharedDescent::split_into_subtrees(std::size_t ranges) {
  bool any = true;
  while (any && subtrees_.size() < kPairsARange * ranges) {
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

std::span<const NodePair> SharedDescent::subtrees_of(std::size_t range, std::size_t ranges) const {
  const std::size_t first = subtrees_.size() * range / ranges;
  return std::span(subtrees_).subspan(first, subtrees_.size() * (range + 1) / ranges - first);
}

void SharedDescent::pass_on(KeptPairs& kept, TrianglePairSink& sink) {
  kept.flush();
  for (const TrianglePair& pair : kept.pairs) sink.add(pair.a, pair.b);
  kept.clear();
}

}  // namespace cscd::fast
