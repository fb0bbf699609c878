#include "core/detect/contact_geometry.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "core/elementary/catalogue.h"
#include "core/mesh/test_shapes.h"

namespace cscd {
namespace {

using test::corners;

// A triangle (0, 1, 2), and another one whose corner 3 moves as a test asks.
const TriangleMesh& mesh() {
  static const TriangleMesh two({corners(0, 1, 2), corners(3, 4, 5)}, 6);
  return two;
}
constexpr FeaturePair kVertexFace{FeaturePair::Kind::vertex_face, 3, 0};

FeaturePair edges(int a, int b, int c, int d) {
  const auto find = [](int i, int j) {
    for (std::size_t e = 0; e < mesh().edge_count(); ++e)
      if (mesh().edges()[e] == Edge{VertexId{i}, VertexId{j}}) return EdgeId{static_cast<std::int32_t>(e)};
    return EdgeId{-1};
  };
  return FeaturePair::of(find(a, b), find(c, d));
}

TEST(ContactGeometry, OfAVertexThatFallsOntoAFace) {
  const std::vector<Vec3> start = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 2, 3}, {9, 9, 9}, {9, 9, 8}};
  std::vector<Vec3> end = start;
  end[3] = {1, 2, -1};
  for (const bool from_below : {false, true}) {
    std::vector<Vec3> a = start, b = end;
    if (from_below)
      for (std::vector<Vec3>* x : {&a, &b}) (*x)[3].z() = -(*x)[3].z();
    const ContactGeometry g = contact_geometry(mesh(), Motion(a, b), kVertexFace, 0.75);
    EXPECT_LT((g.point - Vec3(1, 2, 0)).norm(), 1e-12);
    ASSERT_EQ(g.weight_count, 3);
    EXPECT_NEAR(g.weights[0], 0.25, 1e-12);
    EXPECT_NEAR(g.weights[1], 0.25, 1e-12);
    EXPECT_NEAR(g.weights[2], 0.5, 1e-12);
    EXPECT_LT((*g.normal - Vec3(0, 0, from_below ? -1 : 1)).norm(), 1e-12) << "where the vertex came from";
    EXPECT_NEAR(*g.relative_speed, -4, 1e-12);
  }
}

TEST(ContactGeometry, OfEdgesThatCross) {
  const std::vector<Vec3> start = {{-1, 0, 0}, {3, 0, 0}, {0, 9, 9}, {0, -1, 2}, {0, 1, 2}, {0, 0, 30}};
  std::vector<Vec3> end = start;
  end[3].z() = end[4].z() = -2;
  const FeaturePair pair = edges(0, 1, 3, 4);
  const ContactGeometry g = contact_geometry(mesh(), Motion(start, end), pair, 0.5);
  EXPECT_LT(g.point.norm(), 1e-12);
  ASSERT_EQ(g.weight_count, 2);
  EXPECT_NEAR(g.weights[0], 0.25, 1e-12);
  EXPECT_NEAR(g.weights[1], 0.5, 1e-12);
  EXPECT_LT((*g.normal - Vec3(0, 0, -1)).norm(), 1e-12) << "the first edge lies below the falling one";
  EXPECT_NEAR(*g.relative_speed, -4, 1e-12);
}

// The vertex slides parallel to the face, so the motion does not tell its side;
// the positions at the start do.
TEST(ContactGeometry, TakesTheSideFromTheStartWhereNothingApproaches) {
  const std::vector<Vec3> start = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {9, 9, 9}, {9, 9, 8}};
  std::vector<Vec3> end = start;
  for (std::size_t v = 3; v < 6; ++v) end[v] += Vec3(1, 0, 0);
  const ContactGeometry g = contact_geometry(mesh(), Motion(start, end), kVertexFace, 0.5);
  EXPECT_LT((*g.normal - Vec3(0, 0, -1)).norm(), 1e-12);
  EXPECT_NEAR(*g.relative_speed, 0, 1e-12);
}

