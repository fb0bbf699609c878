#include "scenes/effects/chain.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "scenes/effects/test_effects.h"
#include "scenes/shape/tube.h"

namespace cscd::scenes {
namespace {

Shape chain(int bones, double length, const Vec3& start, const Vec3& direction) {
  TubeParameters p;
  p.rings = 4 * bones;
  p.sides = 6;
  p.bones = bones;
  p.radius = 0.5;
  p.length = length + 1;
  p.direction = direction;
  p.start = start - 0.5 * direction.normalized();
  return tube(p);
}

EffectCall dynamics(Values more) {
  Values values = {{"gravity", std::vector<double>{0, 0, -1}},
                   {"drag", 0.0},
                   {"bend_stiffness", 0.0},
                   {"bend_radius", 0.6},
                   {"iterations", 4.0}};
  for (auto& [name, value] : more) values.insert_or_assign(name, value);
  return call("chain_dynamics", std::move(values));
}

double distance(const Bone& a, const Bone& b) {
  double least = 1e300;
  for (int i = 0; i <= 64; ++i)
    for (int j = 0; j <= 64; ++j)
      least = std::min(
          least, (a.head + i / 64.0 * (a.tail - a.head) - b.head - j / 64.0 * (b.tail - b.head)).norm());
  return least;
}

TEST(ChainDynamics, FallsFreelyAsAParabola) {
  const Shape shape = chain(10, 10, Vec3::Zero(), Vec3::UnitX());
  const EffectCall calls[] = {dynamics({})};
  EffectSequence sequence(calls, shape, 64);
  SceneState state(shape);
  for (int frame = 1; frame <= 4; ++frame) sequence.advance(state, frame);
  // Symplectic Euler steps add half a step of fall to g t^2 / 2.
  for (const Bone& bone : state.bones) EXPECT_NEAR(bone.head.z(), -8 - 4 / 128.0, 1e-9);
}

TEST(ChainDynamics, HangsAtItsLengthAndComesToRest) {
  const Shape shape = chain(20, 20, Vec3::Zero(), Vec3::UnitX());
  const EffectCall calls[] = {
      dynamics({{"drag", 0.3}, {"first_end", Parameters::Table{{0, 0, 0, 0}, {1000, 0, 0, 0}}}})};
  EffectSequence sequence(calls, shape, 16);
  SceneState state(shape);
  for (int frame = 1; frame <= 100; ++frame) {
    sequence.advance(state, frame);
    for (const Bone& bone : state.bones)
      ASSERT_NEAR((bone.tail - bone.head).norm(), 1, 0.02) << "frame " << frame;
  }
  EXPECT_EQ(state.bones.front().head, Vec3::Zero());
  EXPECT_NEAR(state.bones.back().tail.z(), -20, 1e-3);
}

TEST(ChainDynamics, LeadsAnEndThroughItsKeysAndLetsItGoAfterTheLast) {
  const Shape shape = chain(8, 8, Vec3(3, 0, 0), Vec3::UnitX());
  const EffectCall calls[] = {dynamics(
      {{"first_end", Parameters::Table{{0, 3, 0, 0}, {10, 2, 0.25, 5}, {20, 2, 0.5, 5}}}, {"drag", 0.5}})};
  EffectSequence sequence(calls, shape, 8);
  SceneState state(shape);
  for (int frame = 1; frame <= 30; ++frame) {
    sequence.advance(state, frame);
    const Vec3& end = state.bones.front().head;
    if (frame == 10) {
      EXPECT_LT((end - Vec3(0, 2, 5)).norm(), 1e-9);
    }
    if (frame == 15) {
      EXPECT_NEAR(end.z(), 5, 1e-12) << "no overshoot between equal keys";
    }
    if (frame == 20) {
      EXPECT_LT((end - Vec3(-2, 0, 5)).norm(), 1e-9);
    }
  }
  EXPECT_LT(state.bones.front().head.z(), 0) << "falls when let go";
}

TEST(ChainDynamics, BendsNoSharperThanItsLimit) {
  const Shape shape = chain(12, 12, Vec3::Zero(), Vec3::UnitX());
  const Parameters::Table left = {{0, 0, 0, 0}, {1000, 0, 0, 0}};
  const Parameters::Table right = {{0, 12, 0, 0}, {40, 3, 0, 0}, {1000, 3, 0, 0}};
  const EffectCall calls[] = {
      dynamics({{"first_end", left}, {"last_end", right}, {"bend_radius", 1.2}, {"drag", 0.5}})};
  EffectSequence sequence(calls, shape, 32);
  SceneState state(shape);
  double sharpest = 1;
  for (int frame = 1; frame <= 80; ++frame) {
    sequence.advance(state, frame);
    for (std::size_t i = 1; i < state.bones.size(); ++i)
      sharpest =
          std::min(sharpest, (state.bones[i].tail - state.bones[i].head)
                                 .normalized()
                                 .dot((state.bones[i - 1].tail - state.bones[i - 1].head).normalized()));
  }
  const double limit = 2 * std::asin(1 / 2.4);
  EXPECT_LT(std::acos(sharpest), 1.1 * limit);
  EXPECT_GT(std::acos(sharpest), 0.8 * limit) << "the test must reach the limit";
}

TEST(ChainContact, KeepsTheChainOffItselfAndTheFloor) {
  // A chain that falls onto the floor, end first, buckles and piles up on itself.
  const Shape shape = chain(40, 40, Vec3(0, 0, 1), Vec3(0.02, 0.01, 1));
  const EffectCall with[] = {
      dynamics({{"drag", 0.5}, {"bend_radius", 1.5}, {"bend_stiffness", 1.0}}),
      call("chain_contact", {{"radius", 0.5}, {"clearance", 0.2}, {"friction", 0.5}, {"floor", 0.0}})};
  EffectSequence sequence(with, shape, 48);
  SceneState state(shape);
  double closest = 1e300, lowest = 1e300;
  for (int frame = 1; frame <= 60; ++frame) {
    sequence.advance(state, frame);
    for (std::size_t i = 0; i < state.bones.size(); ++i) {
      lowest = std::min(lowest, state.bones[i].head.z());
      for (std::size_t j = i + 4; j < state.bones.size() && frame % 10 == 0; ++j)
        closest = std::min(closest, distance(state.bones[i], state.bones[j]));
    }
  }
  EXPECT_GT(closest, 1.1) << "two radii and half the clearance";
  EXPECT_LT(closest, 1.25) << "the test must reach contact";
  EXPECT_GT(lowest, 0.55);
  EXPECT_LT(state.bones.back().tail.z(), 20) << "it fell";
}

TEST(PoseChain, BendsWithoutTwisting) {
  const Shape shape = chain(30, 30, Vec3::Zero(), Vec3::UnitZ());
  SceneState state(shape);
  state.steady_bone = 12;
  std::vector<Vec3> joints;
  read_joints(state, joints);
  // The chain becomes a helix in small steps.
  for (int step = 1; step <= 20; ++step) {
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const double angle = 0.012 * step * static_cast<double>(i);
      joints[i] = {3 * std::cos(angle), 3 * std::sin(angle), 0.9 * static_cast<double>(i)};
    }
    pose_chain(joints, state);
  }
  for (std::size_t i = 0; i < state.bones.size(); ++i) {
    const Eigen::Matrix3d& r = state.rotations[i];
    EXPECT_LT((r * r.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    const Vec3 along = (state.bones[i].tail - state.bones[i].head).normalized();
    EXPECT_LT((r * Vec3::UnitZ() - along).norm(), 1e-12) << "carries the bone";
    if (i == 0) continue;
    // The turn between neighbours has no part about the bones, because its axis is perpendicular to both.
    const Eigen::Matrix3d turn = r * state.rotations[i - 1].transpose();
    const Vec3 axis(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1));
    EXPECT_LT(std::abs(axis.dot(along)), 1e-12);
  }
}

TEST(PoseChain, TurnsAStraightChainRoundWithoutLosingItsFrame) {
  const Shape shape = chain(4, 4, Vec3::Zero(), Vec3::UnitZ());
  SceneState state(shape);
  std::vector<Vec3> joints;
  read_joints(state, joints);
  for (Vec3& joint : joints) joint = -joint;  // half a turn at once, for which many axes are equally good
  pose_chain(joints, state);
  for (const Eigen::Matrix3d& r : state.rotations) {
    EXPECT_LT((r * Vec3::UnitZ() + Vec3::UnitZ()).norm(), 1e-12);
    EXPECT_NEAR(r.determinant(), 1, 1e-12);
  }
}

TEST(ChainEffects, RefuseAShapeWithoutAChain) {
  Shape shape = chain(4, 4, Vec3::Zero(), Vec3::UnitX());
  shape.rig.parent[2] = BoneId{0};
  EXPECT_NE(refusal(shape, dynamics({})).find("test, effect chain_dynamics: bone 2"), std::string::npos);
  EXPECT_NE(refusal(shape, call("chain_contact", {{"radius", 1.0}, {"clearance", 0.1}})).find("bone 2"),
            std::string::npos);
  shape.rig.parent[2] = BoneId{1};
  EXPECT_EQ(refusal(shape, dynamics({})), "");
  EXPECT_NE(refusal(shape, dynamics({{"steady_bone", 4.0}})).find("steady_bone is 4"), std::string::npos);
  EXPECT_NE(refusal(shape, dynamics({{"first_end", Parameters::Table{{3, 0, 0, 0}, {3, 0, 0, 0}}}}))
                .find("must increase"),
            std::string::npos);
}

}  // namespace
}  // namespace cscd::scenes
