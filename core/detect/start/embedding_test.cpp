#include "core/detect/start/embedding.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <gtest/gtest.h>
#include <random>

#include "core/mesh/test_shapes.h"

namespace cscd {
namespace {

using test::corners;
using test::Shape;

bool embedded(const Shape& shape) {
  const TriangleMesh mesh = shape.mesh();
  return EmbeddingTest(mesh, shape.positions).embedded(shape.positions);
}

TEST(Embedding, PlainSurfacesAreEmbedded) {
  EXPECT_TRUE(embedded(test::octahedron()));
  EXPECT_TRUE(embedded(test::icosphere(2)));
  EXPECT_TRUE(embedded(test::torus()));
  EXPECT_TRUE(embedded(test::box()));  // neighbouring triangles lie in one plane
  EXPECT_TRUE(embedded(test::capped_tube(6, 4, 1, 5)));
  EXPECT_TRUE(embedded({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {corners(0, 1, 2)}}));
}

TEST(Embedding, ComponentsBesideAndInsideEachOtherAreEmbedded) {
  EXPECT_TRUE(embedded(test::together(test::octahedron(), test::moved(test::octahedron(), {3, 0, 0}))));
  EXPECT_TRUE(embedded(test::together(test::octahedron(), test::octahedron(0.5))));
  // Boxes as near to each other as doubles can be are embedded; boxes that touch are not.
  const double beyond = std::nextafter(1.0, 2.0);
  EXPECT_TRUE(embedded(test::together(test::box(), test::box({beyond, 0, 0}, {2, 1, 1}))));
  EXPECT_FALSE(embedded(test::together(test::box(), test::box({1, 0, 0}, {2, 1, 1}))));
}

TEST(Embedding, OverlappingComponentsAreNot) {
  EXPECT_FALSE(
      embedded(test::together(test::octahedron(), test::moved(test::octahedron(), {0.3, 0.2, 0.1}))));
  EXPECT_FALSE(embedded(test::together(test::octahedron(), test::octahedron())));
  EXPECT_FALSE(embedded(test::together(test::box(), test::moved(test::box(), {0.5, 0.5, 0.5}))));
}

// An edge pierces a face, but no vertex lies on a face and no two edges meet. Only the test of a
// segment against a triangle sees it.
TEST(Embedding, APiercedFaceIsNotEmbeddedAlthoughNoFeaturePairTouches) {
  const Shape pierced{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {9, 9, 9}},
                      {corners(0, 1, 2), corners(3, 4, 5)}};
  const TriangleMesh mesh = pierced.mesh();
  const auto found = EmbeddingTest(mesh, pierced.positions).find_intersection(pierced.positions);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->first, TriangleId{0});
  EXPECT_EQ(found->second, TriangleId{1});
  Shape beside = pierced;
  beside.positions[3] = {3, 3, -1};
  beside.positions[4] = {3, 3, 1};
  EXPECT_TRUE(embedded(beside));
}

TEST(Embedding, ATouchingVertexIsNot) {
  for (const Vec3& tip : {Vec3(1, 1, 0), Vec3(2, 2, 0), Vec3(0, 0, 0)}) {
    Shape shape{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, tip, {1, 2, 5}, {2, 1, 5}},
                {corners(0, 1, 2), corners(3, 4, 5)}};
    EXPECT_FALSE(embedded(shape)) << tip.transpose();
    shape.positions[3].z() = 0x1p-1074;
    EXPECT_TRUE(embedded(shape)) << tip.transpose();
  }
}

