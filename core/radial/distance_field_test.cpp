#include "core/radial/distance_field.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <random>
#include <utility>

#include "core/mesh/mean_edge.h"
#include "core/mesh/test_shapes.h"
#include "core/radial/nearest_point.h"

namespace cscd::radial {
namespace {

using test::Shape;

// The rounding of a float in [0, 8), the range of the distances below.
constexpr double kFloat = 8.0 * std::numeric_limits<float>::epsilon();

double brute_distance(const Shape& shape, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Triangle& t : shape.triangles)
    least = std::min(least, (p - nearest_on_triangle(p, shape.positions[+t[0]], shape.positions[+t[1]],
                                                     shape.positions[+t[2]]))
                                .norm());
  return least;
}

// Returns the winding number, from the solid angles of the triangles (van Oosterom and Strackee 1983).
int winding(const Shape& shape, const Vec3& p) {
  double sum = 0;
  for (const Triangle& t : shape.triangles) {
    const Vec3 a = shape.positions[+t[0]] - p, b = shape.positions[+t[1]] - p, c = shape.positions[+t[2]] - p;
    sum += 2 * std::atan2(a.dot(b.cross(c)), a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                                                 b.dot(c) * a.norm() + c.dot(a) * b.norm());
  }
  return static_cast<int>(std::lround(sum / (4 * std::numbers::pi)));
}

template <class Visit>
void for_each_cell(const DistanceField& field, Visit&& visit) {
  for (int z = 0; z < field.size[2]; ++z)
    for (int y = 0; y < field.size[1]; ++y)
      for (int x = 0; x < field.size[0]; ++x)
        visit(field.centre(x, y, z), static_cast<double>(field.distance[field.index(x, y, z)]));
}

Shape capsule(double radius, double axis) {
  return test::uneven_tube(48, 160, axis + 2 * radius, [=](double x) {
    const double past = std::max({0.0, radius - x, x - radius - axis});
    return std::sqrt(std::max(0.0, radius * radius - past * past));
  });
}

TEST(NearestPoint, ObeysTheConditionOfAProjectionOntoAConvexSet) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> at(-1, 1);
  const auto point = [&] { return Vec3(at(random), at(random), at(random)); };
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = 2 * point(), a = point(), b = point();
    Vec3 c = point();
    if (i % 4 == 1) c = a + (b - a) * at(random);  // no area
    if (i % 4 == 2) c = a + 1e-9 * point();        // a needle
    if (i % 400 == 3) c = a;
    const Vec3 q = nearest_on_triangle(p, a, b, c);
    // Two conditions make q the nearest point. No corner lies beyond the plane through q that is
    // perpendicular to the way from q to p. And q lies in the triangle: if q lay beside the triangle, the
    // nearest point to q would be another point.
    for (const Vec3& v : {a, b, c}) EXPECT_LE((p - q).dot(v - q), 1e-12);
    EXPECT_LE((q - nearest_on_triangle(q, a, b, c)).norm(), 1e-12);
    const Vec3 s = nearest_on_segment(p, a, b);
    for (const Vec3& v : {a, b}) EXPECT_LE((p - s).dot(v - s), 1e-12);
    EXPECT_NEAR((s - a).norm() + (s - b).norm(), (a - b).norm(), 1e-12);
  }
  EXPECT_EQ(nearest_on_segment({1, 2, 3}, {4, 4, 4}, {4, 4, 4}), Vec3(4, 4, 4));
}

