#include "core/engine/parting.h"

#include <gtest/gtest.h>
#include <set>

#include "core/engine/test_body.h"
#include "core/engine/test_touching.h"

namespace cscd::fast {
namespace {

// Pairs of triangles that a plane parts, by all pairs of patches.
std::set<std::pair<TriangleId, TriangleId>> parted(const PatchTree& tree, const LocalPositions& local) {
  std::set<std::pair<TriangleId, TriangleId>> found;
  for (std::size_t p = 0; p < tree.patches.size(); ++p)
    for (std::size_t q = 0; q < tree.patches.size(); ++q) {
      const Patch &a = tree.patches[p], &b = tree.patches[q];
      const PatchPlanes of_a = planes_of(local.records(), a), of_b = planes_of(local.records(), b);
      for (std::size_t l = 0; a.lanes >> l != 0; ++l) {
        const Mask16 asked = p == q ? static_cast<Mask16>(b.lanes & ~(1U << l)) : b.lanes;
        const Mask16 left = not_parted(of_b, b, asked, {of_a, a, l}, tree.common_of(p, q), local.error());
        EXPECT_EQ(left & ~asked, 0);
        for (std::size_t m = 0; b.lanes >> m != 0; ++m)
          if ((asked & ~left) >> m & 1) found.emplace(tree.triangles[p][l], tree.triangles[q][m]);
      }
    }
  return found;
}

struct Interval {
  TriangleMesh mesh;
  std::vector<Vec3> start, end;

  // Of the mesh cut as one cluster.
  std::set<std::pair<TriangleId, TriangleId>> parted() const {
    Covers covers;
    for (Cover& cover : covers) cover.cluster_of.assign(mesh.triangle_count(), kNone);
    covers[0].cluster_of.assign(mesh.triangle_count(), 0);
    const PatchTree tree = make_patches(mesh, start, covers);
    LocalPositions local(start);
    local.update(motion());
    return fast::parted(tree, local);
  }
  Motion motion() const { return Motion(start, end); }
};

// How many corners two triangles share.
std::size_t shared(const TriangleMesh& mesh, TriangleId a, TriangleId b) {
  std::size_t count = 0;
  for (const VertexId v : mesh.corners(a))
    for (const VertexId w : mesh.corners(b)) count += v == w;
  return count;
}

// Skins that are thrown about until they meet themselves. Mutations: signs of both sides taken for one; the
// shared corners of other triangles; a pair parted where only some corners are on one side.
TEST(Parting, NoPairThatTouchesIsParted) {
  std::size_t met = 0, by_shared[3] = {};
  for (int seed = 1; seed <= 5; ++seed) {
    const test::Body body(0.04 * seed, 2, {3, -2, 1}, 1, seed);
    const Interval interval{body.mesh, body.start, body.end};
    const auto apart = interval.parted();
    for (const auto& [a, b] : test::touching(body.mesh, body.motion())) {
      ++met;
      EXPECT_FALSE(apart.contains({a, b}) || apart.contains({b, a}))
          << "seed " << seed << ": " << +a << ", " << +b;
    }
    for (const auto& [a, b] : apart) ++by_shared[shared(body.mesh, a, b)];
  }
  EXPECT_GT(met, 1000u);
  for (const std::size_t count : by_shared) EXPECT_GT(count, 1000u);
}

// Trap 7: corners on whole numbers, so that many lie exactly in the plane of another triangle; in every other
// round so far from the first vertex that the numbers round. Mutation: no bound on rounding.
TEST(Parting, Trap07WhatTouchesExactlyIsNotParted) {
  std::mt19937 random(5);
  std::size_t met = 0, apart = 0;
  const std::vector<Triangle> triangles = {test::corners(0, 1, 2), test::corners(3, 4, 5),
                                           test::corners(6, 7, 8), test::corners(3, 7, 9),
                                           test::corners(5, 4, 10)};
  for (int round = 0; round < 500; ++round) {
    Interval interval{TriangleMesh(triangles, 11), {}, {}};
    for (std::size_t v = 0; v < 11; ++v)
      for (std::vector<Vec3>* at : {&interval.start, &interval.end}) {
        const auto dice = [&] {
          return (v < 3 || round % 2 == 0 ? 0 : 0x1p24) + static_cast<double>(random() % 8);
        };
        const double x = dice(), y = dice(), z = dice();
        at->emplace_back(x, y, z);
      }
    const auto pairs = interval.parted();
    apart += pairs.size();
    for (const auto& [a, b] : test::touching(interval.mesh, interval.motion())) {
      ++met;
      EXPECT_FALSE(pairs.contains({a, b}) || pairs.contains({b, a})) << round << ": " << +a << ", " << +b;
    }
  }
  EXPECT_GT(met, 300u);
  EXPECT_GT(apart, 100u);
}

// Two triangles of the same three corners share all that they have: no plane says anything. Mutation: shared
// corners alone are enough.
TEST(Parting, TwoTrianglesOfOneFaceAreNotParted) {
  const Interval twice{TriangleMesh(std::vector<Triangle>{test::corners(0, 1, 2), test::corners(0, 2, 1)}, 3),
                       {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                       {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}};
  EXPECT_TRUE(twice.parted().empty());
}

}  // namespace
}  // namespace cscd::fast
