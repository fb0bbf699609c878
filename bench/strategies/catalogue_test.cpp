#include "bench/strategies/catalogue.h"

#include <cstdint>
#include <gtest/gtest.h>
#include <string_view>

#include "scenes/random/random_interval.h"

namespace cscd::bench {
namespace {

// Mutation: a row of the ablation keeps what its name leaves out.
TEST(Ablation, RowsHaveRelativeBoxesOrNotAsTheySay) {
  const ElementaryTest& exact = elementary_test_named("exact");
  std::uint64_t drvbc = 0, rvbc = 0;
  for (std::uint64_t seed = 1; seed <= 22; ++seed) {
    scenes::RandomInterval random = scenes::make_random_interval(seed);
    const TriangleMesh mesh(random.clip.header().triangles, random.clip.header().vertex_count);
    const std::optional<Rig> rig = scenes::rig_of(random.clip);
    const scenes::ClipInterval interval = random.clip.interval(0);
    const auto dropped = [&](std::string_view name) {
      const StrategyInput setup{mesh, random.clip.frame(0).positions, &*rig, exact};
      ContactSet found;
      const auto detector = strategy_named(name).make(setup).detector;
      return detector->detect({interval.motion, &*interval.bones}, found).pairs.relative_dropped;
    };
    drvbc += dropped("drvbc"), rvbc += dropped("rvbc_relative");
    EXPECT_EQ(dropped("drvbc_unrelative"), 0u) << seed;
    EXPECT_EQ(dropped("rvbc"), 0u) << seed;
  }
  EXPECT_GT(drvbc, 0u);
  EXPECT_GT(rvbc, 0u);
}

}  // namespace
}  // namespace cscd::bench
