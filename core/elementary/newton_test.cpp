#include <chrono>
#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <utility>

#include "core/elementary/exact/exact.h"
#include "core/elementary/published.h"
#include "core/elementary/question/filter.h"
#include "core/elementary/question/test_queries.h"

namespace cscd {
namespace {

using test::against_triangle;
using test::FourMovingPoints;
using test::query_of;
using test::QueryMaker;
using test::still;
using test::text;

Answer newton(const MovingVertexFace& q) {
  return newton_vertex_face(q);
}
Answer newton(const MovingEdgeEdge& q) {
  return newton_edge_edge(q);
}

// Compares newton's answers to a family of queries with the oracle's.
struct OracleComparison {
  int contacts = 0, misses = 0, false_alarms = 0, undecided = 0;
  double largest_time_error = 0;
  std::string first_miss, first_false_alarm;

  template <class Query>
  void add(const FourMovingPoints& points) {
    const Query query = query_of<Query>(points);
    const auto truth = exact::first_contact(query);
    const Answer answer = newton(query);
    contacts += truth.has_value();
    undecided += answer.verdict == Verdict::undecided;
    if (!truth && answer.verdict == Verdict::contact && false_alarms++ == 0)
      first_false_alarm = text(points, "touch at ", answer.time);
    if (truth && answer.verdict == Verdict::apart && misses++ == 0)
      first_miss = text(points, "touch at ", truth->lo);
    if (truth && answer.verdict == Verdict::contact)
      largest_time_error = std::max(largest_time_error, std::abs(answer.time - truth->lo));
    // The time of `undecided` is a lower bound, up to the rounding of double precision.
    if (truth && answer.verdict == Verdict::undecided) {
      EXPECT_LE(answer.time, truth->hi + 1e-6) << text(points, "touch at ", truth->lo);
    }
  }
  void expect_spotless() const {
    EXPECT_EQ(misses, 0) << first_miss;
    EXPECT_EQ(false_alarms, 0) << first_false_alarm;
    EXPECT_EQ(undecided, 0);
    EXPECT_LT(largest_time_error, 1e-9);
  }
};

class Newton : public testing::Test {
 protected:
  QueryMaker make_{7};
};

TEST_F(Newton, AgreesWithTheOracleOnQueriesOfNoParticularKind) {
  OracleComparison vf, ee;
  for (int i = 0; i < 6000; ++i) {
    vf.add<MovingVertexFace>(make_.any());
    ee.add<MovingEdgeEdge>(make_.any());
  }
  vf.expect_spotless();
  ee.expect_spotless();
  EXPECT_GT(vf.contacts, 200);
  EXPECT_GT(ee.contacts, 200);
}

TEST_F(Newton, AgreesWithTheOracleWhereFeaturesCross) {
  OracleComparison vf, ee;
  for (int i = 0; i < 3000; ++i) {
    const double t = make_.uniform(0.01, 0.99), u = make_.uniform(0.01, 0.49), v = make_.uniform(0.01, 0.49);
    vf.add<MovingVertexFace>(test::vertex_meets_face(make_, t, u, v));
    ee.add<MovingEdgeEdge>(test::edge_meets_edge(make_, t, 2 * u, 2 * v));
  }
  vf.expect_spotless();
  ee.expect_spotless();
  EXPECT_EQ(vf.contacts, 3000);
  EXPECT_EQ(ee.contacts, 3000);
}

// Features touch or miss at any of their borders, by a hundred thousandth of the feature's size.
TEST_F(Newton, AgreesWithTheOracleWhereFeaturesGraze) {
  OracleComparison vf, ee;
  for (int i = 0; i < 3000; ++i) {
    const double t = make_.uniform(0.05, 0.95), hair = i % 2 ? 1e-5 : -1e-5;
    const double along = make_.uniform(0.1, 0.9);
    const double sides[3][2] = {{along, hair}, {hair, along}, {along - hair, 1 - along}};
    const double(&s)[2] = sides[i % 3];
    vf.add<MovingVertexFace>(test::vertex_meets_face(make_, t, s[0], s[1]));
    const double end = i % 3 ? hair : 1 - hair;
    ee.add<MovingEdgeEdge>(i % 4 < 2 ? test::edge_meets_edge(make_, t, end, along)
                                     : test::edge_meets_edge(make_, t, along, end));
  }
  vf.expect_spotless();
  ee.expect_spotless();
  for (const OracleComparison* comparison : {&vf, &ee}) {
    EXPECT_GT(comparison->contacts, 1000);
    EXPECT_LT(comparison->contacts, 2000);
  }
}

// Rules degenerate and closed-interval. Small integer coordinates meet every degenerate case.
TEST_F(Newton, NeverSaysApartOfDegenerateFeaturesThatTouch) {
  OracleComparison vf, ee;
  for (int i = 0; i < 12'000; ++i) {
    vf.add<MovingVertexFace>(make_.lattice(1 + i % 3));
    ee.add<MovingEdgeEdge>(make_.lattice(1 + i % 3));
  }
  EXPECT_EQ(vf.misses, 0) << vf.first_miss;
  EXPECT_EQ(ee.misses, 0) << ee.first_miss;
  EXPECT_EQ(vf.false_alarms, 0) << vf.first_false_alarm;
  EXPECT_EQ(ee.false_alarms, 0) << ee.first_false_alarm;
  for (const OracleComparison* comparison : {&vf, &ee}) EXPECT_GT(comparison->contacts, 3000);
  RecordProperty("undecided of 12000, vertex-face", vf.undecided);
  RecordProperty("undecided of 12000, edge-edge", ee.undecided);
}

template <class Query>
void expect_not_apart(const Query& query) {
  ASSERT_TRUE(exact::first_contact(query));
  EXPECT_NE(newton(query).verdict, Verdict::apart);
}

TEST_F(Newton, ContactAtTheEndsOfTheIntervalCounts) {
  for (const Vec3& on : {Vec3(1, 1, 0), Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(2, 2, 0), Vec3(0, 4, 0)}) {
    for (const Vec3& away : {Vec3(0, 0, 1), Vec3(0.25, 0.5, -2), Vec3(-1, -1, 1e-3)}) {
      const Answer start = newton(against_triangle(on, on + away)),
                   end = newton(against_triangle(on + away, on));
      EXPECT_EQ(start.verdict, Verdict::contact);
      EXPECT_EQ(start.time, 0);
      EXPECT_EQ(end.verdict, Verdict::contact);
      EXPECT_NEAR(end.time, 1, 1e-9);
    }
  }
}

// The features are coplanar throughout.
TEST_F(Newton, ContactAtTheEndsOfTheIntervalCountsInThePlane) {
  for (const Vec3& on : {Vec3(0, 1, 0), Vec3(0, 0, 0), Vec3(2, 2, 0), Vec3(3, 0, 0)}) {
    const Vec3 out = 2.5 * on - Vec3(1.5, 1.5, 0);
    expect_not_apart(against_triangle(out, on));
    expect_not_apart(against_triangle(on, out));
  }
  for (int i = 0; i < 2000; ++i) {
    const double u = make_.uniform(0, 4);
    const Vec3 on[3] = {Vec3(0, u, 0), Vec3(u, 0, 0), Vec3(u, 4 - u, 0)};
    const Vec3 to = on[i % 3], from = to + make_.uniform(0.1, 3) * (to - Vec3(1.3, 1.3, 0));
    const MovingVertexFace query = against_triangle(from, to);
    if (exact::first_contact(query)) {
      EXPECT_NE(newton(query).verdict, Verdict::apart) << from.transpose() << " -> " << to.transpose();
    }
  }
}

// The vertex reaches a border that moves in the plane at t = 1 exactly. The root is computed from all four
// points, so it may be rounded past 1.
TEST_F(Newton, ContactAtTheEndWithAMovingBorderInThePlane) {
  int at_the_end = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto flat = [&] { return Vec3(make_.uniform(), make_.uniform(), 0); };
    const double along = make_.uniform(0.1, 0.9);
    const MovingVertexFace query{{flat(), {along, along, 0}},
                                 {{flat(), {0, 0, 0}}, {flat(), {1, 1, 0}}, {flat(), {1, 0, 0}}}};
    const auto truth = exact::first_contact(query);
    ASSERT_TRUE(truth);
    at_the_end += truth->lo == 1;
    EXPECT_NE(newton(query).verdict, Verdict::apart);
  }
  EXPECT_GT(at_the_end, 100);
}

// The vertex comes to the plane, touches it and turns back. This is a double root of the coplanarity cubic,
// and only half of the digits of such a root are known.
TEST_F(Newton, DoubleRootsAreContactOrUndecided) {
  for (const double t : {0.5, 0.25, 1.0 / 3, 0.7}) {
    for (const Vec3& on : {Vec3(1, 1, 0), Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(2, 2, 0), Vec3(1, 0, 0)}) {
      for (const Vec3& slide : {Vec3(0, 0, 0), Vec3(1, -2, 0), Vec3(-3, 1, 0)}) {
        const auto path = [&](const Vec3& x, const Vec3& speed) {
          return MovingPoint{x - t * speed, x + (1 - t) * speed};
        };
        // The triangle tilts about its corner at the origin as fast as the vertex slides. At that corner
        // the height of the vertex is of second order in time.
        const MovingVertexFace query{path(on, slide),
                                     {path({0, 0, 0}, {0, 0, 0}), path({4, 0, 0}, {0, 0, slide.x()}),
                                      path({0, 4, 0}, {0, 0, slide.y()})}};
        if (exact::first_contact(query)) {
          EXPECT_NE(newton(query).verdict, Verdict::apart) << on.transpose() << ", " << slide.transpose();
        }
      }
    }
  }
}

// Double roots occur at corners and borders in general position. Touching is judged with a root that is off
// by 1e-8.
TEST_F(Newton, DoubleRootsAtBordersAreContactOrUndecided) {
  int touching = 0, missed = 0;
  for (int i = 0; i < 4000; ++i) {
    const auto dyadic = [&] { return make_.below(65) / 32.0 - 1; };
    const auto vec = [&] { return Vec3(dyadic(), dyadic(), dyadic()); };
    const double t = (1 + make_.below(7)) / 8.0;
    const Vec3 a = vec(), b = vec(), c = vec();
    const double u = make_.below(3) / 2.0, v = make_.below(2) * (1 - u);
    const Vec3 x = a + u * (b - a) + v * (c - a);
    // To first order, all points slide within the plane at time t, so the height of the vertex has a double
    // root there.
    const Vec3 n = (b - a).cross(c - a);
    const double wb = dyadic(), wc = dyadic();
    const Vec3 slide = dyadic() * (b - a) + dyadic() * (c - a);
    const Vec3 height = u * wb * n + v * wc * n;
    const auto path = [&](const Vec3& p, const Vec3& speed) {
      return MovingPoint{p - t * speed, p + (1 - t) * speed};
    };
    const MovingVertexFace query{path(x, slide + height),
                                 {path(a, Vec3::Zero()), path(b, wb * n), path(c, wc * n)}};
    if (!exact::first_contact(query)) continue;
    ++touching;
    missed += newton(query).verdict == Verdict::apart;
  }
  EXPECT_GT(touching, 1000);
  EXPECT_EQ(missed, 0);
}

TEST_F(Newton, ZeroMotionInContact) {
  expect_not_apart(against_triangle({1, 1, 0}, {1, 1, 0}));
  expect_not_apart(against_triangle({0, 0, 0}, {0, 0, 0}));
  EXPECT_EQ(newton(against_triangle({1, 1, 1}, {1, 1, 1})).verdict, Verdict::apart);
  EXPECT_EQ(newton(against_triangle({9, 9, 0}, {9, 9, 0})).verdict, Verdict::apart);
  expect_not_apart(MovingEdgeEdge{{still(0, 0, 0), still(4, 0, 0)}, {still(1, -1, 0), still(1, 1, 0)}});
  expect_not_apart(MovingEdgeEdge{{still(0, 0, 0), still(4, 0, 0)}, {still(1, 0, 0), still(9, 0, 0)}});
}

// All points move in the plane z = 0 and the triangle turns over in it, so the normals at both ends cancel.
TEST_F(Newton, ATriangleThatTurnsInsideOutInItsPlane) {
  const MovingVertexFace query{{{-1, 1, 0}, {3, 1, 0}},
                               {{{0, 0, 0}, {0, 0, 0}}, {{4, 0, 0}, {4, 0, 0}}, {{0, 4, 0}, {0, -4, 0}}}};
  expect_not_apart(query);
}

// Edges that slide along one line meet end to end.
TEST_F(Newton, EdgesThatSlideAlongOneLine) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto on = [&](double from, double to) {
      MovingPoint p{{1, 1, 1}, {1, 1, 1}};
      p.start[axis] = from;
      p.end[axis] = to;
      return p;
    };
    expect_not_apart(MovingEdgeEdge{{on(0, 0), on(1, 1)}, {on(4, 0.5), on(5, 1.5)}});
    expect_not_apart(MovingVertexFace{on(-3, 2), {on(0, 0), on(1, 1), on(2, 2)}});
  }
  const auto diagonal = [](double from, double to) {
    return MovingPoint{from * Vec3(1, 2, 3), to * Vec3(1, 2, 3)};
  };
  expect_not_apart(MovingEdgeEdge{{diagonal(0, 0), diagonal(1, 1)}, {diagonal(4, 0.5), diagonal(5, 1.5)}});
}

