#include <gtest/gtest.h>

#include "core/elementary/exact/exact.h"
#include "core/elementary/published.h"
#include "core/elementary/question/test_queries.h"

namespace cscd {
namespace {

using test::against_triangle;
using test::query_of;
using test::QueryMaker;
using test::still;

constexpr TestParameters kFine{.tolerance = 1e-10};

TEST(Cubic, AgreesWithTheOracleWhereFeaturesCross) {
  QueryMaker make{3};
  for (int i = 0; i < 2000; ++i) {
    const double t = make.uniform(0.01, 0.99), u = make.uniform(0.01, 0.49), v = make.uniform(0.01, 0.49);
    const auto vf = query_of<MovingVertexFace>(test::vertex_meets_face(make, t, u, v));
    const auto ee = query_of<MovingEdgeEdge>(test::edge_meets_edge(make, t, u, v));
    const Answer vf_answer = cubic_vertex_face(vf, kFine), ee_answer = cubic_edge_edge(ee, kFine);
    ASSERT_EQ(vf_answer.verdict, Verdict::contact);
    ASSERT_EQ(ee_answer.verdict, Verdict::contact);
    EXPECT_NEAR(vf_answer.time, exact::first_contact(vf)->lo, 1e-9);
    EXPECT_NEAR(ee_answer.time, exact::first_contact(ee)->lo, 1e-9);
  }
}

TEST(Cubic, TheToleranceIsADistance) {
  const MovingVertexFace query = against_triangle({-1e-3, 1, 1}, {-1e-3, 1, -1});  // the extent is about 4
  EXPECT_EQ(cubic_vertex_face(query, {.tolerance = 1e-3}).verdict, Verdict::contact);
  EXPECT_EQ(cubic_vertex_face(query, {.tolerance = 1e-4}).verdict, Verdict::apart);
}

TEST(Cubic, RootsAtTheEndsAndDoubleRootsCount) {
  EXPECT_EQ(cubic_vertex_face(against_triangle({1, 1, 0}, {1, 1, 1}), kFine).time, 0);
  EXPECT_EQ(cubic_vertex_face(against_triangle({1, 1, 1}, {1, 1, 0}), kFine).time, 1);
  // The plane of the face swings through the path of the vertex and back. The height of the vertex over the
  // plane is a multiple of (t - 1/2)^2.
  const MovingVertexFace twice{{{-1, 1, 0}, {1, 1, 0}},
                               {still(0, 0, 0), {{4, 0, -1}, {4, 0, 1}}, still(0, 4, 0)}};
  const Answer answer = cubic_vertex_face(twice, kFine);
  EXPECT_EQ(answer.verdict, Verdict::contact);
  EXPECT_NEAR(answer.time, 0.5, 1e-6);
}

// A vertex that slides through the face in the plane of the face is a contact that this test loses. So its
// "apart" is no proof.
TEST(Cubic, LosesWhatStaysInOnePlane) {
  const MovingVertexFace query = against_triangle({-1, 1, 0}, {9, 1, 0});
  ASSERT_TRUE(exact::first_contact(query));
  EXPECT_EQ(cubic_vertex_face(query, kFine).verdict, Verdict::apart);
}

}  // namespace
}  // namespace cscd
