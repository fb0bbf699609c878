#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <set>

#include "core/fast/prepare/cut_surface.h"
#include "core/fast/prepare/test_body.h"
#include "core/mesh/adjacency.h"

namespace cscd::fast {
namespace {

struct Cut : test::Body, CutSurface {
  Cut() : test::Body(0.01, 0), CutSurface(cut_surface(mesh, shape.positions, atomic.of_triangle)) {}
};

TEST(Patches, EveryTriangleLiesInOneLane) {
  const Cut cut;
  std::vector<int> times(cut.mesh.triangle_count(), 0);
  for (std::size_t p = 0; p < cut.tree.patches.size(); ++p)
    for (std::size_t l = 0; l < kLanes16; ++l) {
      const Patch& patch = cut.tree.patches[p];
      const TriangleId triangle = cut.tree.triangles[p][l];
      const Triangle& corners = cut.mesh.corners(triangle);
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_EQ(patch.vertex[patch.corner[k][l]], static_cast<std::int32_t>(corners[k]));
      if (!(patch.lanes >> l & 1)) continue;
      ++times[+triangle];
      for (std::size_t c = 0; c < kCovers; ++c)
        EXPECT_EQ(patch.cluster[c], cut.covers[c].cluster_of[+triangle]);
    }
  EXPECT_EQ(times, std::vector<int>(times.size(), 1));
  EXPECT_LT(cut.tree.patches.size(), cut.mesh.triangle_count() / 7) << "patches are filled";
}

// Mutation: inside() considers neighbours over edges only.
TEST(Patches, InsideMeansAllAroundEveryCorner) {
  const Cut cut;
  std::size_t not_inside = 0;
  for (std::size_t p = 0; p < cut.tree.patches.size(); ++p)
    for (std::size_t l = 0; l < kLanes16; ++l)
      for (std::size_t c = 0; c < kCovers; ++c) {
        const Patch& patch = cut.tree.patches[p];
        const Mask16 inside = cut.tree.inside[p][c];
        if (!(patch.lanes >> l & 1)) {
          EXPECT_FALSE(inside >> l & 1);
          continue;
        }
        bool all = patch.cluster[c] != kNone;
        for (std::size_t t = 0; t < cut.mesh.triangle_count(); ++t)
          if (share_vertex(cut.mesh.triangles()[t], cut.mesh.corners(cut.tree.triangles[p][l])))
            all = all && cut.covers[c].cluster_of[t] == patch.cluster[c];
        EXPECT_EQ(inside >> l & 1, all);
        not_inside += !all;
      }
  EXPECT_GT(not_inside, 0u);
}

TEST(Patches, AllTrianglesWithACommonVertexAreFound) {
  const Cut cut;
  for (std::size_t p = 0; p < cut.tree.patches.size(); ++p)
    for (std::size_t l = 0; cut.tree.patches[p].lanes >> l != 0; l += 3) {
      const Patch& patch = cut.tree.patches[p];
      const TriangleId triangle = cut.tree.triangles[p][l];
      std::set<TriangleId> found, expected;
      cut.tree.for_each_adjacent(p, [&](std::size_t q, const SharedVertices& common) {
        EXPECT_EQ(cut.tree.common_of(p, q), &common);
        const Mask16 lanes = common.beside(patch, l);
        const Mask16 corners = patch.corners_of(1U << l);
        EXPECT_EQ(common.lanes(corners), lanes);
        for (std::size_t m = 0; lanes >> m != 0; ++m) {
          EXPECT_EQ((corners & common.places(static_cast<Mask16>(1U << m))) != 0, (lanes >> m & 1) != 0);
          if (!(lanes >> m & 1)) continue;
          EXPECT_TRUE(found.insert(cut.tree.triangles[q][m]).second);
        }
      });
      for (std::size_t u = 0; u < cut.mesh.triangle_count(); ++u)
        if (share_vertex(cut.mesh.triangles()[u], cut.mesh.corners(triangle)))
          expected.insert(TriangleId{static_cast<std::int32_t>(u)});
      EXPECT_EQ(found, expected);
    }
}

// Triangles that lie inside no cluster of the first two covers lie inside a cluster of the third. No cluster
// of the third spans two components. Mutation: the third cover has no rings round the patches that the first
// two miss.
TEST(Patches, TheLastCoverHoldsWhereSeamsMeet) {
  const test::Shape two = test::together(test::icosphere(4, 1), test::icosphere(4, 3));
  const TriangleMesh mesh = two.mesh();
  std::vector<BoneId> bone_of;
  for (const Triangle& t : mesh.triangles()) {
    const Vec3& p = two.positions[+t[0]];
    bone_of.push_back(BoneId{4 * (p.x() < 0 ? 0 : 1) + 2 * (p.y() < 0 ? 0 : 1) + (p.z() < 0 ? 0 : 1)});
  }
  const auto [covers, tree] =
      cut_surface(mesh, two.positions, radial::make_atomic_clusters(mesh, bone_of).of_triangle);
  EXPECT_GE(covers[2].observers.size(), 4u);
  std::size_t missed = 0;
  for (std::size_t p = 0; p < tree.patches.size(); ++p) {
    const auto first_two = static_cast<Mask16>(tree.inside[p][0] | tree.inside[p][1]);
    missed += first_two != tree.patches[p].lanes;
    EXPECT_EQ(first_two | tree.inside[p][2], tree.patches[p].lanes);
  }
  EXPECT_GT(missed, 4u);
  std::map<std::int32_t, std::set<std::int32_t>> components;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    components[covers[2].cluster_of[t]].insert(mesh.component(TriangleId{static_cast<std::int32_t>(t)}));
  components.erase(kNone);
  for (const auto& [cluster, in] : components) EXPECT_EQ(in.size(), 1u);
}

// Mutation: `least_cell` is ignored.
TEST(Patches, AreFewerWhereSeamsCutLargeCellsAlone) {
  const Cut cut;
  const CutSurface coarse =
      cut_surface(cut.mesh, cut.shape.positions, cut.atomic.of_triangle, 10 * kLeastCell);
  EXPECT_LT(coarse.tree.patches.size(), cut.tree.patches.size());
}

TEST(Patches, TheTreeHoldsThePatchesInOrder) {
  const Cut cut;
  std::size_t next = 0;
  std::vector<std::size_t> open = {0};
  while (!open.empty()) {
    const std::size_t n = open.back();
    const PatchTree::Node& node = cut.tree.nodes[n];
    open.pop_back();
    if (node.is_leaf()) {
      EXPECT_EQ(node.patch(), next++);
      continue;
    }
    EXPECT_GT(node.left(), n);
    open.push_back(node.right());
    open.push_back(node.left());
  }
  EXPECT_EQ(next, cut.tree.patches.size());
  EXPECT_EQ(cut.tree.nodes.size(), 2 * next - 1);
}

// Mutations: a range does not wait for the nodes of later ones; a node that waits is never visited.
TEST(Patches, InnerNodesAreVisitedAfterTheirChildrenOnAnyNumberOfThreads) {
  const test::Shape tube = test::uneven_tube(48, 1200, 15, [](double) { return 0.8; });
  const TriangleMesh mesh = tube.mesh();
  const CutSurface cut =
      cut_surface(mesh, tube.positions, std::vector<std::int32_t>(mesh.triangle_count(), 0));
  ASSERT_GT(cut.tree.inner.size(), ThreadPool::kWorthWaking * PatchTree::kInnerTogether);
  for (const int threads : {1, 2, 3, 8}) {
    const ThreadPool pool(threads);
    std::vector<std::size_t> below(cut.tree.nodes.size(), 0);  // patches
    for (std::size_t n = 0; n < below.size(); ++n) below[n] = cut.tree.nodes[n].is_leaf();
    cut.tree.for_each_inner_upwards(pool, [&](std::size_t n, const PatchTree::Node& node) {
      below[n] += below[node.left()] + below[node.right()];
    });
    EXPECT_EQ(below[0], cut.tree.patches.size()) << threads << " threads";
  }
}

}  // namespace
}  // namespace cscd::fast
