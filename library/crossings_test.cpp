#include <gtest/gtest.h>
#include <limits>
#include <stdexcept>

#include "core/mesh/test_shapes.h"

#include "cscd/cscd.h"

namespace cscd {
namespace {

struct TwoBalls {
  test::Shape shape = test::together(test::icosphere(2), test::moved(test::icosphere(2), {1.6, 0.01, 0.02}));
  std::vector<int> faces;
  TwoBalls() {
    for (const Triangle& t : shape.triangles)
      for (const VertexId v : t) faces.push_back(static_cast<int>(v));
  }
  std::span<const double> positions() const {
    return {shape.positions.front().data(), 3 * shape.positions.size()};
  }
};

TEST(Crossings, SayWhichPiecesLieInEachOther) {
  const TwoBalls balls;
  SelfCollision body(balls.faces, balls.positions());
  const SelfCollision::Crossings found = body.crossings(balls.positions());
  ASSERT_EQ(found.overlaps.size(), 1u);
  const SelfCollision::Crossings::Overlap& overlap = found.overlaps.front();
  ASSERT_EQ(overlap.curves.size(), 1u);
  EXPECT_TRUE(overlap.curves[0].closed);
  EXPECT_EQ(overlap.curves[0].points.size(), overlap.curves[0].faces.size());
  for (const Eigen::Vector3d& point : overlap.curves[0].points) EXPECT_NEAR(point.x(), 0.8, 0.1);
  EXPECT_NEAR(overlap.depth, 0.4, 0.08);
  EXPECT_GE(overlap.depth_bound, 0.4);
  ASSERT_EQ(overlap.regions.size(), 2u);
  for (const SelfCollision::Crossings::Region& region : overlap.regions) {
    EXPECT_TRUE(region.behind);
    EXPECT_FALSE(region.other_is_open);
    ASSERT_EQ(region.distance.size(), region.vertices.size());
    EXPECT_EQ(*std::ranges::max_element(region.distance), region.depth);
    ASSERT_EQ(region.way.size(), region.vertices.size());
    for (std::size_t i = 0; i < region.way.size(); ++i) EXPECT_EQ(region.way[i].norm(), region.distance[i]);
    EXPECT_NEAR(region.out.norm(), region.depth, 1e-12);
    const double side = region.vertices.front() < 162 ? 1 : -1;
    for (const int v : region.vertices)
      EXPECT_GT(side * (balls.shape.positions[static_cast<std::size_t>(v)].x() - 0.8), -0.1);
  }
}

TEST(Crossings, BecomeShorterAgainstTheGradient) {
  TwoBalls balls;
  SelfCollision body(balls.faces, balls.positions());
  const SelfCollision::Crossings::Overlap before = body.crossings(balls.positions()).overlaps.at(0);
  ASSERT_EQ(before.gradient.size(), before.vertices.size());
  for (std::size_t i = 0; i < before.vertices.size(); ++i)
    balls.shape.positions[static_cast<std::size_t>(before.vertices[i])] -=
        0.01 * before.gradient[i].normalized();
  const SelfCollision::Crossings::Overlap after = body.crossings(balls.positions()).overlaps.at(0);
  double expected = 0;
  for (const Eigen::Vector3d& gradient : before.gradient) expected += 0.01 * gradient.norm();
  EXPECT_NEAR(before.length - after.length, expected, 0.5 * expected);
}

TEST(Crossings, AreNoneWhereNothingCrossesOrAllIsExcluded) {
  const TwoBalls balls;
  test::Shape apart = balls.shape;
  for (std::size_t v = 162; v < apart.positions.size(); ++v) apart.positions[v].x() += 1;
  SelfCollision body(balls.faces, balls.positions());
  EXPECT_TRUE(
      body.crossings(std::span(apart.positions.front().data(), 3 * apart.positions.size())).overlaps.empty());
  SelfCollision::Options options;
  options.exclude.group.assign(324, 0);
  std::fill_n(options.exclude.group.begin(), 162, 1);
  options.exclude.groups_that_ignore_each_other = {{0, 1}};
  EXPECT_TRUE(
      SelfCollision(balls.faces, balls.positions(), options).crossings(balls.positions()).overlaps.empty());
}

TEST(Crossings, RefuseWhatIsNoPose) {
  const TwoBalls balls;
  SelfCollision body(balls.faces, balls.positions());
  EXPECT_THROW(body.crossings(balls.positions().first(30)), std::invalid_argument);
  std::vector<double> broken(balls.positions().begin(), balls.positions().end());
  broken[5] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(body.crossings(broken), std::invalid_argument);
}

}  // namespace
}  // namespace cscd