TEST_F(Newton, CollapsedFeatures) {
  const MovingPoint falls{{1, 1, 1}, {1, 1, -1}}, far{{9, 9, 9}, {9, 9, 8}};
  // An edge without length falls onto an edge, and a vertex falls onto triangles without area.
  expect_not_apart(MovingEdgeEdge{{falls, falls}, {still(0, 1, 0), still(4, 1, 0)}});
  expect_not_apart(MovingVertexFace{falls, {still(0, 1, 0), still(4, 1, 0), still(2, 1, 0)}});
  expect_not_apart(MovingVertexFace{falls, {still(1, 1, 0), still(1, 1, 0), still(1, 1, 0)}});
  // The relative boxes prove these features apart, whatever the cubic says.
  EXPECT_EQ(newton(MovingEdgeEdge{{far, far}, {still(0, 1, 0), still(4, 1, 0)}}).verdict, Verdict::apart);
  EXPECT_EQ(newton(MovingVertexFace{far, {still(1, 1, 0), still(1, 1, 0), still(1, 1, 0)}}).verdict,
            Verdict::apart);
}

// If products of coordinates underflow or overflow, the answers equal those at the size of 1.
TEST_F(Newton, ScalesWhatIsBeyondTheRange) {
  for (const double scale : {0x1p-1000, 0x1p-660, 0x1p-370, 0x1p330, 0x1p365, 0x1p530, 0x1p1019}) {
    int contacts = 0;
    for (int i = 0; i < 200; ++i) {
      // Shorten the coordinates, so that their last bit survives the smallest scale.
      FourMovingPoints p = test::vertex_meets_face(make_, 0.5, make_.uniform(-0.2, 0.4), 0.25);
      FourMovingPoints beyond = p;
      for (std::size_t k = 0; k < 4; ++k) {
        const auto shortened = [](const Vec3& x) { return Vec3((x * 0x1p20).array().round() * 0x1p-20); };
        p[k] = {shortened(p[k].start), shortened(p[k].end)};
        beyond[k] = {scale * p[k].start, scale * p[k].end};
      }
      const auto expect_same = [&](const Answer& here, const Answer& there) {
        ASSERT_EQ(here.verdict, there.verdict) << scale;
        if (here.verdict != Verdict::apart) {
          ASSERT_EQ(here.time, there.time) << scale;
        }
        contacts += here.verdict == Verdict::contact;
      };
      expect_same(newton(query_of<MovingVertexFace>(p)), newton(query_of<MovingVertexFace>(beyond)));
      expect_same(newton(query_of<MovingEdgeEdge>(p)), newton(query_of<MovingEdgeEdge>(beyond)));
      expect_same(newton_float_vertex_face(query_of<MovingVertexFace>(p)),
                  newton_float_vertex_face(query_of<MovingVertexFace>(beyond)));
    }
    EXPECT_GT(contacts, 100);
  }
}

