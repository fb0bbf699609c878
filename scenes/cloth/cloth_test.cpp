#include "scenes/cloth/cloth.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <set>

#include "core/base/error.h"
#include "core/detect/start/embedding.h"
#include "scenes/cloth/ball.h"
#include "scenes/cloth/sheet.h"
#include "scenes/cloth/skirt.h"
#include "scenes/cloth/worn_parts.h"

namespace cscd::scenes {
namespace {

// A sheet that hangs down from a row at height 0, or lies at that height.
Shape hanging(int cells = 12) {
  return sheet({cells, 14, 1, Vec3(0, 0, -7 * std::sqrt(0.75)), Vec3::UnitX(), -Vec3::UnitZ()});
}
Shape lying(int cells = 24) {
  return sheet({cells, 28, 1, Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()});
}

struct Lengths {
  double shortest, longest;
};
Lengths edge_lengths(const TriangleMesh& mesh, const std::vector<Vec3>& positions) {
  Lengths lengths{1e300, 0};
  for (const Edge& edge : mesh.edges()) {
    const double length = (positions[+edge[0]] - positions[+edge[1]]).norm();
    lengths = {std::min(lengths.shortest, length), std::max(lengths.longest, length)};
  }
  return lengths;
}

Vec3 mean_of(const std::vector<Vec3>& positions) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& position : positions) sum += position;
  return sum / static_cast<double>(positions.size());
}

// The least distance of two vertices that share no edge.
double closest_vertices(const TriangleMesh& mesh, const std::vector<Vec3>& positions) {
  std::set<std::pair<std::size_t, std::size_t>> joined;
  for (const Edge& edge : mesh.edges()) joined.emplace(+edge[0], +edge[1]);
  double least = 1e300;
  for (std::size_t b = 0; b < positions.size(); ++b)
    for (std::size_t a = 0; a < b; ++a)
      if (!joined.contains({a, b})) least = std::min(least, (positions[a] - positions[b]).norm());
  return least;
}

TEST(Sheet, IsAFlatDiscOfEquilateralTriangles) {
  for (const auto& [cells, strips] : {std::pair{1, 2}, {7, 6}, {147, 170}}) {
    const Shape shape = sheet({cells, strips, 0.5, Vec3(1, 2, 3), Vec3(2, 0, 0), Vec3(1, 0, 3)});
    const TriangleMesh mesh(shape.triangles, shape.positions.size());
    EXPECT_EQ(mesh.triangle_count(), static_cast<std::size_t>(strips * (2 * cells + 1)));
    EXPECT_EQ(mesh.vertex_count() + mesh.triangle_count(), mesh.edge_count() + 1) << "a disc";
    EXPECT_EQ(mesh.component_count(), 1);
    for (const TriangleMesh::DefectReport& defect : mesh.defects())
      EXPECT_EQ(defect.kind, Defect::boundary_edge) << defect.first;
    for (const Triangle& t : shape.triangles) {
      const Vec3 normal = (shape.positions[+t[1]] - shape.positions[+t[0]])
                              .cross(shape.positions[+t[2]] - shape.positions[+t[0]]);
      EXPECT_LT(normal.y(), 0) << "the side of u x v";
    }
    const Lengths lengths = edge_lengths(mesh, shape.positions);
    EXPECT_NEAR(lengths.shortest, 0.25, 1e-12) << "the half triangles at the sides";
    EXPECT_NEAR(lengths.longest, 0.5, 1e-12);
    EXPECT_TRUE(shape.rig.parent.empty());
  }
  EXPECT_THROW(sheet({1, 3, 1}), InputError);
  EXPECT_THROW(sheet({0, 2, 1}), InputError);
  EXPECT_THROW(sheet({4, 4, 1, Vec3::Zero(), Vec3::UnitX(), Vec3::UnitX()}), InputError);
}

