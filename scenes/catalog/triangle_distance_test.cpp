#include "scenes/catalog/triangle_distance.h"

#include <gtest/gtest.h>
#include <random>

namespace cscd::scenes {
namespace {

const TriangleCorners kFloor{Vec3{0, 0, 0}, Vec3{4, 0, 0}, Vec3{0, 4, 0}};

double both_ways(const TriangleCorners& a, const TriangleCorners& b) {
  const double distance = triangle_distance(a, b);
  EXPECT_NEAR(triangle_distance(b, a), distance, 1e-14);
  return distance;
}

TEST(TriangleDistance, KnownPlaces) {
  EXPECT_EQ(both_ways(kFloor, {Vec3{1, 1, 2}, Vec3{2, 1, 5}, Vec3{1, 2, 5}}), 2) << "vertex over the face";
  EXPECT_EQ(both_ways(kFloor, {Vec3{1, -3, 0}, Vec3{2, -3, 1}, Vec3{1, -4, 1}}), 3) << "vertex and edge";
  EXPECT_EQ(both_ways(kFloor, {Vec3{-3, -4, 0}, Vec3{-9, -4, 1}, Vec3{-9, -9, 1}}), 5) << "two vertices";
  EXPECT_EQ(both_ways(kFloor, {Vec3{1, -2, -1}, Vec3{1, -2, 1}, Vec3{1, -9, 0}}), 2) << "two edges";
  EXPECT_EQ(both_ways(kFloor, {Vec3{1, 1, 3}, Vec3{2, 1, 3}, Vec3{1, 2, 3}}), 3) << "parallel faces";
}

TEST(TriangleDistance, IsZeroWhereTheyCrossOrTouch) {
  EXPECT_EQ(both_ways(kFloor, {Vec3{1, 1, -1}, Vec3{1, 1, 1}, Vec3{9, 9, 0.5}}), 0)
      << "an edge pierces the face";
  EXPECT_EQ(both_ways(kFloor, {Vec3{-1, -1, -1}, Vec3{9, 9, -1}, Vec3{1, 1, 9}}), 0) << "wholly through";
  EXPECT_EQ(both_ways(kFloor, {Vec3{1, 1, 0}, Vec3{2, 1, 5}, Vec3{1, 2, 5}}), 0)
      << "a vertex lies on the face";
  EXPECT_EQ(both_ways(kFloor, {Vec3{1, 1, 0}, Vec3{2, 1, 0}, Vec3{1, 2, 0}}), 0) << "one inside the other";
}

TEST(TriangleDistance, DegenerateTrianglesAreTheirSegmentsAndPoints) {
  const Vec3 p{1, 1, 2}, q{2, 1, 3};
  EXPECT_EQ(both_ways(kFloor, {p, p, p}), 2);
  EXPECT_EQ(both_ways(kFloor, {p, q, p}), 2);
  EXPECT_EQ(both_ways({p, p, p}, {q, q, q}), std::sqrt(2.0));
  EXPECT_EQ(both_ways({p, q, Vec3(p + 2 * (q - p))}, {Vec3{1, 5, 2}, Vec3{1, 5, 2}, Vec3{1, 5, 2}}), 4);
}

// Compares with the nearest points of a grid on both triangles: the distance is never above theirs, and it is
// below by at most the width of the grid.
TEST(TriangleDistance, IsThatOfTheNearestPoints) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const auto triangle = [&](const Vec3& shift) {
    TriangleCorners t;
    for (Vec3& p : t) p = Vec3(coordinate(random), coordinate(random), coordinate(random)) + shift;
    return t;
  };
  constexpr int grid = 24;
  const auto points = [&](const TriangleCorners& t) {
    std::vector<Vec3> all;
    for (int i = 0; i <= grid; ++i)
      for (int j = 0; i + j <= grid; ++j)
        all.push_back(t[0] + (t[1] - t[0]) * i / grid + (t[2] - t[0]) * j / grid);
    return all;
  };
  int apart = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const TriangleCorners a = triangle({0, 0, 0}), b = triangle({trial % 3 * 0.7, 0, 0});
    double nearest = 1e300, longest = 0;
    for (const TriangleCorners& t : {a, b})
      for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, (t[k] - t[(k + 1) % 3]).norm());
    for (const Vec3& p : points(a))
      for (const Vec3& q : points(b)) nearest = std::min(nearest, (p - q).norm());
    const double distance = both_ways(a, b);
    ASSERT_LE(distance, nearest + 1e-14) << "trial " << trial;
    ASSERT_GE(distance, nearest - 2 * longest / grid) << "trial " << trial;
    apart += distance > 0;
  }
  EXPECT_GT(apart, 100);
  EXPECT_LT(apart, 290);
}

}  // namespace
}  // namespace cscd::scenes
