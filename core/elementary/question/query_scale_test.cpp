#include "core/elementary/question/query_scale.h"

#include <gtest/gtest.h>

#include "core/elementary/question/test_queries.h"

namespace cscd {
namespace {

// The coordinates of all points, in the order of the query.
template <class Query>
std::vector<double> coordinates(Query query) {
  std::vector<double> all;
  for_each_point(query, [&](const MovingPoint& p) {
    for (const Vec3& end : {p.start, p.end}) all.insert(all.end(), {end.x(), end.y(), end.z()});
  });
  return all;
}

// Queries whose products would underflow or overflow are brought to the size of one, others stay. The shape
// is the same to the last bit. Mutations: one of the limits is not asked; a scaled query is asked at neither.
template <class Query>
void expect_in_range(int seed) {
  test::QueryMaker make(seed);
  for (int exponent = -400; exponent <= 400; exponent += 5) {
    test::FourMovingPoints points = make.lattice(4);
    points[0].start = Vec3(3, -4, 1);
    const Query query = test::query_of<Query>(test::scaled(points, std::ldexp(1, exponent)));
    const Query brought = in_range(query);
    const std::vector<double> before = coordinates(query), after = coordinates(brought);
    const double largest = largest_coordinates(brought).maxCoeff();
    const bool stays = exponent >= -66 && exponent <= 61;
    EXPECT_EQ(before == after, stays) << exponent;
    if (!stays) {
      EXPECT_TRUE(largest >= 0.5 && largest < 1) << exponent;
    }
    const double factor = largest / largest_coordinates(query).maxCoeff();
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(after[i], factor * before[i]);
  }
  const MovingPoint origin{Vec3::Zero(), Vec3::Zero()};
  const auto nothing = test::query_of<Query>(test::FourMovingPoints{origin, origin, origin, origin});
  EXPECT_EQ(coordinates(in_range(nothing)), coordinates(nothing));
}

TEST(QueryScale, BringsTinyAndHugeQueriesIntoRange) {
  expect_in_range<MovingVertexFace>(1);
  expect_in_range<MovingEdgeEdge>(2);
}

// Each axis is scaled by itself. Mutation: an axis takes the exponent of another.
TEST(QueryScale, ScalesEachAxisToUnit) {
  test::QueryMaker make(3);
  for (int i = 0; i < 200; ++i) {
    test::FourMovingPoints points = make.lattice(4);
    points[1].end = Vec3(4, 3, -2);
    const Vec3 by(0x1p-300, 0x1p7, 0x1p200);
    points = test::mapped(points, [&](const Vec3& p) -> Vec3 { return p.cwiseProduct(by); });
    const auto query = test::query_of<MovingEdgeEdge>(points), unit = axes_scaled_to_unit(query);
    const std::vector<double> before = coordinates(query), after = coordinates(unit);
    for (int axis = 0; axis < 3; ++axis) {
      const double largest = largest_coordinates(unit)[axis];
      EXPECT_TRUE(largest >= 0.5 && largest < 1);
      const double factor = largest / largest_coordinates(query)[axis];
      for (auto k = static_cast<std::size_t>(axis); k < before.size(); k += 3)
        EXPECT_EQ(after[k], factor * before[k]);
    }
  }
}

// A relative query is the query seen from one of its points, which is then at rest at the origin. Mutations:
// a point is moved the other way; the way at the start is taken at the end, too.
template <class Query>
void expect_seen_from_first(int seed, const MovingPoint& (*first)(const Query&)) {
  test::QueryMaker make(seed);
  for (int i = 0; i < 50; ++i) {
    const auto query = test::query_of<Query>(make.lattice(4));
    const std::vector<double> before = coordinates(query), after = coordinates(relative(query));
    const MovingPoint from = first(query);
    for (std::size_t k = 0; k < before.size(); ++k) {
      const auto axis = static_cast<Eigen::Index>(k % 3);
      EXPECT_EQ(after[k], before[k] - (k % 6 < 3 ? from.start : from.end)[axis]);
    }
  }
}

TEST(QueryScale, RelativeQueriesAreSeenFromTheirFirstPoint) {
  expect_seen_from_first<MovingVertexFace>(
      4, [](const MovingVertexFace& q) -> const MovingPoint& { return q.corner[0]; });
  expect_seen_from_first<MovingEdgeEdge>(
      5, [](const MovingEdgeEdge& q) -> const MovingPoint& { return q.first[0]; });
}

}  // namespace
}  // namespace cscd