TEST(DistanceField, IsExactNearTheSurfaceAndWithinHalfADiagonalElsewhere) {
  const Shape shapes[] = {
      test::octahedron(),
      test::icosphere(1),
      test::torus(9, 6),
      test::box({0, 0, 0}, {1, 2, 0.4}),
      test::capped_tube(5, 3, 0.3, 2),
      test::together(test::octahedron(), test::moved(test::icosphere(1), {0.1, 0, 0.2}, 0.3))};
  for (const Shape& shape : shapes)
    for (const int resolution : {1, 7, 24}) {
      const DistanceField field = make_distance_field(shape.mesh(), shape.positions, resolution);
      std::size_t near = 0, far = 0;
      for_each_cell(field, [&](const Vec3& p, double distance) {
        const double exact = brute_distance(shape, p);
        if (exact < field.cell) {
          EXPECT_NEAR(std::abs(distance), exact, kFloat);
          ++near;
        } else {
          EXPECT_NEAR(std::abs(distance), exact, field.half_diagonal() + kFloat);
          ++far;
        }
        if (exact > kFloat) {
          EXPECT_EQ(distance < 0, winding(shape, p) != 0) << p.transpose();
        }
      });
      EXPECT_GT(near, 0u);
      EXPECT_GT(far, 0u);
    }
}

TEST(DistanceField, MatchesTheAnalyticSphere) {
  const Shape shape = test::icosphere(4);
  const DistanceField field = make_distance_field(shape.mesh(), shape.positions, 32);
  constexpr double sagitta = 0.002;  // edges of 0.08: 0.08^2 / 3 / 2 between sphere and facet, rounded up
  for_each_cell(field, [&](const Vec3& p, double distance) {
    const double exact = p.norm() - 1;
    const bool near = std::abs(exact) < field.cell - sagitta;
    EXPECT_NEAR(distance, exact, sagitta + (near ? 0 : field.half_diagonal()));
  });
}

TEST(DistanceField, MatchesTheAnalyticCapsuleWhosePolesAreDegenerate) {
  const double radius = 0.5, axis = 2;
  const Shape shape = capsule(radius, axis);
  const DistanceField field = make_distance_field(shape.mesh(), shape.positions, 40);
  constexpr double sagitta =
      0.01;  // first ring at 0.27 rad from the pole: 0.5 (1 - cos 0.135) = 0.005, doubled
  for_each_cell(field, [&](const Vec3& p, double distance) {
    const double exact = (p - nearest_on_segment(p, {radius, 0, 0}, {radius + axis, 0, 0})).norm() - radius;
    const bool near = std::abs(exact) < field.cell - sagitta;
    EXPECT_NEAR(distance, exact, sagitta + (near ? 0 : field.half_diagonal()));
  });
}

TEST(DistanceField, NestedBallIsBodyAndCavityIsNot) {
  Shape inner = test::octahedron(0.4);
  const Shape solid = test::together(test::octahedron(), inner);
  for (Triangle& t : inner.triangles) std::swap(t[0], t[1]);
  const Shape hollow = test::together(test::octahedron(), inner);
  const auto at_centre = [](const Shape& s) {
    return make_distance_field(s.mesh(), s.positions, 30).at({0, 0, 0});
  };
  EXPECT_LT(at_centre(solid), -0.1);
  EXPECT_GT(at_centre(hollow), 0.1);
}

TEST(DistanceField, ReversedSurfaceHasTheSameInside) {
  Shape shape = test::torus(9, 6);
  const DistanceField outward = make_distance_field(shape.mesh(), shape.positions, 20);
  for (Triangle& t : shape.triangles) std::swap(t[0], t[1]);
  EXPECT_EQ(make_distance_field(shape.mesh(), shape.positions, 20).distance, outward.distance);
}

