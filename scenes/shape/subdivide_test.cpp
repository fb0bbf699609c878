#include "scenes/shape/subdivide.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "scenes/shape/limbed_sphere.h"
#include "scenes/shape/test_shapes.h"
#include "scenes/shape/tube.h"

namespace cscd::scenes {
namespace {

Shape small_tube() {
  TubeParameters p;
  p.rings = 40;
  p.sides = 12;
  p.bones = 8;
  p.length = 12;
  return tube(p);
}

TEST(Subdivided, HasFourTimesTheTrianglesOfAWellFormedShape) {
  const Shape coarse = small_tube();
  const Shape fine = subdivided(coarse);
  expect_well_formed(fine);
  EXPECT_EQ(fine.triangles.size(), 4 * coarse.triangles.size());
  EXPECT_EQ(fine.rig.parent, coarse.rig.parent);
  EXPECT_EQ(fine.bone_names, coarse.bone_names);
  EXPECT_LT(volume(fine), volume(coarse)) << "Loop's surface lies inside a convex one";
  EXPECT_GT(volume(fine), 0.9 * volume(coarse));
  EXPECT_LT(steepest_weight(fine), 0.6 * steepest_weight(coarse)) << "weights run over twice the edges";
}

TEST(Subdivided, KeepsAPlanePlaneAndMovesALineByItsRule) {
  // In an octahedron every vertex has four neighbours, whose mean is the centre.
  Shape shape;
  shape.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (const auto& [a, b] : {std::pair{0, 2}, {2, 1}, {1, 3}, {3, 0}}) {
    shape.triangles.push_back({VertexId{a}, VertexId{b}, VertexId{4}});
    shape.triangles.push_back({VertexId{b}, VertexId{a}, VertexId{5}});
  }
  shape.weights.resize(6);
  for (JointWeights& weights : shape.weights)
    weights = {{BoneId{0}, BoneId{-1}, BoneId{-1}, BoneId{-1}}, {1}};
  shape.weights[0].bone[0] = BoneId{1};
  const Shape fine = subdivided(shape);
  EXPECT_EQ(fine.positions[0], Vec3(0.625, 0, 0));
  EXPECT_EQ(fine.weights[0].bone[0], BoneId{1});
  EXPECT_EQ(fine.weights[0].weight[0], 0.625);
  EXPECT_EQ(fine.weights[0].weight[1], 0.375);
  for (std::size_t i = 6; i < fine.positions.size(); ++i)
    EXPECT_EQ(fine.positions[i].cwiseAbs().sum(), 0.75) << "of an edge: 3/8 of both ends, the rest cancels";
}

TEST(Subdivided, RefusesAnOpenSurface) {
  Shape shape = small_tube();
  shape.triangles.pop_back();
  EXPECT_THROW(subdivided(shape), InputError);
}

}  // namespace
}  // namespace cscd::scenes
