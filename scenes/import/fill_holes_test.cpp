#include "scenes/import/fill_holes.h"

#include <gtest/gtest.h>

#include "core/mesh/test_shapes.h"

namespace cscd::scenes {
namespace {

// Removes the triangles at these vertices.
test::Shape without(test::Shape shape, const std::vector<int>& vertices) {
  std::erase_if(shape.triangles, [&](const Triangle& t) {
    return std::any_of(t.begin(), t.end(), [&](VertexId v) {
      return std::find(vertices.begin(), vertices.end(), static_cast<int>(v)) != vertices.end();
    });
  });
  return shape;
}

test::Shape with(test::Shape shape, const FilledHoles& filled) {
  shape.triangles.insert(shape.triangles.end(), filled.triangles.begin(), filled.triangles.end());
  return shape;
}

TEST(FillHoles, ClosesWithTheOrientationOfTheSurface) {
  const test::Shape open = without(test::icosphere(2), {0, 3});
  const FilledHoles filled = fill_holes(open.mesh(), open.positions, 10);
  EXPECT_EQ(filled.holes, 2u);
  EXPECT_EQ(filled.left, 0u);
  const test::Shape closed = with(open, filled);
  EXPECT_TRUE(closed.mesh().closed_and_oriented());
  EXPECT_GT(test::six_volumes(closed), 0.9 * test::six_volumes(test::icosphere(2)));
}

TEST(FillHoles, LeavesLongAndTangledOnes) {
  const test::Shape sphere = test::icosphere(2);
  const test::Shape open = without(sphere, {0, 3});
  EXPECT_EQ(fill_holes(open.mesh(), open.positions, 4).left, 2u);
  EXPECT_TRUE(fill_holes(open.mesh(), open.positions, 4).triangles.empty());
  EXPECT_TRUE(fill_holes(sphere.mesh(), sphere.positions, 99).triangles.empty());
  // Two holes with one vertex in common.
  const test::Shape torus = test::torus();
  const test::Shape touching = without(torus, {0, 2});
  const FilledHoles filled = fill_holes(touching.mesh(), touching.positions, 99);
  EXPECT_EQ(filled.holes + filled.left > 0, true);
  EXPECT_EQ(with(touching, filled).mesh().defects().size() > 0, filled.left > 0);
}

}  // namespace
}  // namespace cscd::scenes
