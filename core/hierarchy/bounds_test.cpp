#include "core/hierarchy/bounds.h"

#include <array>
#include <bit>
#include <cfloat>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "core/geometry/test_exact_kdop.h"
#include "core/mesh/test_shapes.h"

namespace cscd {
namespace {

template <std::size_t N>
std::array<std::uint32_t, 2 * N> bits_of(const Slabs<N>& volume) {
  return std::bit_cast<std::array<std::uint32_t, 2 * N>>(volume);
}

// Returns the bits of the bounds, with all zeros positive: adding +0 makes zeros
// positive and changes nothing else.
template <std::size_t N>
std::array<std::uint32_t, 2 * N> bits_without_sign_of_zero(Slabs<N> volume) {
  for (float& bound : volume.at_least) bound += 0.0f;
  return bits_of(volume);
}

struct Ends {
  std::vector<Vec3> start, end;
  Motion motion() const { return {start, end}; }
};

double assorted_coordinate(std::mt19937_64& random) {
  constexpr double special[] = {0.0,           -0.0,          1,           -1,
                                0x1p-60,       -0x1p-60,      1e-310,      DBL_TRUE_MIN,
                                -DBL_TRUE_MIN, FLT_MAX,       -FLT_MAX,    0x1.ffffffp127,
                                1e39,          -1e300,        DBL_MAX,     -DBL_MAX,
                                FLT_TRUE_MIN,  1.0 + 0x1p-24, -1 - 0x1p-24};
  const auto unit = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
  switch (random() % 5) {
    case 0:
      return special[random() % std::size(special)];
    case 1:
      return static_cast<float>(unit());
    case 2:
      return std::ldexp(unit(), static_cast<int>(random() % 2000) - 1000);
    default:
      return 100 * unit();
  }
}

Ends assorted_motion(std::size_t count, unsigned seed) {
  std::mt19937_64 random(seed);
  Ends ends;
  for (std::size_t v = 0; v < count; ++v) {
    Vec3 a, b;
    for (int k = 0; k < 3; ++k) {
      a[k] = assorted_coordinate(random);
      b[k] = random() % 4 == 0 ? -a[k] : random() % 3 == 0 ? a[k] : assorted_coordinate(random);
    }
    ends.start.push_back(a);
    ends.end.push_back(b);
  }
  return ends;
}

Kdop16 scalar_bound(const MovingPoint& p, Kdop16) {
  return kdop_of(p);
}
Aabb scalar_bound(const MovingPoint& p, Aabb) {
  return aabb_of(p);
}

template <class Volume>
class SweptVertexBounds : public testing::Test {};
using Volumes = testing::Types<Kdop16, Aabb>;
TYPED_TEST_SUITE(SweptVertexBounds, Volumes);

TYPED_TEST(SweptVertexBounds, EqualTheirScalarTwin) {
  for (const std::size_t count : {1u, 2u, 7u, 8u, 15u, 16u, 31u, 32u, 33u, 63u, 64u, 65u, 10'000u}) {
    for (unsigned seed = 0; seed < 20; ++seed) {
      const Ends ends = assorted_motion(count, seed);
      TypeParam untouched;
      for (float& bound : untouched.at_least) bound = 42;
      std::vector<TypeParam> bounds(count + 1, untouched);
      swept_vertex_bounds(ends.motion(), std::span(bounds).first(count));
      for (std::size_t v = 0; v < count; ++v)
        ASSERT_EQ(bits_without_sign_of_zero(bounds[v]),
                  bits_without_sign_of_zero(
                      scalar_bound(ends.motion()[VertexId{static_cast<std::int32_t>(v)}], TypeParam{})))
            << "vertex " << v << " of " << count << ": " << ends.start[v].transpose() << " -> "
            << ends.end[v].transpose();
      ASSERT_EQ(bits_of(bounds[count]), bits_of(untouched));
    }
  }
}

// Zeros of either sign in every combination.
TYPED_TEST(SweptVertexBounds, OfZerosAreZero) {
  Ends ends;
  for (int signs = 0; signs < 64; ++signs) {
    const auto zero = [&](int bit) { return signs >> bit & 1 ? -0.0 : 0.0; };
    ends.start.emplace_back(zero(0), zero(1), zero(2));
    ends.end.emplace_back(zero(3), zero(4), zero(5));
  }
  std::vector<TypeParam> bounds(64);
  swept_vertex_bounds(ends.motion(), bounds);
  for (const TypeParam& bound : bounds)
    for (const float b : bound.at_least) ASSERT_EQ(b, 0);
}

// Returns whether every node contains the paths of all triangles below it, decided in rational arithmetic.
bool all_contained(const TriangleMesh& mesh, const Tree& tree, const Motion& motion, const auto& bound_of) {
  std::vector<NodeIndex> ancestors;
  for (NodeIndex node = 0; node < static_cast<NodeIndex>(tree.node_count()); ++node) {
    // The subtree of `node` ends at its rightmost leaf.
    NodeIndex last = node;
    while (!tree.is_leaf(last)) last = tree.right(last);
    for (NodeIndex n = node; n <= last; ++n) {
      if (!tree.is_leaf(n)) continue;
      for (const VertexId v : mesh.corners(tree.triangle(n)))
        if (!test::contains(bound_of(node), motion[v])) return false;
    }
  }
  return true;
}

TEST(SweptBounds, EveryNodeContainsThePathsBelowIt) {
  const test::Shape shape = test::icosphere(1);
  const TriangleMesh mesh = shape.mesh();
  const Tree tree = build_tree(mesh, shape.positions);
  SweptBounds bounds(mesh, tree);
  const auto bound_of = [&](NodeIndex n) -> const Kdop16& { return bounds[n]; };
  for (unsigned seed = 0; seed < 4; ++seed) {
    const Ends ends = assorted_motion(shape.positions.size(), seed);
    bounds.refit(ends.motion());
    EXPECT_TRUE(all_contained(mesh, tree, ends.motion(), bound_of));
  }
}

// Both pipelines have the same bounds, with a margin and without. Mutation: a node takes its children's
// bounds before they are made.
TYPED_TEST(SweptVertexBounds, OfAllNodesAreTheSameOneByOne) {
  const test::Shape shape = test::torus();
  const TriangleMesh mesh = shape.mesh();
  const Tree tree = build_tree(mesh, shape.positions);
  SweptVolumes<TypeParam> in_lanes(mesh, tree), one_by_one(mesh, tree, Pipeline::published);
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Ends ends = assorted_motion(shape.positions.size(), seed);
    for (const double margin : {0.0, 0.25}) {
      in_lanes.refit(ends.motion(), margin);
      one_by_one.refit(ends.motion(), margin);
      for (NodeIndex node = 0; node < static_cast<NodeIndex>(tree.node_count()); ++node)
        ASSERT_EQ(bits_without_sign_of_zero(in_lanes[node]), bits_without_sign_of_zero(one_by_one[node]));
    }
  }
}

// Every bound of every node is attained by some vertex below the node. So nothing is left over from earlier
// intervals, and nodes are as small as they can be. Together with containment this determines every bound.
TEST(SweptBounds, AreTheUnionOfWhatIsBelowWhateverCameBefore) {
  const test::Shape shape = test::torus();
  const TriangleMesh mesh = shape.mesh();
  const Tree tree = build_tree(mesh, shape.positions);
  SweptBounds used(mesh, tree);
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Ends ends = assorted_motion(shape.positions.size(), seed);
    used.refit(ends.motion());
    SweptBounds fresh(mesh, tree);
    fresh.refit(ends.motion());
    for (auto node = static_cast<NodeIndex>(tree.node_count()) - 1; node >= 0; --node) {
      ASSERT_EQ(bits_of(used[node]), bits_of(fresh[node]));
      const auto expected = [&](std::size_t k) {
        if (!tree.is_leaf(node))
          return std::min(used[tree.left(node)].at_least[k], used[tree.right(node)].at_least[k]);
        float least = std::numeric_limits<float>::infinity();
        for (const VertexId v : mesh.corners(tree.triangle(node)))
          least = std::min(least, kdop_of(ends.motion()[v]).at_least[k]);
        return least;
      };
      for (std::size_t k = 0; k < 16; ++k) ASSERT_EQ(used[node].at_least[k], expected(k));
    }
  }
}

// Saboteur: if one bound of one node is drawn in by one unit in the last place, the test notices.
TEST(SweptBounds, OneBoundDrawnInByOneUlpIsNoticed) {
  const test::Shape shape = test::octahedron();
  const TriangleMesh mesh = shape.mesh();
  const Tree tree = build_tree(mesh, shape.positions);
  SweptBounds bounds(mesh, tree);
  std::mt19937_64 random(3);
  Ends ends{shape.positions, shape.positions};
  for (Vec3& p : ends.end) p += Vec3(0.1 * assorted_coordinate(random) / DBL_MAX, 0.25, 0.125);
  bounds.refit(ends.motion());
  for (NodeIndex sabotaged = 0; sabotaged < static_cast<NodeIndex>(tree.node_count()); ++sabotaged)
    for (std::size_t k = 0; k < 16; ++k) {
      Kdop16 drawn_in = bounds[sabotaged];
      drawn_in.at_least[k] = std::nextafter(drawn_in.at_least[k], std::numeric_limits<float>::infinity());
      const auto bound_of = [&](NodeIndex n) -> const Kdop16& {
        return n == sabotaged ? drawn_in : bounds[n];
      };
      ASSERT_FALSE(all_contained(mesh, tree, ends.motion(), bound_of)) << "node " << sabotaged << ", " << k;
    }
}

}  // namespace
}  // namespace cscd
