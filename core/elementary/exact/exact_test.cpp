#include "core/elementary/exact/exact.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <string>

#include "core/elementary/exact/test_brute_oracle.h"
#include "core/elementary/question/test_queries.h"

namespace cscd {
namespace {

using exact::first_contact;
using exact::TimeEnclosure;
using test::against_triangle;
using test::FourMovingPoints;
using test::query_of;
using test::still;
using Result = std::optional<TimeEnclosure>;

MovingPoint moving(Vec3 from, Vec3 to) {
  return {from, to};
}

// An edge cd and the edge from (0,0,0) to (4,0,0) at rest.
MovingEdgeEdge against_edge(MovingPoint c, MovingPoint d) {
  return {{still(0, 0, 0), still(4, 0, 0)}, {c, d}};
}

void expect_contact_at(const Result& result, double time) {
  ASSERT_TRUE(result);
  EXPECT_EQ(result->lo, time);
  EXPECT_EQ(result->hi, time);
}

void expect_contact_around(const Result& result, const mpq_class& time) {
  ASSERT_TRUE(result);
  EXPECT_LE(mpq_class(result->lo), time);
  EXPECT_GE(mpq_class(result->hi), time);
  EXPECT_LE(result->hi - result->lo, 0x1p-50);
}

TEST(ExactVertexFace, CrossesTheInterior) {
  expect_contact_at(first_contact(against_triangle({1, 1, 1}, {1, 1, -3})), 0.25);
  expect_contact_around(first_contact(against_triangle({1, 1, 1}, {1, 1, -2})), mpq_class(1, 3));
  EXPECT_FALSE(first_contact(against_triangle({3, 3, 1}, {3, 3, -3})));
  EXPECT_FALSE(first_contact(against_triangle({1, 1, 3}, {1, 1, 1})));
}

TEST(ExactVertexFace, TouchesCornersAndEdges) {
  for (const Vec3& on :
       {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0), Vec3(2, 0, 0), Vec3(0, 1, 0), Vec3(1, 3, 0)}) {
    const Vec3 up(0.5, -0.25, 1);
    expect_contact_at(first_contact(against_triangle(on + up, on - up)), 0.5);
    // A vertex that passes one unit in the last place beyond misses.
    const Vec3 out = on + 0x1p-51 * (on - Vec3(1, 1, 0));
    EXPECT_FALSE(first_contact(against_triangle(out + Vec3(0, 0, 1), out - Vec3(0, 0, 1))));
  }
}

TEST(ExactVertexFace, TouchesExactlyAtTheEndsOfTheInterval) {
  expect_contact_at(first_contact(against_triangle({1, 1, 0}, {1, 1, 5})), 0);
  expect_contact_at(first_contact(against_triangle({1, 1, 5}, {1, 1, 0})), 1);
  EXPECT_FALSE(first_contact(against_triangle({1, 1, 0x1p-1074}, {1, 1, 5})));
  EXPECT_FALSE(first_contact(against_triangle({1, 1, 5}, {1, 1, 0x1p-1074})));
}

TEST(ExactVertexFace, AtRest) {
  expect_contact_at(first_contact(against_triangle({1, 1, 0}, {1, 1, 0})), 0);
  expect_contact_at(first_contact(against_triangle({2, 2, 0}, {2, 2, 0})), 0);
  EXPECT_FALSE(first_contact(against_triangle({1, 1, 0x1p-1074}, {1, 1, 0x1p-1074})));
  EXPECT_FALSE(
      first_contact(against_triangle({2, std::nextafter(2.0, 3.0), 0}, {2, std::nextafter(2.0, 3.0), 0})));
}

TEST(ExactVertexFace, CoplanarThroughout) {
  expect_contact_at(first_contact(against_triangle({-1, 1, 0}, {3, 1, 0})), 0.25);
  expect_contact_around(first_contact(against_triangle({-1, 1, 0}, {2, 1, 0})), mpq_class(1, 3));
  expect_contact_at(first_contact(against_triangle({8, 0, 0}, {0, 0, 0})),
                    0.5);  // the vertex moves along the line of an edge
  EXPECT_FALSE(first_contact(against_triangle({-1, 1, 0}, {-1, 9, 0})));
  // The vertex passes through the corner (0,4,0) exactly, then misses the corner by little.
  expect_contact_at(first_contact(against_triangle({-1, 4, 0}, {1, 4, 0})), 0.5);
  EXPECT_FALSE(first_contact(against_triangle({-1, std::nextafter(4, 5), 0}, {1, std::nextafter(4, 5), 0})));
}

TEST(ExactVertexFace, CoplanarThroughoutInATurningPlane) {
  // All four points stay in the plane through the y axis and (1, 0, t).
  const auto at = [](double x, double y) { return moving({x, y, 0}, {x, y, x}); };
  const MovingVertexFace inside{at(1, 1), {at(0, 0), at(4, 0), at(0, 4)}};
  expect_contact_at(first_contact(inside), 0);
  const MovingVertexFace outside{at(3, 3), {at(0, 0), at(4, 0), at(0, 4)}};
  EXPECT_FALSE(first_contact(outside));
  const MovingVertexFace enters{moving({1, -1, 0}, {1, 1, 1}), {at(0, 0), at(4, 0), at(0, 4)}};
  expect_contact_at(first_contact(enters), 0.5);
}

TEST(ExactVertexFace, DegenerateTriangles) {
  const MovingPoint a = still(0, 0, 0), b = still(4, 0, 0), between = still(1, 0, 0);
  const MovingPoint through = moving({3, 1, 0}, {3, -1, 0}), beside = moving({5, 1, 0}, {5, -1, 0});
  const MovingPoint onto_a = moving({0, 0, 1}, {0, 0, -3});
  for (const MovingPoint& third : {a, b, between}) {
    MovingPoint corner[3] = {a, b, third};
    for (int turn = 0; turn < 3; ++turn) {
      std::rotate(corner, corner + 1, corner + 3);
      expect_contact_at(first_contact(MovingVertexFace{through, {corner[0], corner[1], corner[2]}}), 0.5);
      EXPECT_FALSE(first_contact(MovingVertexFace{beside, {corner[0], corner[1], corner[2]}}));
    }
  }
  expect_contact_at(first_contact(MovingVertexFace{onto_a, {a, a, a}}), 0.25);
  EXPECT_FALSE(first_contact(MovingVertexFace{through, {a, a, a}}));
  // The triangle is a segment at t = 1/2 only. The first vertex lies in the triangle's plane throughout, on
  // the segment's line beyond its end. The second vertex crosses the segment.
  const MovingPoint flips = moving({0, 4, 0}, {0, -4, 0});
  EXPECT_FALSE(first_contact(MovingVertexFace{still(5, 0, 0), {a, b, flips}}));
  expect_contact_at(first_contact(MovingVertexFace{moving({3, -1, 0}, {3, 1, 0}), {a, b, flips}}), 0.5);
}

TEST(ExactVertexFace, GrazesWithADoubleRoot) {
  // The points a = (0,0,0), b = (1,0,3t-1), c = (0,1,0) and v = (3t-1, y, 0) are coplanar where (3t-1)^2 = 0.
  const MovingPoint a = still(0, 0, 0), c = still(0, 1, 0), b = moving({1, 0, -1}, {1, 0, 2});
  expect_contact_around(first_contact(MovingVertexFace{moving({-1, 0.5, 0}, {2, 0.5, 0}), {a, b, c}}),
                        mpq_class(1, 3));
  EXPECT_FALSE(first_contact(MovingVertexFace{moving({-1, 1.5, 0}, {2, 1.5, 0}), {a, b, c}}));
}

TEST(ExactVertexFace, TripleRoot) {
  // The triangle shrinks to its corner at t = 1/3 while the vertex crosses its plane.
  const MovingPoint a = still(0, 0, 0), b = moving({-1, 0, 0}, {2, 0, 0}), c = moving({0, -1, 0}, {0, 2, 0});
  expect_contact_around(first_contact(MovingVertexFace{moving({0, 0, -1}, {0, 0, 2}), {a, b, c}}),
                        mpq_class(1, 3));
  EXPECT_FALSE(first_contact(MovingVertexFace{moving({0, 1, -1}, {0, 1, 2}), {a, b, c}}));
}

TEST(ExactVertexFace, FirstOfTwoRootsMisses) {
  // The triangle swings. The vertex is in the triangle's plane twice.
  const MovingPoint a = still(0, 0, 0), c = still(0, 4, 0), b = moving({4, 0, -2}, {4, 0, 2});
  // For v - a = (x, y, z) the points are coplanar where 4 z = x b_z(t) = x (4t - 2). With x = 8t - 2 and
  // z = 0 this is so at t = 1/4 and t = 1/2. With y = 1 the vertex is on an edge at t = 1/4.
  expect_contact_at(first_contact(MovingVertexFace{moving({-2, 1, 0}, {6, 1, 0}), {a, b, c}}), 0.25);
  // With y from -1.5 to 2.5 the vertex is outside at t = 1/4, on the line of the edge, and inside at t = 1/2.
  expect_contact_at(first_contact(MovingVertexFace{moving({-2, -1.5, 0}, {6, 2.5, 0}), {a, b, c}}), 0.5);
}

TEST(ExactVertexFace, LeavesOneUlpBeforeOrAfterTouching) {
  // The vertex is inside as long as x = 1 - 2t >= 0, and in the plane at t = z. It leaves the triangle at
  // t = 1/2, one ulp after or before it is in the plane.
  constexpr double ulp = 0x1p-53;
  const auto passing = [](double z) { return against_triangle({1, 1, z}, {-1, 1, z - 1}); };
  expect_contact_at(first_contact(passing(0.5 - ulp)), 0.5 - ulp);
  expect_contact_at(first_contact(passing(0.5)), 0.5);
  EXPECT_FALSE(first_contact(passing(0.5 + ulp)));
}

TEST(ExactVertexFace, TwoRootsOneUlpApart) {
  // The plane is level at t = 1/2, when the vertex is still outside. The vertex reaches the edge one ulp
  // later.
  constexpr double ulp = 0x1p-53;
  const MovingPoint a = still(0, 0, 0), c = still(0, 4, 0), b = moving({4, 0, -2}, {4, 0, 2});
  expect_contact_at(first_contact(MovingVertexFace{moving({-0.5 - ulp, 1, 0}, {0.5 - ulp, 1, 0}), {a, b, c}}),
                    0.5 + ulp);
  EXPECT_FALSE(first_contact(MovingVertexFace{moving({-0.5 - ulp, -1, 0}, {0.5 - ulp, -1, 0}), {a, b, c}}));
}

TEST(ExactEdgeEdge, Crosses) {
  expect_contact_at(
      first_contact(against_edge(moving({1, -1, 1}, {1, -1, -3}), moving({1, 1, 1}, {1, 1, -3}))), 0.25);
  EXPECT_FALSE(first_contact(against_edge(moving({5, -1, 1}, {5, -1, -3}), moving({5, 1, 1}, {5, 1, -3}))));
  EXPECT_FALSE(first_contact(against_edge(moving({1, 1, 1}, {1, 1, -3}), moving({1, 3, 1}, {1, 3, -3}))));
}

TEST(ExactEdgeEdge, TouchesEndsAndEndsOfTheInterval) {
  const auto drop = [](double x, double y) { return moving({x, y, 1}, {x, y, -1}); };
  expect_contact_at(first_contact(against_edge(drop(0, 0), drop(-1, 3))), 0.5);  // end on end
  expect_contact_at(first_contact(against_edge(drop(2, 0), drop(-1, 3))), 0.5);  // end on interior
  expect_contact_at(first_contact(against_edge(drop(4, -1), drop(4, 1))), 0.5);  // interior on end
  const double beyond = std::nextafter(4, 5);
  EXPECT_FALSE(first_contact(against_edge(drop(beyond, -1), drop(beyond, 1))));
  const auto settle = [](double x, double y) { return moving({x, y, 1}, {x, y, 0}); };
  expect_contact_at(first_contact(against_edge(settle(1, -1), settle(1, 1))), 1);
  const auto rise = [](double x, double y) { return moving({x, y, 0}, {x, y, 1}); };
  expect_contact_at(first_contact(against_edge(rise(1, -1), rise(1, 1))), 0);
}

TEST(ExactEdgeEdge, Parallel) {
  const auto drop = [](double x) { return moving({x, 0, 1}, {x, 0, -3}); };
  expect_contact_at(first_contact(against_edge(drop(1), drop(2))), 0.25);
  expect_contact_at(first_contact(against_edge(drop(4), drop(7))), 0.25);
  expect_contact_at(first_contact(against_edge(drop(7), drop(-7))), 0.25);
  EXPECT_FALSE(first_contact(against_edge(drop(5), drop(7))));
  EXPECT_FALSE(first_contact(against_edge(still(0, 0, 1), still(4, 0, 1))));
}

TEST(ExactEdgeEdge, Collinear) {
  const auto slide = [](double from, double to) { return moving({from, 0, 0}, {to, 0, 0}); };
  expect_contact_at(first_contact(against_edge(slide(6, 2), slide(8, 4))), 0.5);
  expect_contact_around(first_contact(against_edge(slide(5, 2), slide(8, 5))), mpq_class(1, 3));
  EXPECT_FALSE(first_contact(against_edge(slide(6, 5), slide(8, 7))));
  expect_contact_at(first_contact(against_edge(slide(1, 1), slide(2, 2))), 0);
}

TEST(ExactEdgeEdge, CoplanarThroughout) {
  const auto in_plane = [](double x0, double y0, double x1, double y1) {
    return moving({x0, y0, 0}, {x1, y1, 0});
  };
  expect_contact_at(first_contact(against_edge(in_plane(1, 1, 1, -3), in_plane(2, 3, 2, -1))), 0.25);
  EXPECT_FALSE(first_contact(against_edge(in_plane(5, 1, 5, -3), in_plane(6, 3, 6, -1))));
  // The edge turns about (5, 0) without reaching the other edge.
  EXPECT_FALSE(first_contact(against_edge(still(5, 0, 0), in_plane(5, 2, 7, 0))));
}

TEST(ExactEdgeEdge, ZeroLength) {
  const auto drop = [](double x, double y) { return moving({x, y, 1}, {x, y, -1}); };
  expect_contact_at(first_contact(against_edge(drop(1, 0), drop(1, 0))), 0.5);
  EXPECT_FALSE(first_contact(against_edge(drop(1, 1), drop(1, 1))));
  EXPECT_FALSE(first_contact(against_edge(drop(5, 0), drop(5, 0))));
  const MovingEdgeEdge points{{still(0, 0, 0), still(0, 0, 0)}, {drop(0, 0), drop(0, 0)}};
  expect_contact_at(first_contact(points), 0.5);
  // The edge shrinks to a point at t = 1/2 as it passes.
  expect_contact_at(
      first_contact(against_edge(moving({1, 1, 1}, {1, -1, -1}), moving({1, -1, 1}, {1, 1, -1}))), 0.5);
}

TEST(ExactOracle, ExtremeCoordinates) {
  for (const double scale : {0x1p-1060, 0x1p-997, 0x1p-300, 0x1p498, 0x1p1020}) {
    const auto p = [&](double x, double y, double z0, double z1) {
      return moving(scale * Vec3(x, y, z0), scale * Vec3(x, y, z1));
    };
    const MovingPoint a = p(0, 0, 0, 0), b = p(4, 0, 0, 0), c = p(0, 4, 0, 0);
    expect_contact_at(first_contact(MovingVertexFace{p(1, 1, 1, -3), {a, b, c}}), 0.25);
    expect_contact_at(first_contact(MovingVertexFace{p(1, 1, 0, 0), {a, b, c}}), 0);
    EXPECT_FALSE(first_contact(MovingVertexFace{p(3, 3, 1, -3), {a, b, c}}));
    expect_contact_at(first_contact(MovingEdgeEdge{{a, b}, {p(1, -1, 1, -3), p(1, 1, 1, -3)}}), 0.25);
    EXPECT_FALSE(first_contact(MovingEdgeEdge{{a, b}, {p(5, -1, 1, -3), p(5, 1, 1, -3)}}));
  }
  // A vertex makes a subnormal step at a triangle that is 1e150 wide.
  const double tiny = 0x1p-1074, huge = 1e150;
  const MovingPoint a = still(-huge, -huge, 0), b = still(huge, -huge, 0), c = still(0, huge, 0);
  expect_contact_at(first_contact(MovingVertexFace{moving({0, 0, tiny}, {0, 0, -tiny}), {a, b, c}}), 0.5);
  EXPECT_FALSE(first_contact(MovingVertexFace{moving({0, 0, 2 * tiny}, {0, 0, tiny}), {a, b, c}}));
  expect_contact_around(first_contact(MovingVertexFace{moving({0, 0, tiny}, {0, 0, -huge}), {a, b, c}}),
                        mpq_class(tiny) / (mpq_class(tiny) + mpq_class(huge)));
}

TEST(ExactOracle, FarFromTheOrigin) {
  const Vec3 far(0x1p50, -0x1p49, 0x1p51);
  const auto p = [&](double x, double y, double z0, double z1) {
    return moving(far + Vec3(x, y, z0), far + Vec3(x, y, z1));
  };
  const MovingPoint a = p(0, 0, 0, 0), b = p(4, 0, 0, 0), c = p(0, 4, 0, 0);
  expect_contact_around(first_contact(MovingVertexFace{p(1, 1, 1, -2), {a, b, c}}), mpq_class(1, 3));
  EXPECT_FALSE(first_contact(MovingVertexFace{p(2.25, 2, 1, -2), {a, b, c}}));
  expect_contact_around(first_contact(MovingEdgeEdge{{a, b}, {p(1, -1, 1, -2), p(1, 1, 1, -2)}}),
                        mpq_class(1, 3));
}

// Random queries on small integers, in which every degeneracy comes up again and again.

enum class Family { general, flat, resting, tight, translating, count_ };

struct Lattice {
  std::mt19937_64 random;
  int in(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); }
  Vec3 point(int reach) { return Vec3(in(-reach, reach), in(-reach, reach), in(-reach, reach)); }

