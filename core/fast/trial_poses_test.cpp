#include "core/fast/trial_poses.h"

#include <gtest/gtest.h>

#include "core/fast/prepare/test_body.h"

namespace cscd::fast {
namespace {

std::vector<BoneId> bones_of(const test::Body& body) {
  std::vector<BoneId> bone_of;
  for (const std::int32_t c : body.atomic.of_triangle)
    bone_of.push_back(body.atomic.clusters[static_cast<std::size_t>(c)].bone);
  return bone_of;
}

// Bones turn with their parents, and the surface keeps its lengths. Mutation: a bone turns without its
// parent.
TEST(TrialPoses, ALimbFollowsItsParentsAndKeepsItsLength) {
  const test::Body body(0, 0);
  const std::vector<BoneId> bone_of = bones_of(body);
  const std::vector<PosePair> trials = trial_poses(body.mesh, body.shape.positions, body.rig, bone_of, 4);
  ASSERT_EQ(trials.size(), 4u);
  const std::vector<Vec3>& at_rest = body.shape.positions;
  const auto length = [&](const std::vector<Vec3>& positions) {
    double sum = 0;
    for (const Triangle& c : body.mesh.triangles()) sum += (positions[+c[0]] - positions[+c[1]]).norm();
    return sum;
  };
  for (const PosePair& trial : trials)
    for (const std::vector<Vec3>& positions : trial) {
      ASSERT_EQ(positions.size(), at_rest.size());
      EXPECT_GT((positions.back() - at_rest.back()).norm(), 1) << "the last bone is far from the root";
      EXPECT_NEAR(length(positions) / length(at_rest), 1, 0.1);
    }
  EXPECT_NE(trials[0][0].back(), trials[0][1].back());
  EXPECT_NE(trials[0][0].back(), trials[1][0].back());
}

}  // namespace
}  // namespace cscd::fast
