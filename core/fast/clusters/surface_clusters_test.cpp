#include "core/fast/clusters/surface_clusters.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <set>

#include "core/fast/prepare/cut_surface.h"
#include "core/mesh/test_shapes.h"

namespace cscd::fast {
namespace {

std::size_t count(const std::vector<std::int32_t>& cluster_of) {
  return std::set(cluster_of.begin(), cluster_of.end()).size();
}

TEST(SurfaceClusters, WhatOnePointSeesIsNotCut) {
  const test::Shape ball = test::icosphere(4), egg = test::uneven_tube(24, 40, 4, [](double x) {
                                                 return 0.1 + std::sqrt(x * (4 - x)) / 2;
                                               });
  EXPECT_EQ(count(surface_clusters(ball.mesh(), ball.positions)), 1u);
  EXPECT_EQ(count(surface_clusters(egg.mesh(), egg.positions)), 1u);
}

// Mutation: pieces are merged whether or not they are seen well.
TEST(SurfaceClusters, ALongTubeIsCutIntoRings) {
  const test::Shape tube = test::capped_tube(16, 200, 1, 60);
  const TriangleMesh mesh = tube.mesh();
  const std::vector<std::int32_t> cluster_of = surface_clusters(mesh, tube.positions);
  EXPECT_GE(count(cluster_of), 6u);
  EXPECT_LE(count(cluster_of), 20u);
  std::map<std::int32_t, std::pair<double, double>> extent;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const double x = tube.positions[+mesh.triangles()[t][0]].x();
    auto& [low, high] = extent.try_emplace(cluster_of[t], x, x).first->second;
    low = std::min(low, x), high = std::max(high, x);
  }
  // Each cluster goes all round the tube, so the clusters lie one behind the other along it.
  std::vector<std::pair<double, double>> rings;
  for (const auto& [cluster, range] : extent) rings.push_back(range);
  std::sort(rings.begin(), rings.end());
  for (std::size_t i = 1; i < rings.size(); ++i) EXPECT_GT(rings[i].first, rings[i - 1].second - 2);
}

// No point sees all of a fat ring from behind.
TEST(SurfaceClusters, ATorusIsCut) {
  const test::Shape ring = test::torus(60, 24, 3, 1);
  EXPECT_GE(count(surface_clusters(ring.mesh(), ring.positions)), 3u);
}

// Rule component. The two components are far apart, or one is inside the other, or both are small. Mutation:
// the first pieces are not the components.
TEST(SurfaceClusters, RuleComponentNoClusterSpansTwoComponents) {
  for (const test::Shape& both : {test::together(test::capped_tube(12, 90, 1, 30), test::icosphere(3, 2)),
                                  test::together(test::icosphere(3, 3), test::icosphere(3, 1)),
                                  test::together(test::octahedron(2), test::octahedron(1))}) {
    const TriangleMesh mesh = both.mesh();
    const Covers covers = cut_surface(mesh, both.positions, surface_clusters(mesh, both.positions)).covers;
    for (const Cover& cover : covers) {
      std::map<std::int32_t, std::int32_t> component;
      for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
        if (cover.cluster_of[t] == kNone) continue;
        const std::int32_t own = mesh.component(TriangleId{static_cast<std::int32_t>(t)});
        EXPECT_EQ(component.try_emplace(cover.cluster_of[t], own).first->second, own);
      }
    }
  }
}

TEST(SurfaceClusters, ASurfaceOfNoExtentIsOneCluster) {
  test::Shape flat = test::icosphere(3);
  std::vector<Vec3> point(flat.positions.size(), Vec3(1, 2, 3));
  EXPECT_EQ(count(surface_clusters(flat.mesh(), point)), 1u);
  for (Vec3& p : flat.positions) p = Vec3(0, 0, p.z());
  EXPECT_EQ(surface_clusters(flat.mesh(), flat.positions).size(), flat.triangles.size());
}

}  // namespace
}  // namespace cscd::fast
