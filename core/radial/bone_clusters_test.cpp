#include "core/radial/bone_clusters.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>

#include "core/mesh/test_shapes.h"

namespace cscd::radial {
namespace {

bool positive_towards(const TriangleMesh& mesh, std::span<const Vec3> x, TriangleId t, const Bone& bone,
                      ObserverKind kind) {
  const Triangle& c = mesh.corners(t);
  const auto still = [&](VertexId v) { return MovingPoint{x[+v], x[+v]}; };
  return orientation({still(c[0]), still(c[1]), still(c[2])}, observer(kind, bone, bone)) ==
         Orientation::positive;
}

struct UnevenTube {
  test::Shape shape = test::uneven_tube(8, 12, 12, [](double x) { return 0.7 + 0.5 * std::sin(1.5 * x); });
  TriangleMesh mesh = shape.mesh();
  Rig rig = test::straight_chain(4, {0.5, 0, 0}, {11.5, 0, 0});
  std::vector<BoneId> bone_of;
  AtomicClusters clusters;
  std::vector<ObserverKind> kinds;

  explicit UnevenTube(unsigned seed) {
    std::mt19937 random(seed);
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      double x = 0;
      for (const VertexId v : mesh.triangles()[t]) x += shape.positions[+v].x() / 3;
      int bone = std::clamp(static_cast<int>((x - 0.5) / 2.75), 0, 3);
      if (seed > 0 && random() % 4 == 0) bone = static_cast<int>(random() % 4);  // a bad segmentation
      bone_of.push_back(BoneId{bone});
    }
    clusters = make_atomic_clusters(mesh, bone_of);
    for (std::size_t c = 0; c < clusters.clusters.size(); ++c)
      kinds.push_back(random() % 2 == 0 ? ObserverKind::bone_centre : ObserverKind::bone_segment);
  }
  std::vector<BoneId> refined() const {
    return refine_by_orientation(mesh, shape.positions, rig, clusters, kinds);
  }
  bool positive(TriangleId t, BoneId bone) const {
    for (std::size_t c = 0; c < clusters.clusters.size(); ++c)
      if (clusters.clusters[c].bone == bone)
        return positive_towards(mesh, shape.positions, t, rig.reference[+bone], kinds[c]);
    return false;
  }
};

TEST(Refinement, TrianglesThatArePositiveStay) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const UnevenTube tube(seed);
    const std::vector<BoneId> refined = tube.refined();
    ASSERT_EQ(refined.size(), tube.mesh.triangle_count());
    for (std::size_t t = 0; t < refined.size(); ++t)
      if (tube.positive(TriangleId{static_cast<std::int32_t>(t)}, tube.bone_of[t])) {
        EXPECT_EQ(refined[t], tube.bone_of[t]);
      }
  }
}

TEST(Refinement, MakesMoreTrianglesPositiveNeverFewer) {
  bool more = false;
  for (unsigned seed = 0; seed < 5; ++seed) {
    const UnevenTube tube(seed);
    const std::vector<BoneId> refined = tube.refined();
    const auto count = [&](const std::vector<BoneId>& bone_of) {
      std::size_t positive = 0;
      for (std::size_t t = 0; t < bone_of.size(); ++t)
        positive += tube.positive(TriangleId{static_cast<std::int32_t>(t)}, bone_of[t]);
      return positive;
    };
    EXPECT_GE(count(refined), count(tube.bone_of));
    more |= count(refined) > count(tube.bone_of);
  }
  EXPECT_TRUE(more);
}

// The growth is complete: no triangle that is not positive towards its own cluster would be positive towards
// the cluster of a neighbour that is.
TEST(Refinement, GrowsAsFarAsOrientationAllows) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const UnevenTube tube(seed);
    const std::vector<BoneId> refined = tube.refined();
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(refined.size()); ++i) {
      const TriangleId t{i};
      if (tube.positive(t, refined[+t])) continue;
      for (const EdgeId edge : tube.mesh.edges_of(t))
        for (const TriangleId n : tube.mesh.triangles_at(edge))
          if (tube.positive(n, refined[+n])) {
            EXPECT_FALSE(tube.positive(t, refined[+n])) << "triangle " << i << ", seed " << seed;
          }
    }
  }
}

TEST(Refinement, APieceOnWhichNothingIsPositiveKeepsItsClusters) {
  // No triangle of a ball that faces inward is positive, and the other ball cannot be reached over edges.
  test::Shape inward = test::icosphere(1);
  for (Triangle& t : inward.triangles) std::swap(t[1], t[2]);
  const test::Shape both = test::together(inward, test::moved(test::icosphere(1), {5, 0, 0}));
  const TriangleMesh mesh = both.mesh();
  const Rig rig{{BoneId{-1}, BoneId{0}}, {{{-0.1, 0, 0}, {0.1, 0, 0}}, {{4.9, 0, 0}, {5.1, 0, 0}}}};
  std::vector<BoneId> bone_of(mesh.triangle_count());
  for (std::size_t t = 0; t < bone_of.size(); ++t)
    bone_of[t] = BoneId{t < bone_of.size() / 4 ? 1 : t < bone_of.size() / 2 ? 0 : 1};
  const AtomicClusters clusters = make_atomic_clusters(mesh, bone_of);
  const std::vector<ObserverKind> kinds(clusters.clusters.size(), ObserverKind::bone_centre);
  // Bone 1 lies outside of the inward ball and sees half of it from the front, so triangles of that ball may
  // go to bone 1. Only the other ball is expected to keep its bone here.
  const std::vector<BoneId> refined = refine_by_orientation(mesh, both.positions, rig, clusters, kinds);
  for (std::size_t t = bone_of.size() / 2; t < bone_of.size(); ++t) EXPECT_EQ(refined[t], BoneId{1});
  for (const BoneId bone : refined) EXPECT_TRUE(bone == BoneId{0} || bone == BoneId{1});

  const Rig one{{BoneId{-1}}, {rig.reference[0]}};
  const TriangleMesh alone = inward.mesh();
  const AtomicClusters single =
      make_atomic_clusters(alone, std::vector<BoneId>(alone.triangle_count(), BoneId{0}));
  const std::vector<ObserverKind> kind(1, ObserverKind::bone_centre);
  EXPECT_EQ(refine_by_orientation(alone, inward.positions, one, single, kind),
            std::vector<BoneId>(alone.triangle_count(), BoneId{0}));
}

}  // namespace
}  // namespace cscd::radial
