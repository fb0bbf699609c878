#include "core/engine/node_bounds.h"

#include <gtest/gtest.h>
#include <random>

#include "core/base/vec3.h"

// That bounds contain the exact positions is in patch_lanes_test.cpp.
namespace cscd::fast {
namespace {

constexpr int kDirection[8][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1},  {1, 1, 0},
                                  {1, 0, 1}, {0, 1, 1}, {1, -1, 0}, {1, 0, -1}};

NodeBounds bounds_of_point(const Vec3& start, const Vec3& end) {
  NodeBounds bounds{};
  for (std::size_t e = 0; e < 2; ++e)
    for (std::size_t k = 0; k < kDirections; ++k) {
      const Vec3& p = e == 0 ? start : end;
      const auto along = static_cast<std::int16_t>(kDirection[k][0] * p.x() + kDirection[k][1] * p.y() +
                                                   kDirection[k][2] * p.z());
      bounds.at[2 * k + e] = along;
      bounds.at[2 * (kDirections + k) + e] = static_cast<std::int16_t>(-along);
    }
  return bounds;
}

// Points that rush by together stay apart, points that change places do not; touching is not apart.
// Mutation: `apart` joins both ends by "or".
TEST(PatchLanes, ApartMeansOnOneSideAllTheTime) {
  const NodeBounds a = bounds_of_point({0, 0, 0}, {100, 0, 0});
  EXPECT_TRUE(apart(a, bounds_of_point({1, 0, 0}, {101, 0, 0})));
  EXPECT_TRUE(apart(bounds_of_point({1, 0, 0}, {101, 0, 0}), a));
  EXPECT_FALSE(apart(a, bounds_of_point({1, 0, 0}, {99, 0, 0})));
  EXPECT_FALSE(apart(bounds_of_point({1, 0, 0}, {99, 0, 0}), a));
  EXPECT_FALSE(apart(a, bounds_of_point({1, 0, 0}, {100, 0, 0})));
  EXPECT_FALSE(apart(a, a));
}

TEST(NodeBounds, SweptBoundsHoldBothEndsAtBothEnds) {
  const NodeBounds path = swept(bounds_of_point({0, 0, 0}, {100, 0, 0}));
  EXPECT_FALSE(apart(path, bounds_of_point({1, 0, 0}, {101, 0, 0})));
  EXPECT_TRUE(apart(path, bounds_of_point({101, 0, 0}, {200, 0, 0})));
  EXPECT_TRUE(apart(path, bounds_of_point({-1, 0, 0}, {-2, 0, 0})));
}

TEST(NodeBounds, NothingIsApartFromTheUnbounded) {
  EXPECT_FALSE(apart(unbounded(), bounds_of_point({16000, 16000, 16000}, {-16000, -16000, -16000})));
  EXPECT_FALSE(apart(unbounded(), unbounded()));
}

// Every lane of every row counts, and no other.
TEST(NodeBounds, TheSmallestPairsOfRowsAreThoseOfALoop) {
  std::mt19937 random(5);
  for (int round = 0; round < 100; ++round) {
    Short32 row[8], expected = {};
    for (std::size_t r = 0; r < 8; ++r)
      for (std::size_t half = 0; half < 2; ++half) {
        std::int16_t least = 32767, least_negative = 32767;
        for (std::size_t l = 0; l < kLanes16; ++l) {
          const auto number = static_cast<std::int16_t>(static_cast<int>(random() % 60001) - 30000);
          row[r][2 * l + half] = number;
          least = std::min(least, number);
          least_negative = std::min<std::int16_t>(least_negative, static_cast<std::int16_t>(-number));
        }
        expected[2 * r + half] = least;
        expected[16 + 2 * r + half] = least_negative;
      }
    const Short32 got = smallest_pairs_of_rows(row);
    for (std::size_t l = 0; l < 32; ++l) EXPECT_EQ(got[l], expected[l]);
  }
}

}  // namespace
}  // namespace cscd::fast