TEST(Ball, IsASphereOfNearlyEqualTriangles) {
  for (const int parts : {1, 2, 7, 50}) {
    const Shape shape = ball({parts, 3, Vec3(1, 2, 3)});
    const TriangleMesh mesh(shape.triangles, shape.positions.size());
    EXPECT_EQ(mesh.triangle_count(), static_cast<std::size_t>(20 * parts * parts));
    EXPECT_EQ(mesh.vertex_count(), mesh.triangle_count() / 2 + 2) << "genus 0";
    EXPECT_TRUE(mesh.closed_and_oriented());
    EXPECT_EQ(mesh.component_count(), 1);
    for (const Vec3& position : shape.positions) EXPECT_NEAR((position - Vec3(1, 2, 3)).norm(), 3, 1e-12);
    const Lengths lengths = edge_lengths(mesh, shape.positions);
    EXPECT_LT(lengths.longest / lengths.shortest, 4.0 / 3);
    EXPECT_GT(Cloth(mesh, shape.positions, {}).rest_volume(), 0) << "faces outward";
  }
  EXPECT_THROW(ball({0, 1}), InputError);
  EXPECT_THROW(ball({1, 0}), InputError);
}

// A ball that hangs on one bone.
Shape boned_ball(double radius) {
  Shape shape = ball({6, radius});
  shape.rig = {{BoneId{-1}}, {{Vec3(0, 0, -1), Vec3(0, 0, 1)}}};
  shape.bone_names = {"middle"};
  for (JointWeights& weights : shape.weights) weights.bone[0] = BoneId{0}, weights.weight[0] = 1;
  return shape;
}

TEST(Skirt, IsAnOpenConeOfEquilateralTriangles) {
  for (const int points : {1, 2, 3, 4, 5}) {
    Shape shape = boned_ball(1);
    const std::size_t ball_vertices = shape.positions.size(), ball_triangles = shape.triangles.size();
    add_skirt({points, 0.7, 0.5, 20, 45, 3, Vec3(1, 2, 30)}, shape, "here");
    const WornParts parts = worn_parts(shape);
    ASSERT_EQ(parts.body.triangles.size(), ball_triangles);
    const TriangleMesh mesh(parts.cloth.triangles, parts.cloth.in_shape.size());
    EXPECT_EQ(mesh.triangle_count(), static_cast<std::size_t>(points * (45 * 45 - 20 * 20)));
    EXPECT_EQ(mesh.vertex_count() + mesh.triangle_count(), mesh.edge_count()) << "a ring";
    EXPECT_EQ(mesh.component_count(), 1);
    for (const TriangleMesh::DefectReport& defect : mesh.defects())
      EXPECT_EQ(defect.kind, Defect::boundary_edge) << defect.first;
    const std::vector<Vec3> positions = parts.cloth.of(shape.positions);
    const Lengths lengths = edge_lengths(mesh, positions);
    EXPECT_LT(lengths.longest, 0.5 + 1e-9) << "rolled up, no edge grows";
    EXPECT_GT(lengths.shortest, 0.49) << "and chords are little shorter";
    EXPECT_TRUE(EmbeddingTest(mesh, positions).embedded(positions));
    for (const Triangle& t : mesh.triangles()) {
      const Vec3& a = positions[+t[0]];
      EXPECT_GT((positions[+t[1]] - a).cross(positions[+t[2]] - a).dot(Vec3(a.x() - 1, a.y() - 2, 0)), 0)
          << "faces outward";
    }
    std::size_t carried = 0;
    for (std::size_t v = ball_vertices; v < shape.positions.size(); ++v)
      carried += shape.weights[v].bone[0] == BoneId{0};
    EXPECT_EQ(carried, static_cast<std::size_t>(points * (20 + 21 + 22))) << "the band";
  }
  const auto refused = [](const SkirtParameters& parameters) {
    Shape shape = boned_ball(1);
    EXPECT_THROW(add_skirt(parameters, shape, "here"), InputError);
  };
  refused({.points = 0});
  refused({.points = 6});
  refused({.aspect = 0});
  refused({.edge = 0});
  refused({.first_row = 1});
  refused({.first_row = 30, .last_row = 30});
  refused({.band_rows = 31});
}

