#include "core/fast/patch_descent.h"

#include <gtest/gtest.h>

#include "core/fast/prepare/cut_surface.h"
#include "core/mesh/test_shapes.h"

namespace cscd::fast {
namespace {

// The cache returns the result of the patch that is asked for, whatever was asked for before. If the first of
// two patches is asked for again after the second, the results of both are in the cache.
TEST(PatchDescent, WhatIsMadeOnDemandIsOfThePatch) {
  constexpr std::size_t kPatches = 300;
  OnDemand<std::size_t> squares(kPatches);
  std::size_t made = 0;
  const auto square = [&](std::size_t p) -> const std::size_t& {
    return squares.of(p, [&] {
      ++made;
      return p * p;
    });
  };
  for (int interval = 0; interval < 3; ++interval) {
    squares.start_interval();
    made = 0;
    for (std::size_t p = 0; p < kPatches; ++p) EXPECT_EQ(square(p), p * p);
    EXPECT_EQ(made, kPatches);
    for (std::size_t p = kPatches; p-- > 0;) EXPECT_EQ(square(p), p * p);
    EXPECT_GT(made, kPatches);      // the cache holds few results
    EXPECT_LT(made, 2 * kPatches);  // the cache holds the last results
    for (std::size_t p = 0; p < kPatches; ++p) {
      const std::size_t q = (7 * p + 3) % kPatches;
      square(p);
      const std::size_t &second = square(q), &first = square(p);
      EXPECT_EQ(first, p * p);
      EXPECT_EQ(second, q * q);
    }
  }
}

TEST(PatchDescent, NothingMadeOutlastsItsInterval) {
  OnDemand<int> numbers(2);
  EXPECT_EQ(numbers.of(0, [] { return 1; }), 1);
  EXPECT_EQ(numbers.of(0, [] { return 2; }), 1);
  numbers.start_interval();
  EXPECT_EQ(numbers.of(0, [] { return 3; }), 3);
}

// Two leaves have no pairs below them, and all other nodes do. A surface may be a single patch, whose leaf is
// the root. Mutation: leaves are split, and nothing else is.
TEST(PatchDescent, NodesCanBeSplitUnlessBothAreLeaves) {
  for (const test::Shape& shape : {test::octahedron(), test::icosphere(2)}) {
    const TriangleMesh mesh = shape.mesh();
    const CutSurface cut =
        cut_surface(mesh, shape.positions, std::vector<std::int32_t>(mesh.triangle_count(), 0));
    const LocalPositions local(shape.positions);
    const Certificates certificates(mesh, cut.tree, cut.covers);
    const PatchDescent descent({cut.tree, local, certificates, nullptr, true, false});
    const std::vector<PatchTree::Node>& nodes = cut.tree.nodes;
    EXPECT_EQ(nodes.size() == 1, mesh.triangle_count() == 8);
    for (std::size_t a = 0; a < nodes.size(); ++a)
      for (std::size_t b = 0; b < nodes.size(); ++b)
        EXPECT_EQ(descent.can_split({a, b}), !nodes[a].is_leaf() || !nodes[b].is_leaf()) << a << ", " << b;
  }
}

}  // namespace
}  // namespace cscd::fast