  FourMovingPoints query(Family family) {
    const int reach = family == Family::tight ? 1 : 2;
    FourMovingPoints points;
    for (MovingPoint& p : points) p = {point(reach), point(reach)};
    if (family == Family::flat)
      for (MovingPoint& p : points) p.start.z() = p.end.z() = 0;
    if (family == Family::resting)
      for (MovingPoint& p : points) p.end = p.start;
    if (family == Family::translating)
      for (std::size_t i = 1; i < 4; ++i) points[i].end = points[i].start;
    return points;
  }
};

void compare_with_brute_force(const FourMovingPoints& query, const Result& result,
                              const brute::Predicate& predicate) {
  const brute::Four points = brute::moving(query);
  const auto events = predicate.events(points);
  const auto expected = brute::first_contact(points, predicate);
  ASSERT_EQ(result.has_value(), expected.has_value());
  // A contact before the reported time would contradict both oracles, even where they agree.
  for (int i = 0; i <= 16; ++i) {
    const mpq_class t(i, 16);
    if (!result || t < mpq_class(result->lo)) {
      EXPECT_FALSE(brute::touches_at(events, predicate, t)) << t;
    }
  }
  if (!result) return;
  EXPECT_LE(result->lo, result->hi);
  EXPECT_LE(result->hi - result->lo, 0x1p-50);
  EXPECT_LE(expected->lower, mpq_class(result->hi));
  EXPECT_GE(expected->upper, mpq_class(result->lo));
}