// The scales are too far apart for products in double precision. Nothing is known then, so nothing may be
// claimed.
TEST_F(Newton, MixedScalesAreUndecidedOrRight) {
  for (const double scale : {1e-320, 1e-200, 1e-110, 1e110, 1e160, 1e307}) {
    for (int i = 0; i < 200; ++i) {
      FourMovingPoints p = test::vertex_meets_face(make_, 0.5, 0.25, 0.25);
      for (std::size_t k = 0; k < 4; ++k)
        if (i % 3 != 0 || k % 2 == 0) p[k] = {scale * p[k].start, scale * p[k].end};
      const auto query = query_of<MovingVertexFace>(p);
      if (exact::first_contact(query)) {
        ASSERT_NE(newton(query).verdict, Verdict::apart) << scale;
      }
    }
  }
}

// Single precision is right for features that cross clearly.
TEST_F(Newton, FloatsAgreeWithTheOracleWhereFeaturesCross) {
  int contacts = 0, wrong = 0;
  for (int i = 0; i < 3000; ++i) {
    const double t = make_.uniform(0.05, 0.95), u = make_.uniform(-0.3, 0.45), v = make_.uniform(0.05, 0.45);
    const auto vf = query_of<MovingVertexFace>(test::vertex_meets_face(make_, t, u, v));
    const auto ee = query_of<MovingEdgeEdge>(test::edge_meets_edge(make_, t, 2 * u, 2 * v));
    for (const auto& [answer, truth] : {std::pair(newton_float_vertex_face(vf), exact::first_contact(vf)),
                                        std::pair(newton_float_edge_edge(ee), exact::first_contact(ee))}) {
      contacts += truth.has_value();
      wrong += (answer.verdict == Verdict::contact) != truth.has_value();
      if (truth && answer.verdict == Verdict::contact) {
        EXPECT_NEAR(answer.time, truth->lo, 1e-3);
      }
    }
  }
  EXPECT_GT(contacts, 3000);
  EXPECT_LT(wrong, 20);
}

