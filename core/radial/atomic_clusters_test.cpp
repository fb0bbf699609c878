#include "core/radial/atomic_clusters.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>
#include <set>
#include <utility>

#include "core/mesh/test_shapes.h"

namespace cscd::radial {
namespace {

using test::Shape;

// Checks everything that AtomicClusters promises against the mesh and the bones.
void expect_consistent(const TriangleMesh& mesh, const std::vector<BoneId>& bone,
                       const AtomicClusters& atomic) {
  ASSERT_EQ(atomic.of_triangle.size(), mesh.triangle_count());
  ASSERT_EQ(atomic.neighbours.size(), atomic.clusters.size());
  std::vector<int> times(mesh.triangle_count(), 0);
  std::set<std::pair<BoneId, std::int32_t>> keys;
  for (std::size_t c = 0; c < atomic.clusters.size(); ++c) {
    const AtomicClusters::Cluster& cluster = atomic.clusters[c];
    ASSERT_FALSE(cluster.triangles.empty());
    EXPECT_TRUE(std::is_sorted(cluster.triangles.begin(), cluster.triangles.end()));
    const std::int32_t component = mesh.component(cluster.triangles.front());
    EXPECT_TRUE(keys.emplace(cluster.bone, component).second) << "two clusters of one bone and component";
    for (const TriangleId t : cluster.triangles) {
      ++times[+t];
      EXPECT_EQ(atomic.of_triangle[+t], static_cast<std::int32_t>(c));
      EXPECT_EQ(bone[+t], cluster.bone);
      EXPECT_EQ(mesh.component(t), component);
    }
  }
  EXPECT_TRUE(std::all_of(times.begin(), times.end(), [](int n) { return n == 1; }));

  std::set<std::pair<std::int32_t, std::int32_t>> expected, actual;
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i)
    for (const EdgeId e : mesh.edges_of(TriangleId{static_cast<std::int32_t>(i)}))
      for (const TriangleId other : mesh.triangles_at(e))
        if (atomic.of_triangle[i] != atomic.of_triangle[+other])
          expected.emplace(atomic.of_triangle[i], atomic.of_triangle[+other]);
  for (std::size_t c = 0; c < atomic.clusters.size(); ++c) {
    EXPECT_TRUE(std::is_sorted(atomic.neighbours[c].begin(), atomic.neighbours[c].end()));
    for (const std::int32_t other : atomic.neighbours[c])
      EXPECT_TRUE(actual.emplace(static_cast<std::int32_t>(c), other).second);
  }
  EXPECT_EQ(actual, expected);
  for (const auto& [a, b] : actual) EXPECT_TRUE(actual.contains({b, a}));
}

TEST(AtomicClusters, PartitionTheTrianglesOfAnyAssignment) {
  std::mt19937 random(11);
  const Shape shapes[] = {test::octahedron(), test::torus(), test::icosphere(1),
                          test::together(test::torus(), test::together(test::octahedron(), test::box()))};
  for (const Shape& shape : shapes)
    for (const unsigned bones : {1u, 2u, 9u, 100u}) {
      const TriangleMesh mesh = shape.mesh();
      std::vector<BoneId> bone;
      for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
        bone.push_back(BoneId{static_cast<std::int32_t>(random() % bones)});
      expect_consistent(mesh, bone, make_atomic_clusters(mesh, bone));
    }
}

TEST(AtomicClusters, OneBoneOfTwoComponentsMakesTwoClusters) {
  const TriangleMesh mesh = test::together(test::octahedron(), test::octahedron(0.3)).mesh();
  const AtomicClusters atomic = make_atomic_clusters(mesh, std::vector<BoneId>(16, BoneId{5}));
  ASSERT_EQ(atomic.clusters.size(), 2u);
  EXPECT_EQ(atomic.clusters[0].triangles.size(), 8u);
  EXPECT_EQ(atomic.clusters[1].triangles.front(), TriangleId{8});
  EXPECT_TRUE(atomic.neighbours[0].empty());
  EXPECT_TRUE(atomic.neighbours[1].empty());
}

TEST(AtomicClusters, StandInTheOrderOfTheirBones) {
  const TriangleMesh mesh = test::octahedron().mesh();
  const std::vector<BoneId> bone{BoneId{7}, BoneId{7}, BoneId{2}, BoneId{2},
                                 BoneId{9}, BoneId{9}, BoneId{2}, BoneId{2}};
  const AtomicClusters atomic = make_atomic_clusters(mesh, bone);
  ASSERT_EQ(atomic.clusters.size(), 3u);
  EXPECT_EQ(atomic.clusters[0].bone, BoneId{2});
  EXPECT_EQ(atomic.clusters[1].bone, BoneId{7});
  EXPECT_EQ(atomic.clusters[2].bone, BoneId{9});
  EXPECT_EQ(atomic.neighbours[0], (std::vector<std::int32_t>{1, 2}));
}

TEST(AtomicClusters, ClustersThatMeetAtAVertexOnlyAreNoNeighbours) {
  const TriangleMesh mesh = test::octahedron().mesh();
  std::vector<BoneId> bone(8, BoneId{0});
  bone[0] = BoneId{1};  // (0, 2, 4) and (1, 3, 4) share corner 4
  bone[2] = BoneId{2};
  const AtomicClusters atomic = make_atomic_clusters(mesh, bone);
  EXPECT_EQ(atomic.neighbours[1], (std::vector<std::int32_t>{0}));
  EXPECT_EQ(atomic.neighbours[2], (std::vector<std::int32_t>{0}));
}

}  // namespace
}  // namespace cscd::radial
