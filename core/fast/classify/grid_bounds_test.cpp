#include "core/fast/classify/grid_bounds.h"

#include <gtest/gtest.h>
#include <random>

#include "core/fast/classify/test_patches.h"

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

// Points that move fast side by side stay apart. Points that change places do not, and points that touch are
// not apart. Mutation: `apart` joins both ends by "or".
TEST(NodeBounds, ApartMeansOnOneSideAllTheTime) {
  const NodeBounds a = bounds_of_point({0, 0, 0}, {100, 0, 0});
  EXPECT_TRUE(apart(a, bounds_of_point({1, 0, 0}, {101, 0, 0})));
  EXPECT_TRUE(apart(bounds_of_point({1, 0, 0}, {101, 0, 0}), a));
  EXPECT_FALSE(apart(a, bounds_of_point({1, 0, 0}, {99, 0, 0})));
  EXPECT_FALSE(apart(bounds_of_point({1, 0, 0}, {99, 0, 0}), a));
  EXPECT_FALSE(apart(a, bounds_of_point({1, 0, 0}, {100, 0, 0})));
  EXPECT_FALSE(apart(a, a));
}

// Rule outward-rounding. Bounds are off by no more than the header says. Mutations: bounds of nodes or of
// triangles are not widened; coordinates of a triangle are rounded before they are summed; one end is taken
// twice.
TEST(GridBounds, RuleOutwardRoundingContainTheExactPositionsAtBothEnds) {
  for (const test::Patches& scene : test::patches()) {
    const Grid grid(scene.local.error());
    const mpq_class steps(grid.steps());
    for (std::size_t p = 0; p < scene.tree.patches.size(); p += 5) {
      const Patch& patch = scene.tree.patches[p];
      const PatchLanes lanes = load(scene.local.records(), patch.vertex);
      const NodeBounds bounds = grid.bounds_of(lanes);
      const TriangleBounds triangles = grid.bounds_of_triangles(lanes, patch);
      for (std::size_t l = 0; l < kLanes16; ++l)
        for (const VertexId v : scene.mesh.corners(scene.tree.triangles[p][l]))
          for (std::size_t end = 0; end < 2; ++end) {
            const test::Exact3 x = scene.exact_local((end == 0 ? scene.start : scene.end)[+v]);
            for (std::size_t k = 0; k < kDirections; ++k) {
              mpq_class along = 0;
              for (std::size_t i = 0; i < 3; ++i) along += kDirection[k][i] * x[i] * steps;
              EXPECT_LE(bounds.at[2 * k + end], along + 0.004);
              EXPECT_LE(bounds.at[2 * (kDirections + k) + end], -along + 0.004);
              EXPECT_LE(triangles.low[k][2 * l + end], along + 0.506);
              EXPECT_GE(triangles.high[k][2 * l + end], along + 0.494);
            }
          }
    }
  }
}

NodeBounds of_lane(const TriangleBounds& bounds, std::size_t lane) {
  NodeBounds one;
  for (std::size_t k = 0; k < kDirections; ++k)
    for (std::size_t end = 0; end < 2; ++end) {
      one.at[2 * k + end] = bounds.low[k][2 * lane + end];
      one.at[2 * (kDirections + k) + end] = static_cast<std::int16_t>(-bounds.high[k][2 * lane + end]);
    }
  return one;
}