TEST(DistanceField, SurfacesWithoutVolumeHaveFiniteDistances) {
  const Shape flat{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {test::corners(0, 1, 2), test::corners(0, 2, 1)}};
  const Shape needle{{{0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}}, {test::corners(0, 1, 2), test::corners(0, 2, 1)}};
  const Shape point{{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {test::corners(0, 1, 2), test::corners(0, 2, 1)}};
  for (const Shape& shape : {flat, needle, point}) {
    const DistanceField field = make_distance_field(shape.mesh(), shape.positions, 9);
    for_each_cell(field, [&](const Vec3& p, double distance) {
      EXPECT_NEAR(distance, brute_distance(shape, p), field.half_diagonal() + kFloat);
    });
  }
}

TEST(DistanceField, KeepsAMarginAndIgnoresUnusedVertices) {
  Shape shape = test::octahedron();
  shape.positions.emplace_back(1e9, 0, 0);
  const DistanceField field = make_distance_field(shape.mesh(), shape.positions, 10);
  EXPECT_DOUBLE_EQ(field.cell, 0.2);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LE(field.corner[axis] + field.cell, -1 + 1e-12);
    EXPECT_GE(field.corner[axis] + field.cell * (field.size[static_cast<std::size_t>(axis)] - 1), 1 - 1e-12);
  }
  EXPECT_GE(field.at({0, 0, 50}), 48);
  EXPECT_GE(field.at({-1.3, 0, 0}), field.cell);
  EXPECT_EQ(field.at({0, 0, 0.01}), field.at({0, 0, 0.02}));
}

TEST(DistanceField, TooFineAGridIsMadeCoarser) {
  const Shape shape = test::box({0, 0, 0}, {1, 0.02, 0.02});
  const DistanceField field = make_distance_field(shape.mesh(), shape.positions, 1 << 14);
  EXPECT_LE(field.distance.size(), std::size_t{1} << 25);
  EXPECT_GT(field.distance.size(), std::size_t{1} << 24);
  EXPECT_LT(field.at({0.5, 0.01, 0.01}), -0.009);
}

TEST(ResolutionOfMeanEdge, MakesCellsAsLongAsTheMeanEdge) {
  const Shape shape = test::icosphere(3);
  const TriangleMesh mesh = shape.mesh();
  const double mean = mean_edge(mesh, shape.positions);
  const int cells = resolution_of_mean_edge(mesh, shape.positions);
  const double longest = surface_box(mesh, shape.positions).sizes().maxCoeff();
  EXPECT_LE(longest / cells, mean);
  EXPECT_GT(longest / (cells - 1), mean);
  const std::vector<Vec3> one_point(shape.positions.size(), Vec3::Zero());
  EXPECT_EQ(resolution_of_mean_edge(mesh, one_point), 1);
}

TEST(RunsInside, TellsTheTubeOfATorusFromItsHole) {
  const Shape shape = test::torus(40, 16, 2, 0.5);
  const DistanceField field = make_distance_field(shape.mesh(), shape.positions, 50);
  EXPECT_TRUE(runs_inside(field, {2.5, 0, 0}, {2, 0, 0}));
  EXPECT_TRUE(runs_inside(field, {2, 0, 0}, {1.9, 0.6, 0}));
  EXPECT_TRUE(runs_inside(field, {2, 0, 0}, {2, 0, 0}));
  EXPECT_FALSE(runs_inside(field, {2.5, 0, 0}, {-2, 0, 0}));  // across the hole
  EXPECT_FALSE(runs_inside(field, {2, 0, 0}, {0, 2, 0}));
  EXPECT_FALSE(runs_inside(field, {2, 0, 0}, {1e6, 0, 0}));  // out of the grid
  EXPECT_FALSE(runs_inside(field, {0, 0, 0}, {0, 0, 0}));
  EXPECT_FALSE(runs_inside(field, {2, 0, 0}, {std::numeric_limits<double>::infinity(), 0, 0}));
}

TEST(RunsInside, NeverHidesALineOfAConvexBody) {
  // Every chord of a convex body lies inside. The tolerance must preserve that on any grid.
  const Shape shape = test::icosphere(1);
  std::mt19937 random(5);
  for (const int resolution : {1, 3, 11, 40}) {
    const DistanceField field = make_distance_field(shape.mesh(), shape.positions, resolution);
    for (int i = 0; i < 500; ++i)
      EXPECT_TRUE(runs_inside(field, shape.positions[random() % shape.positions.size()],
                              shape.positions[random() % shape.positions.size()]));
  }
}

}  // namespace
}  // namespace cscd::radial
