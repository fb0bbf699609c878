#include <gtest/gtest.h>

#include "core/elementary/exact/exact.h"
#include "core/elementary/published.h"
#include "core/elementary/question/query_scale.h"
#include "core/elementary/question/test_queries.h"

namespace cscd {
namespace {

using test::against_triangle;
using test::query_of;
using test::QueryMaker;

constexpr TestParameters kUsual{.tolerance = 0.1, .steps = 10'000};

TEST(Additive, FindsWhatCrossesAndIsNeverLate) {
  QueryMaker make{3};
  for (int i = 0; i < 2000; ++i) {
    const double t = make.uniform(0.01, 0.99), u = make.uniform(0.01, 0.49), v = make.uniform(0.01, 0.49);
    const auto check = [](const Answer& answer, const auto& truth) {
      ASSERT_TRUE(truth);
      EXPECT_EQ(answer.verdict, Verdict::contact);
      EXPECT_LE(answer.time, truth->hi);
    };
    const auto vf = query_of<MovingVertexFace>(test::vertex_meets_face(make, t, u, v));
    const auto ee = query_of<MovingEdgeEdge>(test::edge_meets_edge(make, t, u, v));
    check(additive_vertex_face(vf, kUsual), exact::first_contact(vf));
    check(additive_edge_edge(ee, kUsual), exact::first_contact(ee));
  }
}

TEST(Additive, TheToleranceIsAShareOfTheStartingDistance) {
  // The vertex falls from a height of 1 to a height of 0.05 above the face; all of its motion is approach.
  const MovingVertexFace query = against_triangle({1, 1, 1}, {1, 1, 0.05});
  EXPECT_EQ(additive_vertex_face(query, kUsual).verdict, Verdict::apart) << "the filter's";
  const MovingVertexFace beside = against_triangle({-0.05, 1, 1}, {-0.05, 1, -1});
  ASSERT_FALSE(exact::first_contact(beside));
  EXPECT_EQ(additive_vertex_face(beside, kUsual).verdict, Verdict::contact);
  EXPECT_EQ(additive_vertex_face(beside, {.tolerance = 0.01, .steps = 10'000}).verdict, Verdict::apart);
}

// The first step leaves the tolerance's share of the distance at least, even where that is more than the
// tenth that other steps leave. A vertex falls by 1 and moves sideways, so that it comes down by 0.8 of the
// bound on its speed. Mutation: the first step goes all the way.
TEST(Additive, TheFirstStepLeavesTheShareOfTheDistance) {
  const MovingVertexFace query = against_triangle({1, 1, 1}, {1.75, 1, 0});
  const Answer answer = additive_vertex_face(query, {.tolerance = 0.5, .steps = 10'000});
  ASSERT_EQ(answer.verdict, Verdict::contact);
  EXPECT_NEAR(answer.time, 0.4, 1e-3);
}

TEST(Additive, ContactAtTheStartAndStandingStill) {
  const Answer touching = additive_vertex_face(against_triangle({1, 1, 0}, {1, 1, 1}), kUsual);
  EXPECT_EQ(touching.verdict, Verdict::contact);
  EXPECT_EQ(touching.time, 0);
  EXPECT_EQ(additive_vertex_face(against_triangle({9, 9, 0}, {9, 9, 0}), kUsual).verdict, Verdict::apart);
}

// The vertex falls from 1 to 0.3 above the face. At r = 0.5 it leaves 0.5 at the start, so 0.55 counts as
// close.
TEST(Additive, AtADistanceTheToleranceIsAShareOfTheDistanceBeyondIt) {
  const MovingVertexFace query = against_triangle({1, 1, 1}, {1, 1, 0.3});
  const Answer close = additive_vertex_face_close(query, 0.5, kUsual);
  ASSERT_EQ(close.verdict, Verdict::contact);
  EXPECT_LE(close.time, 0.5 / 0.7);
  EXPECT_EQ(additive_vertex_face_close(query, 0.2, kUsual).verdict, Verdict::apart);
  EXPECT_EQ(additive_vertex_face_close(query, 1.5, kUsual).time, 0);
  // Coordinates are scaled, and the distance with them.
  const MovingVertexFace tiny = scaled(query, {-500, -500, -500});
  EXPECT_EQ(additive_vertex_face_close(tiny, 0.5 * 0x1p-500, kUsual).verdict, Verdict::contact);
  EXPECT_EQ(additive_vertex_face_close(tiny, 0.2 * 0x1p-500, kUsual).verdict, Verdict::apart);
}

TEST(Additive, StopsAtTheLimitWithoutAnAnswer) {
  const Answer answer = additive_vertex_face(against_triangle({1, 1, 1}, {1, 1, -1}), {1e-6, 2});
  EXPECT_EQ(answer.verdict, Verdict::undecided);
  EXPECT_LE(answer.time, 0.5);
}

}  // namespace
}  // namespace cscd