// Two triangles have a common edge and are folded onto each other in one plane.
TEST(Embedding, FoldedNeighboursInOnePlaneAreNot) {
  const auto folded = [](const Vec3& tip) {
    return Shape{{{0, 0, 0}, {4, 0, 0}, {1, 3, 0}, tip}, {corners(0, 1, 2), corners(1, 0, 3)}};
  };
  EXPECT_TRUE(embedded(folded({1, -3, 0})));  // unfolded
  EXPECT_FALSE(embedded(folded({1, 1, 0})));  // its tip is inside the other
  EXPECT_FALSE(embedded(folded({2, 8, 0})));  // it holds the other's tip
  EXPECT_FALSE(embedded(folded({5, 3, 0})));  // their sides cross
  EXPECT_FALSE(embedded(folded({1, 3, 0})));  // both are in the same place
  EXPECT_TRUE(embedded(folded({1, 1, 0x1p-1074})));
}

// Two triangles have a common corner and lie in one plane or pass through each other.
TEST(Embedding, NeighboursAtAVertex) {
  const auto at_corner = [](const Vec3& p, const Vec3& q) {
    return Shape{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, p, q}, {corners(0, 1, 2), corners(0, 3, 4)}};
  };
  EXPECT_TRUE(embedded(at_corner({-1, 0, 0}, {0, -1, 0})));
  EXPECT_FALSE(embedded(at_corner({1, 1, 0}, {0, -1, 0})));   // a corner inside
  EXPECT_FALSE(embedded(at_corner({9, 9, 0}, {-1, 9, 0})));   // a side leaves across the opposite side
  EXPECT_FALSE(embedded(at_corner({9, 0, 0}, {9, -9, 0})));   // a side runs along a side
  EXPECT_FALSE(embedded(at_corner({1, 0, 0}, {9, -9, 0})));   // a corner on a side
  EXPECT_FALSE(embedded(at_corner({1, 1, -1}, {1, 1, 1})));   // the opposite side pierces the face
  EXPECT_FALSE(embedded(at_corner({9, -9, 0}, {-9, 9, 0})));  // the opposite side passes through the corner
  EXPECT_FALSE(embedded(at_corner({3, 3, -1}, {3, 3, 1})));   // the far side pierces the other
  EXPECT_TRUE(embedded(at_corner({-3, -3, -1}, {-3, -3, 1})));
  EXPECT_TRUE(embedded(at_corner({1, 1, 1}, {2, 1, 1})));
}

// One piece of a bent tube passes through another, wherever the triangles stand in the list.
TEST(Embedding, DoesNotDependOnTheOrderOfTriangles) {
  Shape shape = test::capped_tube(6, 24, 0.4, 12);
  for (Vec3& p : shape.positions) {  // wound into one and a half turns of a helix without pitch
    const double angle = p.x() * 0.8;
    p = Vec3((2 + p.y()) * std::cos(angle), (2 + p.y()) * std::sin(angle), p.z());
  }
  EXPECT_FALSE(embedded(shape));
  std::mt19937 random(1);
  for (int i = 0; i < 5; ++i) {
    std::shuffle(shape.triangles.begin(), shape.triangles.end(), random);
    EXPECT_FALSE(embedded(shape));
  }
}

// A tree that was shaped by another frame finds the same.
TEST(Embedding, AnyReferenceWillDo) {
  const Shape apart = test::together(test::icosphere(1), test::moved(test::icosphere(1), {9, 0, 0}));
  const Shape together = test::together(test::icosphere(1), test::moved(test::icosphere(1), {1.5, 0, 0}));
  const TriangleMesh mesh = apart.mesh();
  for (const Shape* reference : {&apart, &together}) {
    EmbeddingTest test(mesh, reference->positions);
    for (int i = 0; i < 3; ++i) {
      EXPECT_TRUE(test.embedded(apart.positions));
      EXPECT_FALSE(test.embedded(together.positions));
    }
  }
}

// A small sabotage: a single vertex of a surface of 320 triangles is pushed through the opposite wall.
TEST(Embedding, FindsTheOneVertexThatWentThrough) {
  Shape shape = test::icosphere(2);
  EXPECT_TRUE(embedded(shape));
  shape.positions[0] = -1.05 * shape.positions[0];
  EXPECT_FALSE(embedded(shape));
}

}  // namespace
}  // namespace cscd