// Floats cannot hold some of the coordinates. An answer from the other coordinates alone would be wrong.
TEST_F(Newton, FloatsKnowNothingOfCoordinatesBeyondTheirRange) {
  for (int axis = 0; axis < 3; ++axis) {
    FourMovingPoints p = test::vertex_meets_face(make_, 0.5, 0.25, 0.25);
    for (MovingPoint& x : p) x.start[axis] += 1e39, x.end[axis] += 1e39;
    EXPECT_NE(newton_float_vertex_face(query_of<MovingVertexFace>(p)).verdict, Verdict::apart) << axis;
  }
}

// The search ends soon on cubics that are almost zero. The limit is generous: a millisecond for each query
// would pass, even on a slow machine under a sanitizer.
TEST_F(Newton, TheSearchEndsSoonOnFlatCubics) {
  const auto begin = std::chrono::steady_clock::now();
  constexpr int kQueries = 3000;
  for (int i = 0; i < kQueries; ++i) {
    FourMovingPoints p = make_.any();
    const double thin = std::ldexp(1.0, -20 - i % 60);
    for (MovingPoint& x : p) x.start.z() *= thin, x.end.z() *= thin;
    newton(query_of<MovingVertexFace>(p));
    newton(query_of<MovingEdgeEdge>(p));
    // Make triple roots: the three factors of the triple product vanish at once.
    for (MovingPoint& x : p) x.end = -x.start + thin * make_.vector();
    newton(query_of<MovingVertexFace>(p));
    newton(query_of<MovingEdgeEdge>(p));
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(kQueries));
}

}  // namespace
}  // namespace cscd
