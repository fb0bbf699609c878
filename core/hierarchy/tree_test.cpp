#include "core/hierarchy/tree.h"

#include <algorithm>
#include <bit>
#include <cfloat>
#include <gtest/gtest.h>
#include <random>

#include "core/mesh/test_shapes.h"

namespace cscd {
namespace {

// Walks the subtree at `node` and checks that it lies in one piece from `node` on. Appends its triangles,
// sets its depth and returns the first node after it.
NodeIndex walk(const Tree& tree, NodeIndex node, int& depth, std::vector<int>& triangles) {
  if (tree.is_leaf(node)) {
    depth = 0;
    triangles.push_back(static_cast<int>(tree.triangle(node)));
    return node + 1;
  }
  int left_depth, right_depth;
  EXPECT_EQ(tree.left(node), node + 1);
  const NodeIndex behind_left = walk(tree, tree.left(node), left_depth, triangles);
  EXPECT_EQ(tree.right(node), behind_left);
  const NodeIndex behind = walk(tree, tree.right(node), right_depth, triangles);
  depth = 1 + std::max(left_depth, right_depth);
  return behind;
}

std::vector<int> triangles_below(const Tree& tree, NodeIndex node) {
  int depth;
  std::vector<int> triangles;
  walk(tree, node, depth, triangles);
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

// A sphere no two of whose centroids share a coordinate.
test::Shape uneven_sphere(int splits) {
  test::Shape shape = test::icosphere(splits);
  std::mt19937 random(1);
  for (Vec3& p : shape.positions)
    for (double& x : p) x += 1e-10 * static_cast<double>(random());
  return shape;
}

int ceil_log2(std::size_t n) {
  return static_cast<int>(std::bit_width(n - 1));
}

void expect_sound(const Tree& tree, std::size_t triangle_count) {
  ASSERT_EQ(tree.node_count(), 2 * triangle_count - 1);
  int depth;
  std::vector<int> triangles;
  EXPECT_EQ(walk(tree, 0, depth, triangles), static_cast<NodeIndex>(tree.node_count()));
  EXPECT_EQ(depth, ceil_log2(triangle_count));
  std::sort(triangles.begin(), triangles.end());
  ASSERT_EQ(triangles.size(), triangle_count);
  for (std::size_t t = 0; t < triangle_count; ++t) ASSERT_EQ(triangles[t], static_cast<int>(t));
}

TEST(Tree, HoldsEveryTriangleOnceInDepthFirstOrderAndBalanced) {
  for (const test::Shape& shape : {test::octahedron(), test::icosphere(2), test::torus(13, 7), test::box(),
                                   test::capped_tube(5, 9, 0.1, 7)})
    expect_sound(build_tree(shape.mesh(), shape.positions), shape.triangles.size());
}

TEST(Tree, OfOneTriangleIsALeaf) {
  const test::Shape shape{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {test::corners(0, 1, 2)}};
  const Tree tree = build_tree(shape.mesh(), shape.positions);
  ASSERT_EQ(tree.node_count(), 1u);
  EXPECT_TRUE(tree.is_leaf(0));
  EXPECT_EQ(tree.triangle(0), TriangleId{0});
  EXPECT_TRUE(tree.cluster_roots().empty());
}

TEST(Tree, SurvivesEqualCentroidsAndTheEndsOfTheRange) {
  test::Shape shape = uneven_sphere(2);
  const std::vector<Vec3> sphere = shape.positions;
  const auto build = [&] {
    const Tree tree = build_tree(shape.mesh(), shape.positions);
    expect_sound(tree, shape.triangles.size());
    return tree;
  };
  for (Vec3& p : shape.positions) p = {0.1, 0.2, 0.3};
  build();
  for (std::size_t i = 0; i < sphere.size(); ++i) shape.positions[i] = 0x1p1022 * sphere[i];
  const Tree huge = build();
  // The scale does not change the splits.
  for (std::size_t i = 0; i < sphere.size(); ++i) shape.positions[i] = sphere[i];
  const Tree unit = build();
  for (NodeIndex n = 0; n < static_cast<NodeIndex>(unit.node_count()); ++n) {
    ASSERT_EQ(unit.is_leaf(n), huge.is_leaf(n));
    if (unit.is_leaf(n)) {
      ASSERT_EQ(unit.triangle(n), huge.triangle(n));
    }
  }
  for (std::size_t i = 0; i < sphere.size(); ++i)
    shape.positions[i] = Vec3(DBL_MAX, -DBL_MAX, i % 2 == 0 ? DBL_MAX : -DBL_MAX);
  build();
  for (std::size_t i = 0; i < sphere.size(); ++i) shape.positions[i] = DBL_TRUE_MIN * sphere[i];
  build();
}

TEST(Tree, SplitsAtTheMedianOfTheLongestAxis) {
  const test::Shape shape = test::capped_tube(6, 40, 0.1, 10);
  const TriangleMesh mesh = shape.mesh();
  const Tree tree = build_tree(mesh, shape.positions);
  const auto x_of = [&](int t) {
    double x = 0;
    for (const VertexId v : mesh.corners(TriangleId{t})) x += shape.positions[+v].x() / 3;
    return x;
  };
  double left = -1, right = 11;
  const std::vector<int> low = triangles_below(tree, tree.left(0)),
                         high = triangles_below(tree, tree.right(0));
  for (const int t : low) left = std::max(left, x_of(t));
  for (const int t : high) right = std::min(right, x_of(t));
  EXPECT_LE(left, right + 1e-12);
  EXPECT_NEAR(left, 5, 0.5);
}

// The same triangles in another order give the same tree up to their numbers, if all centroids differ.
TEST(Tree, DoesNotDependOnWhereTrianglesStandInTheList) {
  const test::Shape shape = uneven_sphere(1);
  std::mt19937 random(1);
  const Tree tree = build_tree(shape.mesh(), shape.positions);
  std::vector<int> order(shape.triangles.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::shuffle(order.begin(), order.end(), random);
  test::Shape shuffled{shape.positions, {}};
  for (const int t : order) shuffled.triangles.push_back(shape.triangles[static_cast<std::size_t>(t)]);
  const Tree other = build_tree(shuffled.mesh(), shuffled.positions);
  for (NodeIndex n = 0; n < static_cast<NodeIndex>(tree.node_count()); ++n) {
    ASSERT_EQ(tree.is_leaf(n), other.is_leaf(n));
    if (tree.is_leaf(n)) {
      ASSERT_EQ(static_cast<int>(tree.triangle(n)), order[+other.triangle(n)]);
    }
  }
}

TEST(ClusterTree, EachRootHoldsExactlyItsCluster) {
  const test::Shape shape = test::icosphere(2);
  const TriangleMesh mesh = shape.mesh();
  std::mt19937 random(2);
  for (const int clusters : {1, 2, 3, 17, 320}) {
    std::vector<std::int32_t> label(mesh.triangle_count());
    for (std::size_t t = 0; t < label.size(); ++t)  // every label occurs; sizes differ
      label[t] = t < static_cast<std::size_t>(clusters)
                     ? static_cast<std::int32_t>(t)
                     : static_cast<std::int32_t>(random() % static_cast<unsigned>(clusters) %
                                                 (1 + random() % static_cast<unsigned>(clusters)));
    const Tree tree = build_tree(mesh, shape.positions, label, clusters);
    ASSERT_EQ(tree.node_count(), 2 * mesh.triangle_count() - 1);
    ASSERT_EQ(tree.cluster_roots().size(), static_cast<std::size_t>(clusters));
    int depth;
    std::vector<int> all;
    EXPECT_EQ(walk(tree, 0, depth, all), static_cast<NodeIndex>(tree.node_count()));
    EXPECT_EQ(all.size(), mesh.triangle_count());
    for (int c = 0; c < clusters; ++c) {
      std::vector<int> expected, found;
      for (std::size_t t = 0; t < label.size(); ++t)
        if (label[t] == c) expected.push_back(static_cast<int>(t));
      int local_depth;
      walk(tree, tree.cluster_roots()[static_cast<std::size_t>(c)], local_depth, found);
      EXPECT_EQ(local_depth, ceil_log2(expected.size()));
      std::sort(found.begin(), found.end());
      EXPECT_EQ(found, expected) << "cluster " << c;
    }
  }
}

}  // namespace
}  // namespace cscd
