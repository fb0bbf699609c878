#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "scenes/effects/rotation.h"
#include "scenes/effects/test_effects.h"
#include "scenes/effects/tree_pose.h"
#include "scenes/shape/tube.h"

namespace cscd::scenes {
namespace {

// A tube of radius 1 along x, from -10 to 10, with two bones that meet at 0.
Shape limb(int bones = 2) {
  TubeParameters p;
  p.rings = 79;
  p.sides = 24;
  p.bones = bones;
  p.radius = 1;
  p.length = 20;
  p.direction = Vec3::UnitX();
  p.start = Vec3(-10, 0, 0);
  return tube(p);
}

// The positions after the given skinning effects, for the pose of the state.
std::vector<Vec3> skinned(SceneState state, const std::vector<std::string>& effects, Values values = {}) {
  std::vector<EffectCall> calls;
  for (const std::string& effect : effects)
    calls.push_back(call(effect, effect == "volume_bulge" ? values : Values{}));
  EffectSequence sequence(calls, state.shape, 1);
  sequence.advance(state, 1);
  return state.positions;
}

SceneState turned(const Shape& shape, const std::vector<Vec3>& turns) {
  SceneState state(shape);
  turn_bones(state, [&](std::size_t bone) { return rotation_by(turns[bone]); });
  return state;
}

double volume(const Shape& shape, const std::vector<Vec3>& positions) {
  double six = 0;
  for (const Triangle& t : shape.triangles)
    six += positions[+t[0]].dot(positions[+t[1]].cross(positions[+t[2]]));
  return six / 6;
}

// The mean distance of the ring in the middle from the x axis.
double waist(const std::vector<Vec3>& positions) {
  double sum = 0;
  for (int side = 0; side < 24; ++side)
    sum += std::hypot(positions[39 * 24 + side].y(), positions[39 * 24 + side].z());
  return sum / 24;
}

TEST(Skinning, CarriesTheSurfaceRigidlyWithARigidPose) {
  const Shape shape = limb(6);
  for (const Vec3& by : {Vec3(0, 0, 0.25), Vec3(0.1, 0.35, -0.2), Vec3(0.5, 0, 0), Vec3(0, 0.499, 0.01)}) {
    SceneState state(shape);
    const Eigen::Matrix3d turn = rotation_by(by);
    const Vec3 shift(5, -1, 2);
    for (Bone& bone : state.bones) bone = {turn * bone.head + shift, turn * bone.tail + shift};
    for (Eigen::Matrix3d& rotation : state.rotations) rotation = turn;
    for (const char* effect : {"skinning_linear", "skinning_dual_quaternion"}) {
      const std::vector<Vec3> positions = skinned(state, {effect});
      for (std::size_t i = 0; i < positions.size(); ++i)
        ASSERT_LT((positions[i] - (turn * shape.positions[i] + shift)).norm(), 1e-12) << effect;
    }
  }
}

TEST(Skinning, AgreesWhereOneBoneHasAllWeight) {
  Shape shape = limb(3);
  for (JointWeights& weights : shape.weights) {
    weights.bone = {weights.bone[0], BoneId{-1}, BoneId{-1}, BoneId{-1}};
    weights.weight = {1, 0, 0, 0};
  }
  const SceneState state = turned(shape, {{0.1, 0, 0}, {0, 0.3, 0.1}, {0.4, -0.2, 0.3}});
  const std::vector<Vec3> linear = skinned(state, {"skinning_linear"});
  const std::vector<Vec3> dual = skinned(state, {"skinning_dual_quaternion"});
  for (std::size_t i = 0; i < linear.size(); ++i) ASSERT_LT((linear[i] - dual[i]).norm(), 1e-12);
}

TEST(Skinning, KeepsATwistedLimbThickOnlyByDualQuaternions) {
  const Shape shape = limb();
  for (const double turns : {0.0, 0.125, 0.25, 0.375, 0.49}) {
    const SceneState state = turned(shape, {Vec3::Zero(), {turns, 0, 0}});
    // Half-way between the bones, linear blending gives the middle of the chord between two points of a
    // circle.
    EXPECT_NEAR(waist(skinned(state, {"skinning_linear"})), std::cos(std::numbers::pi * turns), 1e-10);
    const std::vector<Vec3> positions = skinned(state, {"skinning_dual_quaternion"});
    EXPECT_NEAR(waist(positions), 1, 1e-12);
    for (std::size_t i = 0; i < positions.size(); ++i)
      ASSERT_NEAR(std::hypot(positions[i].y(), positions[i].z()),
                  std::hypot(shape.positions[i].y(), shape.positions[i].z()), 1e-12);
  }
}

TEST(SkinningDualQuaternion, TakesTheShortWayRound) {
  // Both bones turn by the same angle, then the second turns on, up to more than half a turn in all. Its
  // quaternion changes sign against the quaternion of the first bone, and the surface between must not go
  // the long way round.
  const Shape shape = limb();
  for (const double whole : {0.0, 0.2, 0.4, 0.45, 0.55, 0.7, 0.95}) {
    const SceneState state = turned(shape, {{whole, 0, 0}, {0.2, 0, 0}});
    const std::vector<Vec3> positions = skinned(state, {"skinning_dual_quaternion"});
    const Eigen::Matrix3d half = rotation_by({whole + 0.1, 0, 0});
    for (int side = 0; side < 24; ++side) {
      const std::size_t vertex = 39 * 24 + side;
      ASSERT_LT((positions[vertex] - rotated(half, shape.positions[vertex])).norm(), 1e-11) << whole;
    }
  }
}

TEST(VolumeBulge, GivesBackTheVolumeThatABendCosts) {
  const Shape shape = limb();
  const double at_rest = volume(shape, shape.positions);
  const SceneState bent = turned(shape, {Vec3::Zero(), {0, 0, 0.3}});
  const std::vector<Vec3> before = skinned(bent, {"skinning_linear"});
  const std::vector<Vec3> after = skinned(bent, {"skinning_linear", "volume_bulge"}, {{"most", 1.0}});
  const double lost = at_rest - volume(shape, before), left = at_rest - volume(shape, after);
  EXPECT_GT(lost, 0.02 * at_rest) << "the test must bend enough";
  EXPECT_LT(std::abs(left), 0.1 * lost);
  for (std::size_t i = 0; i < after.size(); ++i) {
    const double joint = 4 * shape.weights[i].weight[0] * shape.weights[i].weight[1];
    if (joint == 0) {
      ASSERT_EQ(after[i], before[i]) << "away from the joint nothing moves";
    }
  }
  const std::vector<Vec3> half =
      skinned(bent, {"skinning_linear", "volume_bulge"}, {{"most", 1.0}, {"share", 0.5}});
  for (std::size_t i = 0; i < after.size(); ++i)
    ASSERT_LT((2 * (half[i] - before[i]) - (after[i] - before[i])).norm(), 1e-12);
  double farthest = 0;
  const std::vector<Vec3> cut = skinned(bent, {"skinning_linear", "volume_bulge"}, {{"most", 0.05}});
  for (std::size_t i = 0; i < after.size(); ++i) farthest = std::max(farthest, (cut[i] - before[i]).norm());
  EXPECT_NEAR(farthest, 0.05, 1e-12);
}

TEST(VolumeBulge, LeavesAStraightLimbAlone) {
  const Shape shape = limb();
  EXPECT_EQ(skinned(SceneState(shape), {"skinning_linear", "volume_bulge"}, {{"most", 1.0}}),
            skinned(SceneState(shape), {"skinning_linear"}));
}

}  // namespace
}  // namespace cscd::scenes
