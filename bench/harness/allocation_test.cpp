// What a strategy promises by `Strategy::kind`: once a detector has seen its largest interval, answering
// another interval allocates no memory, except while it cuts clusters anew. The test counts every allocation
// of its program.

#include <gtest/gtest.h>

#include "bench/strategies/catalogue.h"
#include "core/base/test_allocations.h"
#include "scenes/clip/clip.h"
#include "scenes/random/random_interval.h"

namespace cscd::bench {
namespace {

// Some of these surfaces are so crumpled that a strategy which follows them cuts clusters anew for dozens of
// intervals.
constexpr int kMostAskings = 100;

// Mutation: a vector that is made anew in every interval.
TEST(Allocation, ADetectorThatSettlesAllocatesNothingOnceItIsWarm) {
  const ElementaryTest& test = elementary_test_named("filtered_exact");
  std::size_t contacts = 0, first_allocations = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    scenes::RandomInterval random = scenes::make_random_interval(seed);
    const TriangleMesh mesh(random.clip.header().triangles, random.clip.header().vertex_count);
    const std::optional<Rig> rig = scenes::rig_of(random.clip);
    const scenes::ClipInterval interval = random.clip.interval(0);
    for (const Strategy& strategy : strategies()) {
      if (strategy.kind == StrategyKind::package) continue;
      const auto detector =
          strategy.make({mesh, random.clip.frame(0).positions, rig ? &*rig : nullptr, test}).detector;
      ContactSet found;
      const auto allocations = [&] {
        const std::size_t before = g_allocations;
        detector->detect({interval.motion, interval.bones ? &*interval.bones : nullptr}, found);
        return g_allocations - before;
      };
      first_allocations += allocations();
      allocations();
      std::size_t last = allocations();
      if (strategy.kind == StrategyKind::adaptive)
        for (int asked = 3; asked < kMostAskings && last > 0; ++asked) last = allocations();
      EXPECT_EQ(last, 0u) << strategy.name << ", seed " << seed;
      contacts += found.contacts.size();
    }
  }
  EXPECT_GT(first_allocations, 100u) << "allocations are counted";
  EXPECT_GT(contacts, 100u) << "keeping contacts is part of it";
}

}  // namespace
}  // namespace cscd::bench