TEST(WornParts, AreAllClothUnlessSomeComponentsAreCarriedByBones) {
  for (const Shape& shape : {boned_ball(1), ball({6, 1}), lying()}) {
    const WornParts parts = worn_parts(shape);
    EXPECT_TRUE(std::ranges::equal(parts.cloth.triangles, shape.triangles));
    EXPECT_EQ(parts.cloth.of(shape.positions), shape.positions);
    EXPECT_TRUE(parts.body.in_shape.empty());
  }
  Shape shape = boned_ball(1);
  const Shape bare = shape;
  add_skirt({.edge = 0.5, .apex = Vec3(0, 0, 20)}, shape, "here");
  const WornParts parts = worn_parts(shape);
  EXPECT_TRUE(std::ranges::equal(parts.body.triangles, bare.triangles));
  EXPECT_EQ(parts.body.of(shape.positions), bare.positions);
  EXPECT_EQ(parts.cloth.in_shape.front(), VertexId{static_cast<int>(bare.positions.size())});
}

TEST(NearSurface, KnowsTheDistanceFromACubeAndItsSide) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.push_back(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
  std::vector<Triangle> triangles;
  const auto add_face = [&](int a, int b, int c, int d) {
    triangles.push_back({VertexId{a}, VertexId{b}, VertexId{c}});
    triangles.push_back({VertexId{a}, VertexId{c}, VertexId{d}});
  };
  add_face(0, 4, 6, 2), add_face(1, 3, 7, 5), add_face(0, 1, 5, 4);
  add_face(2, 6, 7, 3), add_face(0, 2, 3, 1), add_face(4, 5, 7, 6);
  const TriangleMesh mesh(triangles, corners.size());
  ASSERT_TRUE(mesh.closed_and_oriented());
  NearSurface near(mesh);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> along(-2, 2);
  for (const double reach : {0.3, 0.9, 3.0}) {
    near.place(corners, Vec3(-2, -2, -2), Vec3(2, 2, 2), reach);
    for (int i = 0; i < 2000; ++i) {
      const Vec3 point(along(random), along(random), along(random));
      const Vec3 beyond = (point.cwiseAbs().array() - 1).matrix();
      const double inside = beyond.maxCoeff();
      const double distance = inside < 0 ? inside : beyond.cwiseMax(0).norm();
      const auto found = near.nearest(point);
      ASSERT_EQ(found.has_value(), std::abs(distance) < reach) << point.transpose();
      if (!found) continue;
      EXPECT_NEAR(found->distance, distance, 1e-12) << point.transpose();
      EXPECT_NEAR(found->outward.norm(), 1, 1e-12);
      const Triangle& t = mesh.corners(found->triangle);
      const Vec3 on_surface = found->weights[0] * corners[+t[0]] + found->weights[1] * corners[+t[1]] +
                              found->weights[2] * corners[+t[2]];
      EXPECT_LT((on_surface + distance * found->outward - point).norm(), 1e-12);
    }
  }
  EXPECT_FALSE(near.nearest(Vec3(0, 0, 2.1))) << "outside the place that was asked for";
}

TEST(NearPoints, FindsTheSamePairsAsALookAtAllPairs) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> along(-3, 3);
  const Shape shape = lying();
  const TriangleMesh mesh(shape.triangles, shape.positions.size());
  NearPoints near(mesh);
  std::set<std::pair<int, int>> joined;
  for (const Edge& edge : mesh.edges()) joined.emplace(static_cast<int>(edge[0]), static_cast<int>(edge[1]));
  for (const double reach : {0.2, 0.7, 5.0}) {
    std::vector<Vec3> points(mesh.vertex_count());
    for (Vec3& point : points) point = Vec3(along(random), along(random), along(random));
    std::set<std::pair<int, int>> expected;
    for (int b = 0; b < static_cast<int>(points.size()); ++b)
      for (int a = 0; a < b; ++a)
        if ((points[static_cast<std::size_t>(a)] - points[static_cast<std::size_t>(b)]).norm() <= reach &&
            !joined.contains({a, b}))
          expected.emplace(a, b);
    std::set<std::pair<int, int>> found;
    for (const auto& [a, b] : near.find(points, reach))
      EXPECT_TRUE(found.emplace(std::min(a, b), std::max(a, b)).second) << "each pair once";
    EXPECT_EQ(found, expected) << "reach " << reach;
  }
}

