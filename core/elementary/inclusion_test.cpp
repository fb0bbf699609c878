#include <cmath>
#include <gtest/gtest.h>

#include "core/elementary/exact/closeness.h"
#include "core/elementary/exact/exact.h"
#include "core/elementary/published.h"
#include "core/elementary/question/query_scale.h"
#include "core/elementary/question/test_queries.h"
#include "core/geometry/feature_distance.h"

namespace cscd {
namespace {

using test::against_triangle;
using test::query_of;
using test::QueryMaker;

TEST(Inclusion, TellsTheTimeFromBelowWithinTheTolerance) {
  for (const double tolerance : {1e-2, 1e-4, 1e-8}) {
    const Answer answer =
        inclusion_vertex_face(against_triangle({1, 1, 1}, {1, 1, -3}), {tolerance, 100'000});
    ASSERT_EQ(answer.verdict, Verdict::contact);
    EXPECT_LE(answer.time, 0.25);
    EXPECT_GE(answer.time, 0.25 - tolerance);
  }
}

// A vertex passes, at a distance, a border that is askew to the axes. A coarse tolerance gives a contact,
// and a fine tolerance gives a proof that there is none.
TEST(Inclusion, FalseAlarmsAreWithinTheTolerance) {
  const auto still = [](double x, double y) { return MovingPoint{{x, y, 0}, {x, y, 0}}; };
  const MovingVertexFace query{{{-1.301, 1.299, 1}, {-1.301, 1.299, -1}},
                               {still(0, 0), still(4, 4), still(-4, 4)}};
  ASSERT_FALSE(exact::first_contact(query));
  EXPECT_EQ(inclusion_vertex_face(query, {1e-2, 100'000}).verdict, Verdict::contact);
  EXPECT_EQ(inclusion_vertex_face(query, {1e-5, 100'000}).verdict, Verdict::apart);
}

TEST(Inclusion, ContactsAreNear) {
  QueryMaker make{5};
  int contacts = 0;
  for (int i = 0; i < 3000; ++i) {
    const double tolerance = i % 2 ? 1e-2 : 1e-4;
    const auto check = [&](const auto& query, const Answer& answer) {
      if (answer.verdict != Verdict::contact) return;
      ++contacts;
      double nearest = distance_at(query, answer.time);
      for (int k = 0; k <= 4096; ++k)
        nearest = std::min(nearest, distance_at(query, answer.time + k * (1 - answer.time) / 4096));
      // The relative motion of the features within half a sample of the nearest place is less than this.
      const double slack = 4 * extent(query) / 8192;
      EXPECT_LE(nearest, std::sqrt(3.0) * tolerance * extent(relative(query)) + slack);
    };
    const auto vf = query_of<MovingVertexFace>(make.any());
    const auto ee = query_of<MovingEdgeEdge>(make.any());
    check(vf, inclusion_vertex_face(vf, {tolerance, 20'000}));
    check(ee, inclusion_edge_edge(ee, {tolerance, 20'000}));
  }
  EXPECT_GT(contacts, 300);
}

// A search that runs out of steps is undecided, with a time that is not late. (Double roots, parallel
// edges, and features that slide in their plane need boxes without end.)
TEST(Inclusion, StopsAtTheLimitWithoutAnAnswer) {
  const MovingVertexFace sliding = against_triangle({-1, 1, 1e-9}, {1, 1, 1e-9});
  ASSERT_FALSE(exact::first_contact(sliding));
  const MovingVertexFace grazing = against_triangle({1, 1, 1}, {1, 1, -3});
  const Answer cut = inclusion_vertex_face(grazing, {1e-12, 10});
  EXPECT_EQ(cut.verdict, Verdict::undecided);
  EXPECT_LE(cut.time, 0.25);
}

// At a distance, the test's balls are cubes: what passes a corner at a distance of sqrt(2) r along two axes
// may be called close, what passes it farther along some axis is apart.
TEST(Inclusion, AtADistanceLosesNothingAndCallsCubesClose) {
  const TestParameters usual{1e-6, 20'000};
  const MovingVertexFace falling = against_triangle({1, 1, 1}, {1, 1, 0});
  const Answer close = inclusion_vertex_face_close(falling, 0.5, usual);
  ASSERT_EQ(close.verdict, Verdict::contact);
  EXPECT_LE(close.time, 0.5);
  EXPECT_EQ(inclusion_vertex_face_close(falling, 1.5, {1e-6, 200}).time, 0);
  const MovingVertexFace passing = against_triangle({-1, -0.99, -3}, {-1, -0.99, 3});
  ASSERT_FALSE(exact::first_closeness(passing, 1));
  EXPECT_EQ(inclusion_vertex_face_close(passing, 1, usual).verdict, Verdict::contact);
  EXPECT_EQ(inclusion_vertex_face_close(passing, 0.99, usual).verdict, Verdict::apart);
  QueryMaker make{8};
  for (int i = 0; i < 500; ++i) {
    const auto query = query_of<MovingEdgeEdge>(make.any());
    const double r = make.uniform(0, 0.3);
    if (const auto truth = exact::first_closeness(query, r)) {
      const Answer answer = inclusion_edge_edge_close(query, r, usual);
      ASSERT_NE(answer.verdict, Verdict::apart);
      ASSERT_LE(answer.time, truth->hi);
    }
  }
}

// Mutation: an error bound that grows with min(1, x), x being the distance from the origin, loses a tenth
// of these contacts.
TEST(Inclusion, LosesNothingFarFromTheOrigin) {
  QueryMaker make{6};
  for (const double far : {1e3, 1e6, 1e12}) {
    for (int i = 0; i < 1000; ++i) {
      const double u = make.uniform(0.05, 0.45), v = make.uniform(0.05, 0.45), t = make.uniform(0.05, 0.95);
      const Vec3 offset = far * make.vector();
      const auto far_off = [&](const test::FourMovingPoints& p) { return test::moved(p, offset, offset); };
      const auto check = [](const Answer& answer, const auto& truth) {
        if (!truth) return;
        ASSERT_NE(answer.verdict, Verdict::apart);
        ASSERT_LE(answer.time, truth->hi);
      };
      const auto vf = query_of<MovingVertexFace>(far_off(test::vertex_meets_face(make, t, u, v)));
      const auto ee = query_of<MovingEdgeEdge>(far_off(test::edge_meets_edge(make, t, u, v)));
      check(inclusion_vertex_face(vf, {1e-6, 20'000}), exact::first_contact(vf));
      check(inclusion_edge_edge(ee, {1e-6, 20'000}), exact::first_contact(ee));
    }
  }
}

// The end of one edge passes through the other edge, all of which is as far along the x axis as that end, and
// the rest of the first edge is nearer. So rounding alone puts the origin outside a box that holds the
// contact. Mutation: the error bound is one rounding.
TEST(Inclusion, RuleErrorBoundLosesNothingWhereOneEdgeEndsAtAnother) {
  QueryMaker make{7};
  for (int i = 0; i < 300; ++i) {
    const double x = make.uniform(1, 2), before = make.uniform(0.1, 1), behind = make.uniform(0.1, 1);
    const auto still = [&](double at, double y) { return MovingPoint{{at, y, 0}, {at, y, 0}}; };
    const MovingEdgeEdge query{{still(0, 0), {{x, 0, 1}, {x, 0, -2}}}, {still(x, -before), still(x, behind)}};
    const Answer answer = inclusion_edge_edge(query, {1e-12, 100'000});
    ASSERT_EQ(answer.verdict, Verdict::contact) << i;
    EXPECT_NEAR(answer.time, 1.0 / 3, 1e-10);
  }
}

}  // namespace
}  // namespace cscd
