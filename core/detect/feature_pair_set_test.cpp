#include "core/detect/feature_pair_set.h"

#include <gtest/gtest.h>
#include <new>
#include <random>
#include <set>

#include "core/base/test_allocations.h"

namespace cscd {
namespace {

constexpr std::int32_t kMaxId = (1 << 28) - 1;        // largest index of a vertex or a triangle
constexpr std::int32_t kMaxEdge = 3 * (1 << 28) - 1;  // largest index of an edge, if no triangles share edges

FeaturePair vf(std::int32_t vertex, std::int32_t triangle) {
  return FeaturePair::of(VertexId{vertex}, TriangleId{triangle});
}
FeaturePair ee(std::int32_t one, std::int32_t other) {
  return FeaturePair::of(EdgeId{one}, EdgeId{other});
}

TEST(FeaturePair, OfTwoEdgesDoesNotDependOnTheirOrder) {
  EXPECT_EQ(ee(3, 8), ee(8, 3));
  EXPECT_NE(ee(3, 8), vf(3, 8));
  EXPECT_NE(vf(3, 8), vf(8, 3));
}

// Random streams over so many intervals that the interval's number wraps round several times. Some are so
// long that the table grows in the middle of an interval.
TEST(FeaturePairSet, AgreesWithStdSetOverManyIntervals) {
  std::mt19937 random(1);
  FeaturePairSet set;
  for (int interval = 0; interval < 300; ++interval) {
    set.start_interval();
    std::set<FeaturePair> model;
    const auto range = static_cast<std::int32_t>(1 + random() % 200);
    const int count = interval % 50 == 49 ? 20'000 : static_cast<int>(random() % 500);
    for (int i = 0; i < count; ++i) {
      const auto a = static_cast<std::int32_t>(random() % static_cast<unsigned>(range)),
                 b = static_cast<std::int32_t>(random() % static_cast<unsigned>(range));
      const FeaturePair pair = random() % 2 == 0 || a == b ? vf(a, b) : ee(a, b);
      ASSERT_EQ(set.insert(pair), model.insert(pair).second) << "interval " << interval;
    }
  }
}

TEST(FeaturePairSet, ForgetsInEveryIntervalWhatItMetInAnyOther) {
  FeaturePairSet set;
  for (int interval = 0; interval < 1000; ++interval) {
    set.start_interval();
    ASSERT_TRUE(set.insert(vf(1, 2))) << interval;
    ASSERT_FALSE(set.insert(vf(1, 2))) << interval;
  }
}

// Mutation: places are counted for the larger table before there is memory for it.
TEST(FeaturePairSet, IsAsItWasWhereThereIsNoMemoryToGrow) {
  FeaturePairSet set;
  set.start_interval();
  std::int32_t count = 0;
  g_failing = g_allocations + 1;
  EXPECT_THROW(
      while (count < 100'000) {
        set.insert(ee(count, count + 1));
        ++count;
      },
      std::bad_alloc);
  g_failing = 0;
  for (std::int32_t i = 0; i < 100'000; ++i) ASSERT_EQ(set.insert(ee(i, i + 1)), i >= count) << i;
}

TEST(FeaturePairSet, GrowsWithoutForgetting) {
  FeaturePairSet set;
  set.start_interval();
  for (std::int32_t i = 0; i < 100'000; ++i) ASSERT_TRUE(set.insert(ee(i, i + 1)));
  for (std::int32_t i = 0; i < 100'000; ++i) ASSERT_FALSE(set.insert(ee(i + 1, i)));
}

// Pairs of the largest ids that a mesh may have, and of ids that differ from them in one bit.
TEST(FeaturePairSet, DoesNotConfuseLargeIds) {
  std::set<FeaturePair> pairs;
  std::vector<std::int32_t> ids = {0, 1, 2, kMaxId, kMaxId - 1};
  for (int bit = 0; bit < 28; ++bit) ids.insert(ids.end(), {1 << bit, kMaxId ^ 1 << bit});
  std::vector<std::int32_t> edges = ids;
  edges.insert(edges.end(), {kMaxEdge, kMaxEdge - 1, 1 << 28, 1 << 29, (1 << 28) + 1, (1 << 29) + 1,
                             3 * (1 << 27), 3 * (1 << 27) - 1, 3 * (1 << 27) + 1});
  for (int bit = 0; bit < 28; ++bit)
    edges.insert(edges.end(), {(1 << 28) + (1 << bit), (1 << 29) + (1 << bit)});
  for (const std::int32_t a : ids)
    for (const std::int32_t b : ids) pairs.insert(vf(a, b));
  for (const std::int32_t a : edges)
    for (const std::int32_t b : edges)
      if (a != b) pairs.insert(ee(a, b));
  FeaturePairSet set;
  for (int interval = 0; interval < 40; ++interval) {
    set.start_interval();
    std::size_t fresh = 0;
    for (const FeaturePair& pair : pairs) fresh += set.insert(pair);
    ASSERT_EQ(fresh, pairs.size());
  }
}

}  // namespace
}  // namespace cscd