TEST(Cloth, FallsFreelyAsAPointDoes) {
  const Shape shape = lying();
  const TriangleMesh mesh(shape.triangles, shape.positions.size());
  Cloth cloth(mesh, shape.positions, {.gravity = Vec3(0, 0, -0.1), .viscosity = 1, .thickness = 0.9});
  std::vector<Vec3> positions = shape.positions;
  constexpr double h = 1.0 / 16;
  for (int i = 0; i < 160; ++i) cloth.step(positions, h, {}, {}, std::nullopt);
  // Steps of h add half a step's gravity to the parabola.
  EXPECT_NEAR(mean_of(positions).z() - mean_of(shape.positions).z(), -0.05 * (100 + 10 * h), 1e-9);
  EXPECT_NEAR(edge_lengths(mesh, positions).longest, 1, 1e-9);
}

TEST(Cloth, GoesOnFromWhereItWasMoved) {
  const Shape shape = lying();
  const TriangleMesh mesh(shape.triangles, shape.positions.size());
  Cloth cloth(mesh, shape.positions, {.thickness = 0.9});
  std::vector<Vec3> positions = shape.positions;
  constexpr double h = 1.0 / 16;
  cloth.step(positions, h, {}, {}, std::nullopt);
  for (Vec3& position : positions) position.z() += 1;
  for (int i = 0; i < 8; ++i) cloth.step(positions, h, {}, {}, std::nullopt);
  EXPECT_NEAR(mean_of(positions).z(), 1 + 8 * h, 1e-9) << "a move of 1 is a speed of 1 per frame";
}

TEST(Cloth, HangsWithoutStretchingFromTheVerticesThatAreLed) {
  const Shape shape = hanging();
  const TriangleMesh mesh(shape.triangles, shape.positions.size());
  Cloth cloth(mesh, shape.positions,
              {.gravity = Vec3(0, 0.02, -0.08), .drag = 0.1, .viscosity = 1, .bend_compliance = 0.1});
  std::vector<Cloth::Led> led;
  for (std::size_t v = 0; v < shape.positions.size(); ++v)
    if (shape.positions[v].z() > -0.1) led.push_back({VertexId{static_cast<int>(v)}, shape.positions[v]});
  ASSERT_EQ(led.size(), 13u);
  std::vector<Vec3> positions = shape.positions;
  for (int i = 0; i < 1600; ++i) cloth.step(positions, 1.0 / 16, led, {}, std::nullopt);
  EXPECT_LT(edge_lengths(mesh, positions).longest, 1.02);
  for (const Cloth::Led& one : led) EXPECT_EQ(positions[+one.vertex], one.place);
  // At rest the sheet hangs in the direction of gravity.
  const Vec3 down = mean_of(positions) / mean_of(positions).norm();
  EXPECT_LT((down - Vec3(0, 0.02, -0.08).normalized()).norm(), 0.05);
}

TEST(Cloth, StaysOutOfABallAndAboveTheFloor) {
  const Shape shape = lying();
  const TriangleMesh mesh(shape.triangles, shape.positions.size());
  Cloth cloth(mesh, shape.positions,
              {.gravity = Vec3(0, 0, -0.05),
               .drag = 0.05,
               .viscosity = 1,
               .bend_compliance = 0.1,
               .thickness = 0.9,
               .friction = 0.3,
               .floor = -8});
  std::vector<Vec3> positions = shape.positions;
  const BallObstacle ball{4, Vec3(0.1, 0.2, -5), Vec3(0.1, 0.2, -5)};
  for (int i = 0; i < 1600; ++i) cloth.step(positions, 1.0 / 16, {}, {&ball, 1}, std::nullopt);
  double lowest = 0;
  for (const Vec3& position : positions) {
    // The cloth is pushed off itself after it is pushed out of obstacles.
    EXPECT_GT((position - ball.end).norm(), 3.9);
    EXPECT_GT(position.z(), -8.1);
    lowest = std::min(lowest, position.z());
  }
  EXPECT_LT(lowest, -7.9) << "its corners lie on the floor";
}

