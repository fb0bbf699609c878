#include "core/elementary/exact/closeness.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <optional>
#include <vector>

#include "core/elementary/exact/exact.h"
#include "core/elementary/exact/test_brute_oracle.h"
#include "core/elementary/question/test_queries.h"

namespace cscd::exact {
namespace {

using test::against_triangle;
using test::FourMovingPoints;
using test::query_of;
using test::QueryMaker;
using test::still;
using test::text;
using Result = std::optional<TimeEnclosure>;

void expect_at(const Result& result, double time) {
  ASSERT_TRUE(result);
  EXPECT_EQ(result->lo, time);
  EXPECT_EQ(result->hi, time);
}

// Distances in long double, each the least over all cases of nearest features.
using Real = long double;
using Real3 = Eigen::Matrix<Real, 3, 1>;
Real3 at(const MovingPoint& p, Real t) {
  return (1 - t) * p.start.cast<Real>() + t * p.end.cast<Real>();
}
Real to_segment(const Real3& p, const Real3& a, const Real3& b) {
  const Real3 u = b - a;
  const Real length = u.squaredNorm(), s = length > 0 ? std::clamp<Real>((p - a).dot(u) / length, 0, 1) : 0;
  return (p - a - s * u).norm();
}
Real distance(const MovingVertexFace& q, Real t) {
  const Real3 v = at(q.vertex, t), a = at(q.corner[0], t), b = at(q.corner[1], t), c = at(q.corner[2], t);
  Real least = std::min({to_segment(v, a, b), to_segment(v, b, c), to_segment(v, c, a)});
  const Real3 n = (b - a).cross(c - a);
  if (n.norm() > 0 && n.dot((a - v).cross(b - v)) >= 0 && n.dot((b - v).cross(c - v)) >= 0 &&
      n.dot((c - v).cross(a - v)) >= 0)
    least = std::min(least, std::abs(n.dot(v - a)) / n.norm());
  return least;
}
Real distance(const MovingEdgeEdge& q, Real t) {
  const Real3 a = at(q.first[0], t), b = at(q.first[1], t), c = at(q.second[0], t), d = at(q.second[1], t);
  Real least = std::min({to_segment(a, c, d), to_segment(b, c, d), to_segment(c, a, b), to_segment(d, a, b)});
  const Real3 n = (b - a).cross(d - c);
  const Real area = n.squaredNorm(), s = (c - a).cross(d - c).dot(n), r = (c - a).cross(b - a).dot(n);
  if (area > 0 && s >= 0 && s <= area && r >= 0 && r <= area)
    least = std::min(least, std::abs(n.dot(c - a)) / n.norm());
  return least;
}

// At no sampled time before the answer's are the features closer than r, beyond rounding, and at its time
// they are.
template <class Query>
void compare_with_samples(const Query& query, double r, int samples) {
  constexpr Real rounding = 1e-13L;
  const Result result = first_closeness(query, r);
  const Real end = result ? result->lo : 1;
  for (int i = 0; i < samples && end > 0; ++i) {
    const Real t = end * i / samples;
    ASSERT_GT(distance(query, t), r - rounding) << static_cast<double>(t);
  }
  if (!result)
    EXPECT_GT(distance(query, 1), r - rounding);
  else
    EXPECT_LT(distance(query, end), r + rounding);
  EXPECT_EQ(close_at_start(query, r), result && result->hi == 0);
}

TEST(Closeness, IsNeverContradictedByDistancesAtManyTimes) {
  QueryMaker make{1};
  int close = 0;
  for (int i = 0; i < 1500; ++i) {
    const FourMovingPoints points = i % 3 == 0   ? make.any()
                                    : i % 3 == 1 ? test::vertex_meets_face(make, 0.5, 0.3, 0.3)
                                                 : make.lattice(2);
    const double r = i % 3 == 2 ? 0.5 * make.below(5) : std::exp(make.uniform(-6, 0.5));
    SCOPED_TRACE(text(points, "r = ", r));
    compare_with_samples(query_of<MovingVertexFace>(points), r, 300);
    compare_with_samples(query_of<MovingEdgeEdge>(points), r, 300);
    close += first_closeness(query_of<MovingEdgeEdge>(points), r).has_value();
    if (HasFailure()) return;
  }
  EXPECT_GT(close, 500);
  EXPECT_LT(close, 1250);
}

TEST(Closeness, AgreesWithBruteForceOnSmallIntegers) {
  QueryMaker make{2};
  for (int i = 0; i < 150; ++i) {
    const FourMovingPoints points = make.lattice(1 + i % 3);
    const double r = std::array{0.0, 0.5, 1.0, 1.5, 3.0}[static_cast<std::size_t>(make.below(5))];
    SCOPED_TRACE(text(points, "r = ", r));
    const brute::Four four = brute::moving(points);
    for (const bool vertex_face : {true, false}) {
      const Result result = vertex_face ? first_closeness(query_of<MovingVertexFace>(points), r)
                                        : first_closeness(query_of<MovingEdgeEdge>(points), r);
      const auto expected = brute::first_closeness(four, vertex_face, r);
      ASSERT_EQ(result.has_value(), expected.has_value());
      if (!result) continue;
      EXPECT_LE(mpq_class(result->lo), expected->upper);
      EXPECT_GE(mpq_class(result->hi), expected->lower);
    }
    if (HasFailure()) return;
  }
}

TEST(Closeness, AtDistanceZeroIsContact) {
  QueryMaker make{3};
  for (int i = 0; i < 10'000; ++i) {
    const FourMovingPoints points = make.lattice(1 + i % 3);
    SCOPED_TRACE(text(points));
    const auto compare = [](const auto& query) {
      const Result close = first_closeness(query, 0), touching = first_contact(query);
      ASSERT_EQ(close.has_value(), touching.has_value());
      if (close) {
        EXPECT_EQ(close->lo, touching->lo);
        EXPECT_EQ(close->hi, touching->hi);
      }
    };
    compare(query_of<MovingVertexFace>(points));
    compare(query_of<MovingEdgeEdge>(points));
    if (HasFailure()) return;
  }
}

TEST(Closeness, VertexApproachesInsideEdgeAndCorner) {
  // The inside of the triangle, each edge and each corner.
  expect_at(first_closeness(against_triangle({1, 1, 4}, {1, 1, 0}), 1), 0.75);
  expect_at(first_closeness(against_triangle({1, 1, -4}, {1, 1, 0}), 1), 0.75);
  expect_at(first_closeness(against_triangle({2, -4, 0}, {2, 0, 0}), 1), 0.75);
  expect_at(first_closeness(against_triangle({-4, 2, 0}, {0, 2, 0}), 1), 0.75);
  expect_at(first_closeness(against_triangle({-3, -4, 0}, {0, 0, 0}), 1.25), 0.75);
  expect_at(first_closeness(against_triangle({8, 0, 0}, {4, 0, 0}), 1), 0.75);
  expect_at(first_closeness(against_triangle({0, 8, 0}, {0, 4, 0}), 1), 0.75);
  // Beyond the longest edge; x + y falls from 12 to 4 and the distance is (x + y - 4) / sqrt(2).
  const Result slant = first_closeness(against_triangle({6, 6, 0}, {2, 2, 0}), 1.5);
  ASSERT_TRUE(slant);
  EXPECT_NEAR(slant->lo, 1 - 1.5 * std::sqrt(2) / 8, 1e-15);
  EXPECT_LT(slant->lo, slant->hi);
}

TEST(Closeness, EdgesApproachInTheirInsidesEndsAndParallel) {
  const auto falls = [](const Vec3& c, const Vec3& d, const Vec3& by) {
    return MovingEdgeEdge{{still(0, 0, 0), still(4, 0, 0)}, {{c + 4 * by, c}, {d + 4 * by, d}}};
  };
  const Vec3 z(0, 0, 1);
  expect_at(first_closeness(falls({2, -1, 0}, {2, 1, 0}, z), 1), 0.75);  // insides
  expect_at(first_closeness(falls({2, 0, 0}, {2, 3, 0}, z), 1), 0.75);   // an end and an inside
  expect_at(first_closeness(falls({1, 0, 0}, {3, 0, 0}, z), 1), 0.75);   // parallel, one beside the other
  expect_at(first_closeness(falls({4, 0, 0}, {9, 0, 0}, z), 1), 0.75);   // parallel, end beside end
  expect_at(first_closeness(falls({7, 0, 0}, {9, 0, 0}, z), 5), 0);      // on one line at last
  expect_at(first_closeness(falls({7, 0, 0}, {9, 0, 0}, z), 3), 1);
  EXPECT_FALSE(first_closeness(falls({7, 0, 0}, {9, 0, 0}, z), std::nextafter(3, 0)));
}

TEST(Closeness, CountsAtBothEndsOfTheIntervalAndWhereFeaturesGraze) {
  expect_at(first_closeness(against_triangle({1, 1, 1}, {1, 1, 5}), 1), 0);
  expect_at(first_closeness(against_triangle({1, 1, 5}, {1, 1, 1}), 1), 1);
  EXPECT_FALSE(first_closeness(against_triangle({1, 1, std::nextafter(1, 2)}, {1, 1, 5}), 1));
  EXPECT_FALSE(first_closeness(against_triangle({1, 1, 5}, {1, 1, std::nextafter(1, 2)}), 1));
  // The vertex passes the corner at distance 3, which is its distance at one time alone: a double root.
  expect_at(first_closeness(against_triangle({-3, -4, -4}, {-3, 4, 4}), 3), 0.5);
  EXPECT_FALSE(first_closeness(against_triangle({-3, -4, -4}, {-3, 4, 4}), std::nextafter(3, 0)));
  // At rest exactly at r, and less than exactly.
  expect_at(first_closeness(against_triangle({1, 1, 1}, {1, 1, 1}), 1), 0);
  EXPECT_FALSE(first_closeness(against_triangle({1, 1, 1}, {1, 1, 1}), std::nextafter(1, 0)));
  // The vertex slides at distance 1 over the plane until it is above the triangle, within 1 of it.
  expect_at(first_closeness(against_triangle({-2, 1, 1}, {2, 1, 1}), 1), 0.5);
}

TEST(Closeness, HoldsAtAnySize) {
  for (const double size : {0x1p-1060, 0x1p-600, 0x1p-300, 1.0, 0x1p300, 0x1p1000}) {
    const auto query = against_triangle({1, 1, 4}, {1, 1, 0});
    MovingVertexFace sized = query;
    for (MovingPoint* p : {&sized.vertex, &sized.corner[0], &sized.corner[1], &sized.corner[2]})
      *p = {size * p->start, size * p->end};
    expect_at(first_closeness(sized, size), 0.75);
    EXPECT_FALSE(close_at_start(sized, size));
    EXPECT_TRUE(close_at_start(sized, 4 * size));
  }
  // r^2 underflows, or r is far above the features.
  const Result tiny = first_closeness(against_triangle({1, 1, 1}, {1, 1, -1}), 0x1p-1074);
  ASSERT_TRUE(tiny);
  EXPECT_EQ(tiny->lo, std::nextafter(0.5, 0));
  EXPECT_EQ(tiny->hi, 0.5);
  EXPECT_FALSE(first_closeness(against_triangle({1, 1, 1}, {1, 1, 0x1p-1073}), 0x1p-1074));
  expect_at(first_closeness(against_triangle({1, 1, 1}, {1, 1, 0x1p-1074}), 0x1p-1074), 1);
  expect_at(first_closeness(against_triangle({1, 1, 1}, {1, 1, 1}), 0x1p1023), 0);
}

// Corners, ends and edges change places. Time that runs backwards changes the time but not the verdict.
TEST(Closeness, DoesNotDependOnTheOrderOfPoints) {
  QueryMaker make{5};
  for (int i = 0; i < 500; ++i) {
    const FourMovingPoints p = i % 2 == 0 ? make.lattice(2) : make.any();
    const double r = i % 2 == 0 ? 0.5 * (1 + make.below(3)) : make.uniform(0.01, 0.5);
    SCOPED_TRACE(text(p, "r = ", r));
    const auto same = [&](const Result& a, const Result& b) {
      ASSERT_EQ(a.has_value(), b.has_value());
      if (a) {
        EXPECT_EQ(a->lo, b->lo);
      }
    };
    const Result face = first_closeness(query_of<MovingVertexFace>(p), r);
    same(face, first_closeness(MovingVertexFace{p[0], {p[2], p[1], p[3]}}, r));
    same(face, first_closeness(MovingVertexFace{p[0], {p[3], p[1], p[2]}}, r));
    const Result edge = first_closeness(query_of<MovingEdgeEdge>(p), r);
    same(edge, first_closeness(MovingEdgeEdge{{p[1], p[0]}, {p[2], p[3]}}, r));
    same(edge, first_closeness(MovingEdgeEdge{{p[3], p[2]}, {p[0], p[1]}}, r));
    const FourMovingPoints back = test::reversed(p);
    EXPECT_EQ(face.has_value(), first_closeness(query_of<MovingVertexFace>(back), r).has_value());
    EXPECT_EQ(edge.has_value(), first_closeness(query_of<MovingEdgeEdge>(back), r).has_value());
  }
}

}  // namespace
}  // namespace cscd::exact