// `near` says of every triangle in the mask what `apart` says of its bounds, and returns no other triangle.
// Mutations: one of the two sides is left out; one direction is left out; the second step ignores the mask.
TEST(GridBounds, NearIsApartLaneByLane) {
  const test::Patches scene(0.3, 2, {0, 0, 0}, 1, 3);
  const Grid grid(scene.local.error());
  const auto lanes_of = [&](std::size_t p) {
    return load(scene.local.records(), scene.tree.patches[p].vertex);
  };
  std::size_t outcomes[2] = {};
  for (std::size_t p = 0; p + 7 < scene.tree.patches.size(); ++p)
    for (const std::size_t q : {p + 1, p + 7}) {
      TriangleBounds first = grid.bounds_of_triangles(lanes_of(p), scene.tree.patches[p]);
      TriangleBounds second = grid.bounds_of_triangles(lanes_of(q), scene.tree.patches[q]);
      NodeBounds whole = grid.bounds_of(lanes_of(q));
      if (p % 3 == 0) first = swept(first), second = swept(second), whole = swept(whole);
      const Mask16 asked = p % 2 == 0 ? 0xffff : 0x5a3c;
      const Mask16 to_whole = near(first, asked, whole), to_lane = near(first, asked, second, 5);
      for (std::size_t l = 0; l < kLanes16; ++l) {
        const bool is_asked = asked >> l & 1;
        EXPECT_EQ(to_whole >> l & 1, is_asked && !apart(of_lane(first, l), whole));
        EXPECT_EQ(to_lane >> l & 1, is_asked && !apart(of_lane(first, l), of_lane(second, 5)));
        ++outcomes[to_lane >> l & 1];
      }
    }
  EXPECT_GT(outcomes[0], 100u);
  EXPECT_GT(outcomes[1], 100u);
}

// Swept bounds of triangles are the swept bounds of nodes, lane by lane.
TEST(GridBounds, SweptTrianglesAreSweptLaneByLane) {
  const test::Patches scene(0.1, 2, {0, 0, 0}, 1, 4);
  const Grid grid(scene.local.error());
  const Patch& patch = scene.tree.patches[3];
  const TriangleBounds bounds = grid.bounds_of_triangles(load(scene.local.records(), patch.vertex), patch);
  const TriangleBounds path = swept(bounds);
  for (std::size_t l = 0; l < kLanes16; ++l) {
    const NodeBounds expected = swept(of_lane(bounds, l)), got = of_lane(path, l);
    for (std::size_t i = 0; i < 32; ++i) EXPECT_EQ(got.at[i], expected.at[i]);
  }
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

// The minimum takes every lane of every row, and nothing else.
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

// With a margin, what is apart is so by more than twice the margin, along one direction at both ends. Margins
// may be larger than the surface.
// Mutations: no margin; one side alone; diagonals with the margin of axes.
TEST(GridBounds, WithAMarginApartMeansFartherThanTwiceTheMargin) {
  const test::Patches scene(0.1, 2, {0, 0, 0}, 1, 5);
  const double directions[kDirections][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1},  {1, 1, 0},
                                             {1, 0, 1}, {0, 1, 1}, {1, -1, 0}, {1, 0, -1}};
  const auto gap = [&](const Patch& a, const Patch& b, std::size_t end, const double(&d)[3]) {
    const auto along = [&](std::int32_t vertex) {
      const float* const at = &scene.local.records()[static_cast<std::size_t>(vertex)].at[4 * end];
      return d[0] * static_cast<double>(at[0]) + d[1] * static_cast<double>(at[1]) +
             d[2] * static_cast<double>(at[2]);
    };
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (const std::int32_t v : a.vertex) most = std::max(most, along(v));
    for (const std::int32_t v : b.vertex) least = std::min(least, along(v));
    return (least - most) / std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  };
  std::size_t outcomes[2] = {};
  for (const float margin : {1e-5F, 0.003F, 0.05F, 0.4F, 30.0F}) {
    const Grid grid(scene.local.error(), margin);
    EXPECT_TRUE(grid.has_margin());
    for (std::size_t p = 0; p < scene.tree.patches.size(); p += 2)
      for (std::size_t q = p % 5; q < scene.tree.patches.size(); q += 9) {
        const Patch &a = scene.tree.patches[p], &b = scene.tree.patches[q];
        const NodeBounds first = grid.bounds_of(load(scene.local.records(), a.vertex)),
                         second = grid.bounds_of(load(scene.local.records(), b.vertex));
        const bool is_apart = apart(first, second);
        ++outcomes[is_apart];
        if (!is_apart) continue;
        bool any = false;
        for (const auto& d : directions)
          any |= (gap(a, b, 0, d) > 2 * margin && gap(a, b, 1, d) > 2 * margin) ||
                 (gap(b, a, 0, d) > 2 * margin && gap(b, a, 1, d) > 2 * margin);
        EXPECT_TRUE(any) << margin;
      }
  }
  EXPECT_GT(outcomes[0], 100u);
  EXPECT_GT(outcomes[1], 100u);
}

}  // namespace
}  // namespace cscd::fast