TEST(ContactGeometry, OfWhatIsDegenerateStaysFinite) {
  // A face without area and edges in one line; edges that are points; all vertices in one place.
  const std::vector<std::vector<Vec3>> starts = {
      {{0, 0, 0}, {2, 0, 0}, {4, 0, 0}, {1, 0, 1}, {9, 0, 1}, {9, 9, 8}},
      {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}},
      {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}};
  for (std::size_t s = 0; s < starts.size(); ++s) {
    std::vector<Vec3> end = starts[s];
    for (std::size_t v = 3; v < 6; ++v) end[v].z() = starts[s][0].z();
    for (const FeaturePair& pair : {kVertexFace, edges(0, 1, 3, 4)}) {
      const ContactGeometry g = contact_geometry(mesh(), Motion(starts[s], end), pair, 1);
      EXPECT_TRUE(g.point.allFinite());
      double sum = 0;
      for (int i = 0; i < g.weight_count; ++i) {
        EXPECT_GE(g.weights[static_cast<std::size_t>(i)], 0);
        sum += g.weights[static_cast<std::size_t>(i)];
      }
      if (g.weight_count == 3) {
        EXPECT_NEAR(sum, 1, 1e-12);
      }
      EXPECT_EQ(g.normal.has_value(), s != 2) << "in one place from the start there is no direction";
      if (g.normal) {
        EXPECT_NEAR(g.normal->norm(), 1, 1e-12);
        EXPECT_NEAR(g.normal->z(),
                    s == 0 || s == 1 ? (pair.kind == FeaturePair::Kind::vertex_face ? 1 : -1) : 0, 1e-9);
      }
    }
  }
}

// Mutation: contact_geometry() computes in the scale of the mesh, where fourth powers of lengths overflow or
// vanish.
TEST(ContactGeometry, DoesNotDependOnTheUnitOfLength) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> some(-1, 1);
  for (int i = 0; i < 20; ++i) {
    std::vector<Vec3> start(6), end(6);
    for (std::vector<Vec3>* x : {&start, &end})
      for (Vec3& p : *x) p = Vec3(some(random), some(random), some(random));
    for (const FeaturePair& pair : {kVertexFace, edges(0, 1, 3, 4)})
      for (const bool at_distance : {false, true}) {
        const ContactGeometry expected =
            contact_geometry(mesh(), Motion(start, end), pair, 0.375, at_distance);
        for (int exponent = -900; exponent <= 900; exponent += 25) {
          const double unit = std::ldexp(1.0, exponent);
          std::vector<Vec3> a = start, b = end;
          for (std::vector<Vec3>* x : {&a, &b})
            for (Vec3& p : *x) p *= unit;
          const ContactGeometry g = contact_geometry(mesh(), Motion(a, b), pair, 0.375, at_distance);
          EXPECT_EQ(g.weights, expected.weights) << exponent;
          EXPECT_EQ(*g.normal, *expected.normal) << exponent;
          EXPECT_EQ(g.point, unit * expected.point) << exponent;
          EXPECT_EQ(*g.relative_speed, unit * *expected.relative_speed) << exponent;
        }
      }
  }
}

// The weights on both features describe the same point.
TEST(ContactGeometry, WeightsOfBothSidesGiveTheSamePoint) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> some(-1, 1);
  const ElementaryTest& exact = *find_elementary_test("filtered_exact");
  std::size_t contacts = 0;
  for (int i = 0; i < 4000; ++i) {
    std::vector<Vec3> start(6), end(6);
    for (std::vector<Vec3>* x : {&start, &end})
      for (Vec3& p : *x) p = Vec3(some(random), some(random), some(random));
    const Motion motion(start, end);
    for (const FeaturePair& pair : {kVertexFace, edges(0, 1, 3, 4)}) {
      const Answer answer = ask(exact, mesh(), motion, pair);
      if (answer.verdict != Verdict::contact || answer.time == 0) continue;
      ++contacts;
      const ContactGeometry g = contact_geometry(mesh(), motion, pair, answer.time);
      const auto at = [&](int v) { return motion[VertexId{v}].at(answer.time); };
      const Vec3 other = pair.kind == FeaturePair::Kind::vertex_face
                             ? Vec3(g.weights[0] * at(0) + g.weights[1] * at(1) + g.weights[2] * at(2))
                             : Vec3((1 - g.weights[1]) * at(3) + g.weights[1] * at(4));
      EXPECT_LT((g.point - other).norm(), 1e-7) << i;
      ASSERT_TRUE(g.normal);
      EXPECT_LE(*g.relative_speed, 1e-12) << "at the first moment of contact nothing moves apart";
    }
  }
  EXPECT_GT(contacts, 300u);
}

}  // namespace
}  // namespace cscd