TEST(ExactOracle, AgreesWithBruteForceOnSmallIntegers) {
  constexpr unsigned seed = 20240611;
  constexpr int cases = 400;
  Lattice lattice{std::mt19937_64(seed)};
  for (int f = 0; f < static_cast<int>(Family::count_); ++f) {
    int touching[2] = {0, 0};
    for (int i = 0; i < cases; ++i) {
      const auto query = lattice.query(static_cast<Family>(f));
      SCOPED_TRACE("seed " + std::to_string(seed) + " family " + std::to_string(f) + " case " +
                   std::to_string(i) + ": " + test::text(query));
      const Result vf = first_contact(query_of<MovingVertexFace>(query)),
                   ee = first_contact(query_of<MovingEdgeEdge>(query));
      compare_with_brute_force(query, vf, brute::kVertexTriangle);
      compare_with_brute_force(query, ee, brute::kEdgeEdge);
      touching[0] += vf.has_value();
      touching[1] += ee.has_value();
      if (HasFatalFailure()) return;
    }
    // The comparison means something only if both answers come up.
    for (const int count : touching) {
      EXPECT_GT(count, cases / 100) << "family " << f;
      EXPECT_LT(count, cases) << "family " << f;
    }
  }
}

void expect_same(const Result& a, const Result& b) {
  ASSERT_EQ(a.has_value(), b.has_value());
  if (!a) return;
  EXPECT_EQ(a->lo, b->lo);
  EXPECT_EQ(a->hi, b->hi);
}

