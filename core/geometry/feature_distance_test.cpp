#include "core/geometry/feature_distance.h"

#include <gtest/gtest.h>

namespace cscd {
namespace {

TEST(FeatureDistance, PointAndTriangle) {
  const Vec3 a(0, 0, 0), b(4, 0, 0), c(0, 4, 0);
  EXPECT_EQ(squared_point_triangle_distance({1, 1, 2}, a, b, c), 4);     // above the face
  EXPECT_EQ(squared_point_triangle_distance({1, -2, 0}, a, b, c), 4);    // beside an edge
  EXPECT_EQ(squared_point_triangle_distance({-3, -4, 0}, a, b, c), 25);  // off a corner
  EXPECT_EQ(squared_point_triangle_distance({1, 2, 0}, a, b, c), 0);
  EXPECT_EQ(squared_point_triangle_distance({5, 3, 0}, a, b, b), 10);  // collapsed to an edge
  EXPECT_EQ(squared_point_triangle_distance({3, 4, 0}, a, a, a), 25);  // collapsed to a point
}

TEST(FeatureDistance, Segments) {
  const Vec3 a(0, 0, 0), b(4, 0, 0);
  EXPECT_EQ(squared_segment_distance(a, b, {1, -1, 3}, {1, 1, 3}), 9);  // across
  EXPECT_EQ(squared_segment_distance(a, b, {1, 2, 0}, {9, 2, 0}), 4);   // parallel
  EXPECT_EQ(squared_segment_distance(a, b, {6, 0, 0}, {9, 0, 0}), 4);   // on one line
  EXPECT_EQ(squared_segment_distance(a, a, {3, 4, 0}, {3, 4, 0}), 25);  // points
}

TEST(FeatureDistance, AtATime) {
  const auto still = [](const Vec3& x) { return MovingPoint{x, x}; };
  const MovingVertexFace vf{{{1, 1, 2}, {1, 1, -2}}, {still({0, 0, 0}), still({4, 0, 0}), still({0, 4, 0})}};
  EXPECT_EQ(distance_at(vf, 0), 2);
  EXPECT_EQ(distance_at(vf, 0.5), 0);
  const MovingEdgeEdge ee{{still({0, 0, 0}), still({4, 0, 0})},
                          {{{1, -1, 2}, {1, -1, -2}}, {{1, 1, 2}, {1, 1, -2}}}};
  EXPECT_EQ(distance_at(ee, 0.25), 1);
}

}  // namespace
}  // namespace cscd
