#include "core/fast/prepare/cut_surface.h"

#include <cmath>
#include <gtest/gtest.h>
#include <set>

#include "core/fast/prepare/saved_cut.h"
#include "core/fast/prepare/test_body.h"

namespace cscd::fast {
namespace {

// Mutation: the second cover takes the labels of the first.
TEST(Covers, WhatLiesAtASeamOfOneLiesInsideTheOther) {
  const test::Body body(0.01, 0);
  const Covers covers = cut_surface(body.mesh, body.shape.positions, body.atomic.of_triangle).covers;
  EXPECT_EQ(covers[0].observers.size(), 5u);
  EXPECT_EQ(covers[1].observers.size(), 4u);
  const std::vector<bool> first = inside(body.mesh, covers[0].cluster_of),
                          second = inside(body.mesh, covers[1].cluster_of);
  for (std::size_t t = 0; t < first.size(); ++t) EXPECT_TRUE(first[t] || second[t]);
}

// A cluster of two rings between two long clusters is merged with one of these.
TEST(Covers, ThinClustersAreMerged) {
  const test::Body body(0.01, 0);
  std::vector<BoneId> bone_of;
  for (const Triangle& t : body.mesh.triangles()) {
    const double x = body.shape.positions[+t[0]].x();
    bone_of.push_back(BoneId{x < 6 ? 0 : x < 6.5 ? 1 : 2});
  }
  const radial::AtomicClusters atomic = radial::make_atomic_clusters(body.mesh, bone_of);
  EXPECT_EQ(atomic.clusters.size(), 3u);
  EXPECT_EQ(cut_surface(body.mesh, body.shape.positions, atomic.of_triangle).covers[0].observers.size(), 2u);
}

// Rule component. Mutation: rings grow over all triangles instead of over neighbours.
TEST(Covers, RuleComponentNoClusterSpansTwoComponents) {
  const test::Shape two = test::together(test::capped_tube(8, 30, 1, 10), test::icosphere(2, 12));
  const TriangleMesh mesh = two.mesh();
  std::vector<BoneId> bone_of;
  for (const Triangle& t : mesh.triangles()) bone_of.push_back(BoneId{two.positions[+t[0]].x() < 5 ? 0 : 1});
  const Covers covers =
      cut_surface(mesh, two.positions, radial::make_atomic_clusters(mesh, bone_of).of_triangle).covers;
  for (const Cover& cover : covers) {
    std::map<std::int32_t, std::set<std::int32_t>> components;
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
      components[cover.cluster_of[t]].insert(mesh.component(TriangleId{static_cast<std::int32_t>(t)}));
    for (const auto& [cluster, in] : components) {
      EXPECT_TRUE(cluster == kNone || in.size() == 1);
      EXPECT_LT(cluster, static_cast<std::int32_t>(cover.observers.size()));
    }
  }
}

// A sphere is so small beside its one spike that the point which sees it best is far away in units of the
// sphere. Mutation: draws with any weights are accepted.
TEST(Covers, ObserversStayWithinReachOfTheirVertices) {
  test::Shape shape = test::icosphere(4, 1e-19);
  shape.positions[17] = {1, 0, 0};
  const TriangleMesh mesh = shape.mesh();
  const Cover cover = make_cover(mesh, shape.positions, std::vector<std::int32_t>(mesh.triangle_count(), 0));
  ASSERT_EQ(cover.observers.size(), 1u);
  float sum = 0;
  for (const float weight : cover.observers[0].weights()) sum += std::abs(weight);
  EXPECT_LE(sum, 1.001F * FollowingPoint::kMostWeight);
}

// Cells and observers are shared out. Mutation: a patch cutter that two threads use at a time.
TEST(CutSurface, IsTheSameOnAnyNumberOfThreads) {
  const test::Body body(0.01, 0);
  const auto cut = [&](int threads) {
    return saved_cut(
        body.mesh, body.shape.positions,
        cut_surface(body.mesh, body.shape.positions, body.atomic.of_triangle, 8, ThreadPool(threads)),
        kCovers);
  };
  const std::vector<std::byte> alone = cut(1);
  for (const int threads : {2, 5}) EXPECT_EQ(cut(threads), alone);
}

// Clusters of twelve rows of triangles. Mutation: every seam's cluster reaches as far as in a deep cluster.
TEST(Covers, BetweenTheSeamsOfAThinClusterThereAreTrianglesOfNeither) {
  const test::Shape tube = test::capped_tube(16, 121, 1, 60);
  const TriangleMesh mesh = tube.mesh();
  std::vector<std::int32_t> cluster_of;
  for (const Triangle& c : mesh.triangles())
    cluster_of.push_back(std::min(9, static_cast<int>(tube.positions[+c[0]].x() / 6)));
  const std::size_t clusters = renumber(cluster_of);
  const std::vector<std::int32_t> seams = nearest_seams(mesh, cluster_of);
  std::vector<int> of_neither(clusters);
  for (std::size_t t = 0; t < seams.size(); ++t) of_neither[index(cluster_of[t])] += seams[t] == kNone;
  for (const int triangles : of_neither) EXPECT_GE(triangles, 2 * 16);
  EXPECT_GT(std::ranges::count_if(seams, [](std::int32_t seam) { return seam != kNone; }),
            mesh.triangle_count() / 4);
}

TEST(Covers, ObserversSeeAllOfATubeFromInside) {
  const test::Body body(0, 0);
  const Covers covers = cut_surface(body.mesh, body.shape.positions, body.atomic.of_triangle).covers;
  for (const Cover& cover : covers)
    for (const FollowingPoint& from : cover.observers) {
      Vec3 q = Vec3::Zero();
      double sum = 0;
      for (std::size_t i = 0; i < from.vertices().size(); ++i) {
        q += static_cast<double>(from.weights()[i]) * body.shape.positions[+from.vertices()[i]];
        sum += static_cast<double>(from.weights()[i]);
      }
      EXPECT_NEAR(sum, 1, 1e-5);
      EXPECT_LT(std::hypot(q.y(), q.z()), 0.6);
    }
}

}  // namespace
}  // namespace cscd::fast
