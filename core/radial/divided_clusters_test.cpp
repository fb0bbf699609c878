#include "core/radial/divided_clusters.h"

#include <algorithm>
#include <gtest/gtest.h>

#include "core/mesh/test_shapes.h"

namespace cscd::radial {
namespace {

// A straight tube of length 8 along x with four bones of length 2, each of which has the triangles nearest to
// it.
struct Tube {
  test::Shape shape = test::uneven_tube(8, 32, 8, [](double) { return 0.4; });
  TriangleMesh mesh = shape.mesh();
  Rig rig = test::straight_chain(4, {0, 0, 0}, {8, 0, 0});
  AtomicClusters clusters;

  Tube() {
    std::vector<BoneId> bone_of;
    for (const Triangle& t : mesh.triangles())
      bone_of.push_back(BoneId{std::min(3, static_cast<std::int32_t>(middle(t) / 2))});
    clusters = make_atomic_clusters(mesh, bone_of);
  }
  double middle(const Triangle& t) const {
    return (shape.positions[+t[0]].x() + shape.positions[+t[1]].x() + shape.positions[+t[2]].x()) / 3;
  }
};

void expect_partition(const TriangleMesh& mesh, const AtomicClusters& clusters) {
  std::size_t triangles = 0;
  for (std::size_t c = 0; c < clusters.clusters.size(); ++c) {
    EXPECT_FALSE(clusters.clusters[c].triangles.empty());
    EXPECT_TRUE(std::ranges::is_sorted(clusters.clusters[c].triangles));
    for (const TriangleId t : clusters.clusters[c].triangles)
      EXPECT_EQ(clusters.of_triangle[+t], static_cast<std::int32_t>(c));
    triangles += clusters.clusters[c].triangles.size();
  }
  EXPECT_EQ(triangles, mesh.triangle_count());
}

// The paper counts 199 atomic clusters for a chain of 100 bones.
TEST(DividedClusters, AChainHasAClusterForEachBoneAndEachJoint) {
  const Tube tube;
  const JointClusters divided = divided_at_joints(tube.mesh, tube.shape.positions, tube.rig, tube.clusters);
  expect_partition(tube.mesh, divided.clusters);
  EXPECT_EQ(divided.at_joint, (std::vector<bool>{false, false, true, false, true, false, true}));
  for (std::size_t t = 0; t < tube.mesh.triangle_count(); ++t) {
    const double x = tube.middle(tube.mesh.triangles()[t]);
    const auto c = static_cast<std::size_t>(divided.clusters.of_triangle[t]);
    const Bone& bone = tube.rig.reference[+divided.clusters.clusters[c].bone];
    const double observer = divided.at_joint[c] ? bone.head.x() : (bone.head.x() + bone.tail.x()) / 2;
    if (x < 0.5 || x > 7.5) continue;  // the two ends of the chain are no joints
    EXPECT_LE(std::abs(x - observer), 0.5 + 1e-9) << "the nearest of all";
  }
}

TEST(DividedClusters, BonesThatBeginTogetherShareAJoint) {
  Tube tube;
  // Bones 1, 2 and 3 are children of bone 0; 2 and 3 begin at one point.
  tube.rig.parent = {BoneId{-1}, BoneId{0}, BoneId{0}, BoneId{0}};
  tube.rig.reference[2].head = tube.rig.reference[3].head = {6, 0, 0};
  tube.rig.reference[2].tail = {4, 0, 0};
  const JointClusters divided = divided_at_joints(tube.mesh, tube.shape.positions, tube.rig, tube.clusters);
  expect_partition(tube.mesh, divided.clusters);
  std::vector<std::int32_t> joints;
  for (std::size_t c = 0; c < divided.at_joint.size(); ++c)
    if (divided.at_joint[c]) joints.push_back(static_cast<std::int32_t>(+divided.clusters.clusters[c].bone));
  EXPECT_EQ(joints, (std::vector<std::int32_t>{1, 2}));
}

// Mutation: pieces grow into triangles of other clusters.
TEST(DividedClusters, PiecesHangTogether) {
  const Tube tube;
  // Bone 0 has both ends of the tube, bone 1 the middle.
  std::vector<BoneId> bone_of;
  for (const Triangle& t : tube.mesh.triangles())
    bone_of.push_back(BoneId{tube.middle(t) > 2 && tube.middle(t) < 6 ? 1 : 0});
  const AtomicClusters clusters = make_atomic_clusters(tube.mesh, bone_of);
  ASSERT_EQ(clusters.clusters.size(), 2u);
  const AtomicClusters pieces = divided_into_pieces(tube.mesh, clusters);
  expect_partition(tube.mesh, pieces);
  ASSERT_EQ(pieces.clusters.size(), 3u);
  EXPECT_EQ(pieces.clusters[0].bone, BoneId{0});
  EXPECT_EQ(pieces.clusters[1].bone, BoneId{0});
  EXPECT_EQ(pieces.clusters[2].bone, BoneId{1});
  EXPECT_EQ(pieces.clusters[2].triangles, clusters.clusters[1].triangles);
  EXPECT_EQ(pieces.neighbours[2], (std::vector<std::int32_t>{0, 1}));
}

}  // namespace
}  // namespace cscd::radial
