#include "scenes/character/weld.h"

#include <gtest/gtest.h>

namespace cscd::scenes {
namespace {

using Groups = std::vector<std::int32_t>;

TEST(Weld, JoinsEqualPointsAtToleranceZero) {
  const std::vector<Vec3> points{
      {1e6, 2, 3}, {0, 0, 0}, {1e6, 2, 3}, {std::nextafter(1e6, 2e6), 2, 3}, {-0.0, 0, 0}};
  EXPECT_EQ(weld(points, 0), (Groups{0, 1, 0, 3, 1}));
}

TEST(Weld, JoinsWithinTheToleranceAcrossCells) {
  const std::vector<Vec3> points{{0.999, 0, 0}, {1.001, 0, 0}, {1.2, 0, 0}, {0.999, 0.0999, 0}};
  EXPECT_EQ(weld(points, 0.1), (Groups{0, 0, 2, 0}));
}

// A row of points, each of which lies near the next. Joining near points transitively
// would make them one group.
TEST(Weld, DoesNotDrawAGroupOutAlongAChain) {
  std::vector<Vec3> points;
  for (int i = 0; i < 30; ++i) points.emplace_back(0.09 * i, 0, 0);
  const Groups group = weld(points, 0.1);
  for (std::size_t v = 0; v < group.size(); ++v)
    EXPECT_LE((points[v] - points[static_cast<std::size_t>(group[v])]).norm(), 0.1);
  EXPECT_GT(std::count(group.begin(), group.end(), 28), 0);
}

TEST(Weld, SplitsWhatPartsInAnotherPose) {
  Groups group = weld(std::vector<Vec3>(5, Vec3(1, 1, 1)), 0.1);
  ASSERT_EQ(group, (Groups{0, 0, 0, 0, 0}));
  split_groups(group, std::vector<Vec3>{{0, 0, 0}, {0.01, 0, 0}, {3, 0, 0}, {3.01, 0, 0}, {6, 0, 0}}, 0.1);
  EXPECT_EQ(group, (Groups{0, 0, 2, 2, 4}));
  EXPECT_NEAR(largest_spread(group, std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {0, 2, 0}, {9, 9, 9}}),
              2, 1e-15);
}

TEST(Weld, LeavesOutCollapsedAndDuplicateTriangles) {
  const Groups group{0, 1, 2, 3, 0};
  const std::vector<RawTriangle> raw{{0, 1, 2}, {4, 1, 0}, {1, 2, 4}, {2, 1, 4}, {1, 3, 2}};
  const WeldedTriangles out = welded(raw, group);
  EXPECT_EQ(out.collapsed, 1u);
  EXPECT_EQ(out.duplicate, 2u);  // one with its corners rotated, one inside out
  ASSERT_EQ(out.triangles.size(), 2u);
  EXPECT_EQ(out.triangles[0], (Triangle{VertexId{0}, VertexId{1}, VertexId{2}}));
  EXPECT_EQ(out.triangles[1], (Triangle{VertexId{1}, VertexId{3}, VertexId{2}}));
}

TEST(Weld, CountsEdgesWithMoreThanTwoTriangles) {
  const auto triangle = [](int a, int b, int c) { return Triangle{VertexId{a}, VertexId{b}, VertexId{c}}; };
  std::vector<Triangle> fan{triangle(0, 1, 2), triangle(1, 0, 3)};
  EXPECT_EQ(crowded_edges(fan, 5), 0u);
  fan.push_back(triangle(0, 1, 4));
  EXPECT_EQ(crowded_edges(fan, 5), 1u);
}

}  // namespace
}  // namespace cscd::scenes