TEST(ExactOracle, KeepsItsAnswerUnderSymmetries) {
  constexpr unsigned seed = 7;
  Lattice lattice{std::mt19937_64(seed)};
  for (int i = 0; i < 4000; ++i) {
    const auto q = lattice.query(static_cast<Family>(i % static_cast<int>(Family::count_)));
    SCOPED_TRACE("seed " + std::to_string(seed) + " case " + std::to_string(i) + ": " + test::text(q));
    const Result vf = first_contact(query_of<MovingVertexFace>(q)),
                 ee = first_contact(query_of<MovingEdgeEdge>(q));

    expect_same(vf, first_contact(MovingVertexFace{q[0], {q[2], q[3], q[1]}}));
    expect_same(vf, first_contact(MovingVertexFace{q[0], {q[3], q[1], q[2]}}));
    expect_same(vf, first_contact(MovingVertexFace{q[0], {q[2], q[1], q[3]}}));
    expect_same(ee, first_contact(MovingEdgeEdge{{q[2], q[3]}, {q[0], q[1]}}));
    expect_same(ee, first_contact(MovingEdgeEdge{{q[1], q[0]}, {q[2], q[3]}}));
    expect_same(ee, first_contact(MovingEdgeEdge{{q[0], q[1]}, {q[3], q[2]}}));

    const auto mapped = [&](const auto& map) { return test::mapped(q, map); };
    const Vec3 shift(1 << 20, -12345.5, 0x1p-20);
    for (const auto& same : {mapped([&](const Vec3& p) { return Vec3(p + shift); }),
                             mapped([](const Vec3& p) { return Vec3(0x1p-900 * p); }),
                             mapped([](const Vec3& p) { return Vec3(0x1p900 * p); }),
                             mapped([](const Vec3& p) { return Vec3(-p); }),
                             mapped([](const Vec3& p) { return Vec3(p.y(), p.z(), p.x()); })}) {
      expect_same(vf, first_contact(query_of<MovingVertexFace>(same)));
      expect_same(ee, first_contact(query_of<MovingEdgeEdge>(same)));
    }

    const FourMovingPoints reversed = test::reversed(q);
    const Result vf_back = first_contact(query_of<MovingVertexFace>(reversed)),
                 ee_back = first_contact(query_of<MovingEdgeEdge>(reversed));
    EXPECT_EQ(vf.has_value(), vf_back.has_value());
    EXPECT_EQ(ee.has_value(), ee_back.has_value());
    // The first contact of the reversed motion is the last contact, which is not before the first.
    if (vf && vf_back) {
      EXPECT_GE(1 - vf_back->lo, vf->lo);
    }
    if (ee && ee_back) {
      EXPECT_GE(1 - ee_back->lo, ee->lo);
    }
    if (HasFailure()) return;
  }
}

TEST(ExactOracle, IrrationalTimes) {
  // The triangle's plane is z = t x. The vertex at x = t, z = 1/2 meets the plane at the square root of 1/2.
  const MovingVertexFace query{moving({0, 0, 0.5}, {1, 0, 0.5}),
                               {still(0, -1, 0), moving({1, 0, 0}, {1, 0, 1}), still(0, 1, 0)}};
  const Result result = first_contact(query);
  ASSERT_TRUE(result);
  EXPECT_LT(mpq_class(result->lo) * result->lo, mpq_class(1, 2));
  EXPECT_GT(mpq_class(result->hi) * result->hi, mpq_class(1, 2));
  EXPECT_EQ(result->hi, std::nextafter(result->lo, 1));
}

}  // namespace
}  // namespace cscd