TEST(Cloth, StaysOutOfABodyThatMovesAndIsCarriedByIt) {
  const Shape shape = lying();
  const TriangleMesh mesh(shape.triangles, shape.positions.size());
  const Shape body = ball({8, 5, Vec3(0, 0, -6)});
  const TriangleMesh body_mesh(body.triangles, body.positions.size());
  for (const double friction : {0.0, 1.0}) {
    Cloth cloth(mesh, shape.positions,
                {.gravity = Vec3(0, 0, -0.05),
                 .drag = 0.05,
                 .viscosity = 1,
                 .bend_compliance = 0.1,
                 .thickness = 0.9,
                 .friction = friction});
    NearSurface near(body_mesh);
    std::vector<Vec3> positions = shape.positions, start = body.positions, end = start;
    Vec3 centre(0, 0, -6);
    for (int i = 0; i < 800; ++i) {
      const Vec3 move(i < 400 ? 0 : 0.01, 0, 0);
      start = end;
      for (Vec3& position : end) position += move;
      centre += move;
      const MovingSurface moving{near, start, end, 0.7};
      cloth.step(positions, 1.0 / 16, {}, {}, std::nullopt, &moving);
    }
    // The facets lie up to a hundredth of the radius below the ball. The cloth is pushed off itself after it
    // is pushed out of the body.
    double nearest = 1e300;
    for (const Vec3& position : positions) nearest = std::min(nearest, (position - centre).norm());
    EXPECT_GT(nearest, 4.95 + 0.7 - 0.1) << friction;
    EXPECT_LT(nearest, 5 + 0.7 + 0.1) << "the cloth lies on the body";
    const double carried = mean_of(positions).x() - mean_of(shape.positions).x();
    if (friction > 0) {
      EXPECT_GT(carried, 0.5 * centre.x());
    } else {
      EXPECT_LT(carried, 0.5 * centre.x()) << "it slips";
    }
  }
}

// Half of a sheet is led over the other half and pressed onto it.
TEST(Cloth, KeepsOffItselfByItsThickness) {
  const Shape shape = lying();
  const TriangleMesh mesh(shape.triangles, shape.positions.size());
  const auto folded = [&](double thickness) {
    Cloth cloth(mesh, shape.positions,
                {.gravity = Vec3(0, 0, -0.05),
                 .drag = 0.1,
                 .viscosity = 1,
                 .bend_compliance = 1,
                 .thickness = thickness,
                 .friction = 0.2,
                 .floor = 0});
    std::vector<Vec3> positions = shape.positions;
    std::vector<VertexId> side;
    for (std::size_t v = 0; v < positions.size(); ++v)
      if (positions[v].x() > 11.9) side.push_back(VertexId{static_cast<int>(v)});
    std::vector<Vec3> first;
    for (const VertexId v : side) first.push_back(positions[+v]);
    for (int i = 1; i <= 1600; ++i) {
      const double share = std::min(1.0, i / 1200.0);
      std::vector<Cloth::Led> led;
      for (std::size_t k = 0; k < side.size() && i < 1300; ++k)
        led.push_back({side[k], first[k] + Vec3(-20 * share, 0, 14 * share * (1 - share) + 1)});
      cloth.step(positions, 1.0 / 16, led, {}, std::nullopt);
    }
    return positions;
  };
  const std::vector<Vec3> apart = folded(0.9);
  EXPECT_GT(closest_vertices(mesh, apart), 0.8);
  EXPECT_LT(closest_vertices(mesh, apart), 0.91) << "its layers lie on each other";
  EXPECT_TRUE(EmbeddingTest(mesh, shape.positions).embedded(apart));
  const std::vector<Vec3> through = folded(0);
  EXPECT_LT(closest_vertices(mesh, through), 0.5);
  EXPECT_FALSE(EmbeddingTest(mesh, shape.positions).embedded(through));
}

TEST(Cloth, HoldsTheVolumeThatItIsGiven) {
  const Shape shape = ball({8, 7.0});
  const TriangleMesh mesh(shape.triangles, shape.positions.size());
  Cloth cloth(mesh, shape.positions, {.drag = 0.1, .viscosity = 1, .bend_compliance = 1, .thickness = 0.7});
  std::vector<Vec3> positions = shape.positions;
  const double rest = cloth.rest_volume();
  for (int i = 0; i < 800; ++i) cloth.step(positions, 1.0 / 16, {}, {}, rest * std::max(0.6, 1 - 0.001 * i));
  EXPECT_NEAR(Cloth(mesh, positions, {}).rest_volume() / rest, 0.6, 0.01);
  EXPECT_LT(mean_of(positions).norm(), 1e-9) << "pressure moves no centre of mass";
}

}  // namespace
}  // namespace cscd::scenes
