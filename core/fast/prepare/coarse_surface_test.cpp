#include "core/fast/prepare/coarse_surface.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <numeric>
#include <random>
#include <set>

#include "core/fast/clusters/seams.h"
#include "core/fast/prepare/covers.h"
#include "core/mesh/test_shapes.h"

namespace cscd::fast {
namespace {

// The same surface with its vertices numbered at random, as a scan may number them.
test::Shape shuffled(const test::Shape& shape, unsigned seed = 3) {
  std::vector<std::int32_t> number(shape.positions.size());
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), std::mt19937(seed));
  test::Shape out{std::vector<Vec3>(number.size()), shape.triangles};
  for (std::size_t v = 0; v < number.size(); ++v) out.positions[index(number[v])] = shape.positions[v];
  for (Triangle& t : out.triangles)
    for (VertexId& v : t) v = VertexId{number[+v]};
  return out;
}

std::size_t seam_edges(const TriangleMesh& mesh, std::span<const std::int32_t> label_of) {
  std::size_t count = 0;
  for_each_seam_edge(mesh, label_of, [&](TriangleId, TriangleId) { ++count; });
  return count;
}

// Mutations: coarse positions belong to other vertices; levels are added for ever; two corners of one kept
// vertex make a triangle.
TEST(CoarseSurface, HasTheShapeOfTheSurface) {
  for (const test::Shape& ball : {test::icosphere(5), shuffled(test::icosphere(5))}) {
    const TriangleMesh mesh = ball.mesh();
    const CoarseSurface coarse(mesh, ball.positions, 4000);
    ASSERT_TRUE(coarse.is_coarser());
    EXPECT_LE(coarse.mesh().triangle_count(), 4000u);
    EXPECT_GE(coarse.mesh().triangle_count(), 400u);
    EXPECT_TRUE(coarse.mesh().closed_and_oriented());
    const test::Shape few{{coarse.positions().begin(), coarse.positions().end()},
                          {coarse.mesh().triangles().begin(), coarse.mesh().triangles().end()}};
    EXPECT_NEAR(six_volumes(few) / six_volumes(ball), 1, 0.03);
  }
}

TEST(CoarseSurface, IsTheSurfaceWhereThatHasFewTriangles) {
  const test::Shape ball = test::icosphere(2);
  const TriangleMesh mesh = ball.mesh();
  const CoarseSurface coarse(mesh, ball.positions, mesh.triangle_count());
  EXPECT_FALSE(coarse.is_coarser());
  EXPECT_EQ(&coarse.mesh(), &mesh);
  std::vector<std::int32_t> label_of(mesh.triangle_count());
  std::iota(label_of.begin(), label_of.end(), 0);
  EXPECT_EQ(coarse.carried(label_of), label_of);
}

// The seam of the carried halves is held against the one that the fine surface itself would have. Mutation:
// seams are not straightened.
TEST(CoarseSurface, CarriesLabelsWithStraightSeams) {
  for (const test::Shape& ball : {test::icosphere(6), shuffled(test::icosphere(6))}) {
    const TriangleMesh mesh = ball.mesh();
    const CoarseSurface coarse(mesh, ball.positions, 4000);
    const auto halves = [](const TriangleMesh& of, std::span<const Vec3> at) {
      std::vector<std::int32_t> half;
      for (const Triangle& t : of.triangles())
        half.push_back((at[+t[0]] + at[+t[1]] + at[+t[2]]).dot(Vec3(1, 0.4, 0.2)) > 0 ? 1 : 0);
      return half;
    };
    const std::vector<std::int32_t> wanted = halves(mesh, ball.positions),
                                    found = coarse.carried(halves(coarse.mesh(), coarse.positions()));
    std::size_t same = 0;
    for (std::size_t t = 0; t < wanted.size(); ++t)
      same += (wanted[t] == found[t]) == (wanted[0] == found[0]);
    EXPECT_GE(static_cast<double>(same), 0.97 * static_cast<double>(wanted.size()));
    EXPECT_EQ(std::set(found.begin(), found.end()), (std::set<std::int32_t>{0, 1}));
    EXPECT_LE(static_cast<double>(seam_edges(mesh, found)),
              1.15 * static_cast<double>(seam_edges(mesh, wanted)));
  }
}

// Every cluster has to stay in its component (rule component, core/soundness.md), and every triangle has to
// get one. Mutation: triangles that belong to one kept vertex stay without a label.
TEST(CoarseSurface, LabelsStayInTheirComponents) {
  const test::Shape both =
      test::together(test::icosphere(5), test::moved(test::icosphere(2), {1.2, 0, 0}, 0.3));
  const TriangleMesh mesh = both.mesh();
  const CoarseSurface coarse(mesh, both.positions, 2000);
  ASSERT_TRUE(coarse.is_coarser());
  ASSERT_EQ(coarse.mesh().component_count(), 2);
  std::vector<std::int32_t> component;
  for (std::size_t t = 0; t < coarse.mesh().triangle_count(); ++t)
    component.push_back(coarse.mesh().component(TriangleId{static_cast<std::int32_t>(t)}));
  const std::vector<std::int32_t> found = coarse.carried(component);
  for (std::size_t t = 0; t < found.size(); ++t)
    EXPECT_EQ(found[t], mesh.component(TriangleId{static_cast<std::int32_t>(t)}));
}

