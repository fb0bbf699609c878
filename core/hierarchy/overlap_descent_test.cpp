#include "core/hierarchy/overlap_descent.h"

#include <algorithm>
#include <functional>
#include <gtest/gtest.h>
#include <random>
#include <set>

#include "core/mesh/test_shapes.h"

namespace cscd {
namespace {

using Pairs = std::vector<std::pair<int, int>>;  // of triangles, sorted, with repetitions

// A moving mesh with its tree and bounds.
struct Scene {
  test::Shape shape;
  TriangleMesh mesh;
  std::vector<Vec3> end;
  Tree tree;
  SweptBounds bounds;

  Scene(const test::Shape& shape_in, double motion, unsigned seed)
      : shape(shape_in),
        mesh(shape.mesh()),
        end(shape.positions),
        tree(build_tree(mesh, shape.positions)),
        bounds(mesh, tree) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(-motion, motion);
    for (Vec3& p : end) p += Vec3(unit(random), unit(random), unit(random));
    bounds.refit(Motion(shape.positions, end));
  }
  NodeIndex node_count() const { return static_cast<NodeIndex>(tree.node_count()); }
  NodeIndex behind(NodeIndex node) const {
    while (!tree.is_leaf(node)) node = tree.right(node);
    return node + 1;
  }
  std::pair<int, int> named(NodeIndex a, NodeIndex b) const {
    return std::minmax(static_cast<int>(tree.triangle(a)), static_cast<int>(tree.triangle(b)));
  }
  // The quadratic loop: compares leaves in [a, a_end) with leaves in [b, b_end), each unordered pair once.
  Pairs overlapping(NodeIndex a, NodeIndex a_end, NodeIndex b, NodeIndex b_end) const {
    Pairs pairs;
    for (NodeIndex m = a; m < a_end; ++m)
      for (NodeIndex n = std::max(b, a == b ? m + 1 : b); n < b_end; ++n)
        if (tree.is_leaf(m) && tree.is_leaf(n) && overlap(bounds[m], bounds[n])) pairs.push_back(named(m, n));
    std::sort(pairs.begin(), pairs.end());
    return pairs;
  }
};

Pairs sorted(Pairs pairs) {
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

const auto kNoSkip = [](NodeIndex, NodeIndex) { return false; };

Pairs self_pairs(const Scene& scene) {
  Pairs pairs;
  self_descent(
      scene.tree, scene.bounds, 0, [&](NodeIndex n) { return scene.tree.is_leaf(n); }, kNoSkip,
      [&](NodeIndex a, NodeIndex b) { pairs.push_back(scene.named(a, b)); });
  return sorted(pairs);
}

std::vector<Scene> scenes() {
  std::vector<Scene> all;
  all.emplace_back(test::octahedron(), 0.0, 1);
  all.emplace_back(test::icosphere(2), 0.05, 2);
  all.emplace_back(test::torus(), 0.3, 3);
  all.emplace_back(test::capped_tube(5, 20, 0.2, 9), 0.0, 4);
  all.emplace_back(test::together(test::icosphere(1), test::moved(test::box(), {0.9, 0, 0})), 0.5, 5);
  all.emplace_back(test::Shape{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {test::corners(0, 1, 2)}}, 1.0, 6);
  return all;
}

TEST(SelfDescent, EmitsExactlyTheOverlappingPairsOfLeavesOnceEach) {
  for (const Scene& scene : scenes()) {
    const Pairs expected = scene.overlapping(0, scene.node_count(), 0, scene.node_count());
    EXPECT_EQ(self_pairs(scene), expected);
    EXPECT_EQ(expected.empty(), scene.mesh.triangle_count() == 1);
  }
}

TEST(PairDescent, EmitsExactlyTheOverlappingPairsOfLeavesOnceEach) {
  int descents = 0;
  for (const Scene& scene : scenes()) {
    for (NodeIndex node = 0; node < scene.node_count(); ++node) {
      if (scene.tree.is_leaf(node)) continue;
      const NodeIndex a = scene.tree.left(node), b = scene.tree.right(node);
      if (!overlap(scene.bounds[a], scene.bounds[b])) continue;
      Pairs pairs;
      pair_descent(
          scene.tree, scene.bounds, a, b, [&](NodeIndex n) { return scene.tree.is_leaf(n); }, kNoSkip,
          [&](NodeIndex m, NodeIndex n) { pairs.push_back(scene.named(m, n)); });
      ASSERT_EQ(sorted(pairs), scene.overlapping(a, scene.behind(a), b, scene.behind(b)));
      ++descents;
    }
  }
  EXPECT_GT(descents, 300);
}

// Specifies a second time, without sharing code, what a descent has to do. Returns the number of pairs
// of nodes whose overlap is asked.
std::uint64_t asked_below(const Scene& scene, NodeIndex a, NodeIndex b);
std::uint64_t asked(const Scene& scene, NodeIndex a, NodeIndex b) {
  return 1 + (overlap(scene.bounds[a], scene.bounds[b]) ? asked_below(scene, a, b) : 0);
}
std::vector<NodeIndex> next_to_ask(const Scene& scene, NodeIndex node) {
  if (scene.tree.is_leaf(node)) return {node};
  return {scene.tree.left(node), scene.tree.right(node)};
}
std::uint64_t asked_below(const Scene& scene, NodeIndex a, NodeIndex b) {
  if (scene.tree.is_leaf(a) && scene.tree.is_leaf(b)) return 0;
  std::uint64_t sum = 0;
  for (const NodeIndex m : next_to_ask(scene, a))
    for (const NodeIndex n : next_to_ask(scene, b)) sum += asked(scene, m, n);
  return sum;
}

TEST(SelfDescent, ReturnsTheNumberOfOverlapTests) {
  for (const Scene& scene : scenes()) {
    std::uint64_t expected = 0;
    for (NodeIndex node = 0; node < scene.node_count(); ++node)
      if (!scene.tree.is_leaf(node)) expected += asked(scene, scene.tree.left(node), scene.tree.right(node));
    // `skip` is asked before every overlap test, and once for every inner node.
    std::uint64_t skip_calls = 0;
    const std::uint64_t tests = self_descent(
        scene.tree, scene.bounds, 0, [&](NodeIndex n) { return scene.tree.is_leaf(n); },
        [&](NodeIndex a, NodeIndex b) {
          skip_calls += a != b;
          return false;
        },
        [](NodeIndex, NodeIndex) {});
    EXPECT_EQ(tests, expected);
    EXPECT_EQ(tests, skip_calls);
  }
}

TEST(PairDescent, ReturnsTheNumberOfOverlapTestsWithoutTheOneThatIsKnown) {
  const Scene scene(test::icosphere(2), 0.05, 2);
  const NodeIndex a = scene.tree.left(0), b = scene.tree.right(0);
  const auto is_leaf = [&](NodeIndex n) { return scene.tree.is_leaf(n); };
  const auto ignore = [](NodeIndex, NodeIndex) {};
  EXPECT_EQ(pair_descent(scene.tree, scene.bounds, a, b, is_leaf, kNoSkip, ignore), asked_below(scene, a, b));
  // For two leaves there is nothing left to test.
  const auto all_are_leaves = [](NodeIndex) { return true; };
  int emitted = 0;
  EXPECT_EQ(pair_descent(scene.tree, scene.bounds, a, b, all_are_leaves, kNoSkip,
                         [&](NodeIndex, NodeIndex) { ++emitted; }),
            0u);
  EXPECT_EQ(emitted, 1);
}

TEST(Descent, SkipPrunesWhatItNamesAndNothingElse) {
  const Scene scene(test::torus(), 0.3, 3);
  const NodeIndex mid = scene.tree.right(0);
  const auto is_leaf = [&](NodeIndex n) { return scene.tree.is_leaf(n); };
  const auto run = [&](auto skip) {
    Pairs pairs;
    self_descent(scene.tree, scene.bounds, 0, is_leaf, skip,
                 [&](NodeIndex a, NodeIndex b) { pairs.push_back(scene.named(a, b)); });
    return sorted(pairs);
  };
  const auto concat = [](Pairs a, const Pairs& b) {
    a.insert(a.end(), b.begin(), b.end());
    return sorted(a);
  };
  const Pairs left = scene.overlapping(1, mid, 1, mid);
  const Pairs right = scene.overlapping(mid, scene.node_count(), mid, scene.node_count());
  const Pairs across = scene.overlapping(1, mid, mid, scene.node_count());
  ASSERT_FALSE(left.empty() || right.empty() || across.empty());
  EXPECT_EQ(run([](NodeIndex a, NodeIndex b) { return a == 1 && b == 1; }), concat(right, across));
  EXPECT_EQ(run([&](NodeIndex a, NodeIndex b) { return a == 1 && b == mid; }), concat(left, right));
  EXPECT_TRUE(run([](NodeIndex a, NodeIndex b) { return a == 0 && b == 0; }).empty());
  EXPECT_TRUE(run([](NodeIndex, NodeIndex) { return true; }).empty());
  int emitted = 0;
  EXPECT_EQ(pair_descent(
                scene.tree, scene.bounds, 1, mid, is_leaf, [](NodeIndex, NodeIndex) { return true; },
                [&](NodeIndex, NodeIndex) { ++emitted; }),
            0u);
  EXPECT_EQ(emitted, 0);
}

// A descent that stops at cluster roots emits pairs of clusters.
TEST(SelfDescent, StopsAtClusterRoots) {
  const test::Shape shape = test::icosphere(2);
  const TriangleMesh mesh = shape.mesh();
  std::vector<std::int32_t> label(mesh.triangle_count());
  for (std::size_t t = 0; t < label.size(); ++t) label[t] = static_cast<std::int32_t>(t / 20);
  const Tree tree = build_tree(mesh, shape.positions, label, 16);
  SweptBounds bounds(mesh, tree);
  bounds.refit(Motion(shape.positions, shape.positions));
  const std::set<NodeIndex> roots(tree.cluster_roots().begin(), tree.cluster_roots().end());
  std::multiset<std::pair<NodeIndex, NodeIndex>> emitted, expected;
  self_descent(
      tree, bounds, 0, [&](NodeIndex n) { return roots.count(n) > 0; }, kNoSkip,
      [&](NodeIndex a, NodeIndex b) { emitted.insert(std::minmax(a, b)); });
  for (const NodeIndex a : roots)
    for (const NodeIndex b : roots)
      if (a < b && overlap(bounds[a], bounds[b])) expected.insert({a, b});
  EXPECT_EQ(emitted, expected);
  EXPECT_FALSE(expected.empty());
}

// Saboteur: a descent that never looks at the tree's last leaf differs from the quadratic loop.
TEST(SelfDescent, ThatForgetsTheLastLeafIsNoticed) {
  for (const Scene& scene : scenes()) {
    if (scene.mesh.triangle_count() == 1) continue;
    const NodeIndex last = scene.node_count() - 1;
    Pairs pairs;
    self_descent(
        scene.tree, scene.bounds, 0, [&](NodeIndex n) { return scene.tree.is_leaf(n); },
        [&](NodeIndex a, NodeIndex b) { return a == last || b == last; },
        [&](NodeIndex a, NodeIndex b) { pairs.push_back(scene.named(a, b)); });
    EXPECT_NE(sorted(pairs), scene.overlapping(0, scene.node_count(), 0, scene.node_count()));
  }
}

}  // namespace
}  // namespace cscd