// All vertices of a wheel lie beside its hub, so a coarser level that keeps the hub alone has no triangle.
TEST(CoarseSurface, LosesNoComponent) {
  constexpr int kSpokes = 3000;
  test::Shape wheel{{{0, 0, 1}, {0, 0, -1}}, {}};
  for (int i = 0; i < kSpokes; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSpokes;
    wheel.positions.emplace_back(std::cos(angle), std::sin(angle), 0);
    wheel.triangles.push_back(test::corners(0, 2 + i, 2 + (i + 1) % kSpokes));
    wheel.triangles.push_back(test::corners(1, 2 + (i + 1) % kSpokes, 2 + i));
  }
  const TriangleMesh mesh = wheel.mesh();
  ASSERT_TRUE(mesh.closed_and_oriented());
  EXPECT_FALSE(CoarseSurface(mesh, wheel.positions, 100).is_coarser());
}

// A button on a character must not keep the whole character fine. Mutations: a level that loses a component
// is not taken; of two kept vertices in one place, one belongs to the other; a component is left with the
// same triangle twice; vertices where two fans meet are not faulty.
TEST(CoarseSurface, SmallComponentsStayAsTheyAre) {
  const test::Shape ball = test::icosphere(4);
  for (const test::Shape& small : {test::box(), test::octahedron(), test::capped_tube(3, 4, 0.1, 1)})
    for (const double size : {0.1, 0.0})
      for (unsigned seed = 0; seed < 10; ++seed) {
        const test::Shape both = shuffled(test::together(ball, test::moved(small, {2, 0, 0}, size)), seed);
        const TriangleMesh mesh = both.mesh();
        const CoarseSurface coarse(mesh, both.positions, 2000);
        EXPECT_LE(coarse.mesh().triangle_count(), 2000u) << seed;
        EXPECT_EQ(coarse.mesh().component_count(), 2) << seed;
        EXPECT_TRUE(coarse.mesh().closed_and_oriented()) << seed;
      }
}

// A thin limb on a character must not keep the whole character fine either. Mutations: only components stay,
// and nothing about faults of a level; only the faulty vertices themselves stay, without the vertices beside
// them.
TEST(CoarseSurface, ThinLimbsStayAsTheyAre) {
  for (int sides = 3; sides < 9; ++sides)
    for (unsigned seed = 0; seed < 10; ++seed) {
      const test::Shape limb = test::capped_tube(sides, 60, 0.05, 2);
      const test::Shape both =
          shuffled(test::together(test::icosphere(4), test::moved(limb, {3, 0, 0}, 1)), seed);
      const TriangleMesh mesh = both.mesh();
      const CoarseSurface coarse(mesh, both.positions, 4000);
      EXPECT_LE(coarse.mesh().triangle_count(), 4000u) << sides << " " << seed;
      EXPECT_TRUE(coarse.mesh().closed_and_oriented()) << sides << " " << seed;
    }
}

// Two guards keep a closed surface closed: vertices about faults stay, and a level that is still not closed
// is not taken. Mutation: both guards are left out.
TEST(CoarseSurface, AClosedSurfaceStaysClosed) {
  for (const int sides : {3, 4, 5, 8}) {
    const test::Shape wire = shuffled(test::capped_tube(sides, 2000, 0.1, 400));
    const TriangleMesh mesh = wire.mesh();
    EXPECT_TRUE(CoarseSurface(mesh, wire.positions, 100).mesh().closed_and_oriented()) << sides;
  }
}

// An open surface, and one with an edge of three triangles, may be made coarser too. Of a ribbon that is one
// triangle wide, nothing is left on a coarser level. Mutation: triangles without a label stay without one.
TEST(CoarseSurface, TakesAnySurface) {
  test::Shape sheet = test::sheet(60);
  const auto tip = static_cast<int>(sheet.positions.size());
  sheet.positions.emplace_back(0.5, 0.5, 1);
  sheet.triangles.push_back({sheet.triangles[0][0], sheet.triangles[0][1], VertexId{tip}});
  sheet.positions.emplace_back(7, 7, 7);  // no triangle has this one
  VertexId last = sheet.triangles[0][0];
  for (int i = 1; i < 50; ++i) {
    const VertexId here{static_cast<std::int32_t>(sheet.positions.size())},
        beside{static_cast<std::int32_t>(sheet.positions.size()) + 1};
    sheet.positions.emplace_back(-0.02 * i, 0, 0);
    sheet.positions.emplace_back(-0.02 * i, 0.02, 0);
    sheet.triangles.push_back({last, beside, here});
    last = here;
  }
  const TriangleMesh mesh = sheet.mesh();
  const CoarseSurface coarse(mesh, sheet.positions, 2000);
  ASSERT_TRUE(coarse.is_coarser());
  const std::vector<std::int32_t> found =
      coarse.carried(std::vector<std::int32_t>(coarse.mesh().triangle_count(), 7));
  EXPECT_EQ(found, std::vector<std::int32_t>(mesh.triangle_count(), 7));
}

}  // namespace
}  // namespace cscd::fast
