#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "core/base/error.h"
#include "scenes/effects/keys.h"
#include "scenes/effects/rotation.h"
#include "scenes/effects/sequence.h"
#include "scenes/effects/tree_pose.h"

namespace cscd::scenes {
namespace {

using Values = std::map<std::string, Parameters::Value, std::less<>>;
using Table = Parameters::Table;

EffectCall call(const std::string& name, Values values = {}) {
  return {name, Parameters("test, effect " + name, std::move(values))};
}

// A trunk along z with two arms at its top, each of three bones of length 1: along x, and against it.
Shape tree() {
  Shape shape;
  const auto add = [&](const std::string& name, int parent, const Vec3& head, const Vec3& tail) {
    shape.bone_names.push_back(name);
    shape.rig.parent.push_back(BoneId{parent});
    shape.rig.reference.push_back({head, tail});
  };
  add("trunk", -1, Vec3::Zero(), 2 * Vec3::UnitZ());
  for (const double side : {1.0, -1.0})
    for (int i = 0; i < 3; ++i)
      add((side > 0 ? "right_" : "left_") + std::to_string(i), i == 0 ? 0 : (side > 0 ? i : 3 + i),
          Vec3(side * i, 0, 2), Vec3(side * (i + 1), 0, 2));
  return shape;
}

// The state after frames 1 to `frame`.
SceneState run(const Shape& shape, const std::vector<EffectCall>& calls, int frame, int substeps = 1) {
  EffectSequence sequence(calls, shape, substeps);
  SceneState state(shape);
  for (int i = 1; i <= frame; ++i) sequence.advance(state, i);
  return state;
}

std::string refusal(const Shape& shape, const EffectCall& effect) {
  try {
    EffectSequence({&effect, 1}, shape, 1);
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << "one line";
    return error.what();
  }
  return "";
}

void expect_near(const Vec3& found, const Vec3& expected) {
  EXPECT_LT((found - expected).norm(), 1e-10) << found.transpose() << " for " << expected.transpose();
}

TEST(KeyCurve, PassesThroughItsKeysWithoutOvershootAndRestsOutside) {
  const KeyCurve curve({{10, 1}, {20, 3}, {30, 3}, {40, -1}}, "test");
  EXPECT_EQ(curve.at(-5, 1), 1);
  EXPECT_EQ(curve.at(10, 1), 1);
  EXPECT_EQ(curve.at(20, 1), 3);
  EXPECT_DOUBLE_EQ(curve.at(25, 1), 3);
  EXPECT_EQ(curve.at(99, 1), -1);
  EXPECT_DOUBLE_EQ(curve.at(15, 1), 2) << "between keys without slope";
  for (double frame = 10; frame < 20; frame += 0.25) EXPECT_LT(curve.at(frame, 1), curve.at(frame + 0.25, 1));
}

TEST(KeyCurve, RepeatsSmoothly) {
  const KeyCurve curve = KeyCurve::periodic({{2, 0}, {5, 1}, {8, 0}, {11, -1}}, 12, "test");
  for (const double frame : {2.0, 3.3, 5.0, 9.25, 13.75}) {
    EXPECT_NEAR(curve.at(frame + 12, 1), curve.at(frame, 1), 1e-12);
    EXPECT_NEAR(curve.at(frame - 24, 1), curve.at(frame, 1), 1e-12);
  }
  EXPECT_EQ(curve.at(5, 1), 1);
  EXPECT_EQ(curve.at(-1, 1), -1);
  const double h = 1e-6;  // the seam lies at frame 2, in the midst of a rise with slope 1 / 3
  EXPECT_NEAR((curve.at(2 + h, 1) - curve.at(2, 1)) / h, 1.0 / 3, 1e-5);
  EXPECT_NEAR((curve.at(2, 1) - curve.at(2 - h, 1)) / h, 1.0 / 3, 1e-5);
  EXPECT_EQ(KeyCurve::periodic({{3, 7}}, 5, "test").at(4.5, 1), 7);
}

TEST(Envelope, FadesInAndOut) {
  const Envelope envelope{10, 30, 4};
  EXPECT_EQ(envelope.at(10), 0);
  EXPECT_DOUBLE_EQ(envelope.at(12), 0.5);
  EXPECT_EQ(envelope.at(20), 1);
  EXPECT_DOUBLE_EQ(envelope.at(28), 0.5);
  EXPECT_EQ(envelope.at(31), 0);
  EXPECT_EQ(Envelope{}.at(1e9), 1);
}

TEST(RotationBy, TurnsByItsLengthAboutItsDirection) {
  EXPECT_EQ(rotation_by(Vec3::Zero()), Eigen::Matrix3d::Identity());
  expect_near(rotated(rotation_by({0, 0, 0.25}), Vec3::UnitX()), Vec3::UnitY());
  expect_near(rotated(rotation_by(Vec3::Ones() / std::sqrt(3.0) / 3), Vec3::UnitX()), Vec3::UnitY());
  const Vec3 vector(0.1, -0.3, 0.2);
  const Eigen::Matrix3d expected =
      Eigen::AngleAxisd(2 * std::numbers::pi * vector.norm(), vector.normalized()).toRotationMatrix();
  EXPECT_LT((rotation_by(vector) - expected).norm(), 1e-11);
  EXPECT_LT((rotation_by(vector) * rotation_by(vector).transpose() - Eigen::Matrix3d::Identity()).norm(),
            1e-15);
}

TEST(TurnBones, CarriesWhatHangsOnABone) {
  const Shape shape = tree();
  SceneState state(shape);
  turn_bones(state, [](std::size_t bone) {
    return rotation_by(bone == 0 ? Vec3(0, 0, 0.25) : bone == 2 ? Vec3(0, 0.25, 0) : Vec3::Zero());
  });
  expect_near(state.bones[1].tail, {0, 1, 2});
  // right_1 turned about y, which the trunk has carried to -x: from along y to downwards.
  expect_near(state.bones[2].tail, {0, 1, 1});
  expect_near(state.bones[3].tail, {0, 1, 0});
  expect_near(state.bones[6].tail, {0, -3, 2});
  EXPECT_LT((state.rotations[3] - rotation_by({0, 0, 0.25}) * rotation_by({0, 0.25, 0})).norm(), 1e-11);
}

TEST(TurnBones, AddsUpCallAfterCall) {
  const Shape shape = tree();
  SceneState at_once(shape), one_by_one(shape);
  const auto turn = [](std::size_t bone) { return rotation_by(Vec3(0.02, 0.05, -0.04) * (1.0 + bone)); };
  turn_bones(at_once, turn);
  for (const std::size_t only : {5, 2, 0, 6, 1, 3, 4})
    turn_bones(one_by_one, [&](std::size_t bone) {
      return bone == only ? turn(bone) : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
    });
  for (std::size_t bone = 0; bone < 7; ++bone) {
    expect_near(at_once.bones[bone].head, one_by_one.bones[bone].head);
    expect_near(at_once.bones[bone].tail, one_by_one.bones[bone].tail);
    EXPECT_LT((at_once.rotations[bone] - one_by_one.rotations[bone]).norm(), 1e-10);
  }
}

TEST(SelectChains, FollowsTheTreeAmongTheNamed) {
  const Shape shape = tree();
  const auto chains = select_chains(shape, "*t_*", "test");
  ASSERT_EQ(chains.size(), 6u);
  EXPECT_EQ(chains[2].bone, 3u);
  EXPECT_EQ(chains[2].chain, 0u);
  EXPECT_EQ(chains[2].place, 2u);
  EXPECT_EQ(chains[3].chain, 1u);
  EXPECT_EQ(chains[3].place, 0u);
  EXPECT_EQ(chains[3].length, 2u);
  EXPECT_EQ(select_bones(shape, "right_1", "test"), std::vector<std::size_t>{2});
  EXPECT_EQ(select_bones(shape, "*", "test").size(), 7u);
}

TEST(Keyframes, TurnsBonesByTheirKeys) {
  const Shape shape = tree();
  const std::vector<EffectCall> calls = {
      call("keyframes", {{"right_0", Table{{0, 0, 0, 0}, {10, 0, 0, 0.25}}},
                         {"right_2", Table{{0, 0, 0.5, 0}}},
                         {"root", Table{{0, 0, 0, 0}, {10, 7, 0, 0}}}})};
  const SceneState state = run(shape, calls, 10);
  expect_near(state.bones[1].tail, {7, 1, 2});
  expect_near(state.bones[3].head, {7, 2, 2});
  expect_near(state.bones[3].tail, {7, 1, 2});  // folded back
  expect_near(state.bones[6].tail, {4, 0, 2});
  expect_near(run(shape, calls, 5).bones[1].tail, {3.5 + std::sqrt(0.5), std::sqrt(0.5), 2});
  expect_near(run(shape, calls, 25).bones[1].tail, {7, 1, 2});
}

TEST(Keyframes, AddUpUnderPatternsAndSeveralCalls) {
  const Shape shape = tree();
  const Table eighth = {{0, 0, 0, 0.125}}, once = {{0, 0, 0, 0.25}};
  for (const std::vector<EffectCall>& calls :
       {std::vector{call("keyframes", {{"right_0", eighth}, {"r*_0", eighth}})},
        std::vector{call("keyframes", {{"right_0", eighth}}), call("keyframes", {{"right_0", eighth}})},
        std::vector{call("keyframes", {{"right_0", once}})}})
    expect_near(run(shape, calls, 3, 2).bones[3].tail, {0, 3, 2});
}

TEST(Keyframes, RepeatAndFade) {
  const Shape shape = tree();
  const Values values = {{"trunk", Table{{0, 0, 0, 0}, {5, 0, 0, 0.25}}},
                         {"period", 10.0},
                         {"start", 20.0},
                         {"end", 60.0},
                         {"fade", 10.0}};
  expect_near(run(shape, {call("keyframes", values)}, 20).bones[1].tail, {1, 0, 2});
  expect_near(run(shape, {call("keyframes", values)}, 25).bones[1].tail, {std::sqrt(0.5), std::sqrt(0.5), 2});
  expect_near(run(shape, {call("keyframes", values)}, 35).bones[1].tail, {0, 1, 2});
  expect_near(run(shape, {call("keyframes", values)}, 40).bones[1].tail, {1, 0, 2});
  expect_near(run(shape, {call("keyframes", values)}, 60).bones[1].tail, {1, 0, 2});
}

TEST(Keyframes, RefuseWhatTheyCannotUse) {
  Shape shape = tree();
  EXPECT_EQ(refusal(shape, call("keyframes", {{"thumb", Table{{0, 0, 0, 0}}}})),
            "test, effect keyframes: parameter thumb: no bone is called thumb; known are: trunk, right_0, "
            "right_1, right_2, left_0, left_1, left_2");
  EXPECT_NE(refusal(shape, call("keyframes", {{"trunk", Table{{0, 0, 0}}}})).find("a row of 3 numbers"),
            std::string::npos);
  EXPECT_EQ(refusal(shape, call("keyframes", {{"trunk", 3.0}})),
            "test, effect keyframes: parameter trunk must be a list of lists of numbers");
  EXPECT_EQ(refusal(shape, call("keyframes", {{"trunk", Table{{4, 0, 0, 0}, {4, 0, 0, 1}}}})),
            "test, effect keyframes: parameter trunk: the frames of its keys must increase");
  EXPECT_EQ(
      refusal(shape, call("keyframes", {{"trunk", Table{{0, 0, 0, 0}, {4, 0, 0, 1}}}, {"period", 4.0}})),
      "test, effect keyframes: parameter trunk: its keys must lie within less than the period");
  EXPECT_EQ(refusal(shape, call("keyframes", {{"start", 3.0}, {"end", 3.0}})),
            "test, effect keyframes: parameter end must be above start");
  shape.bone_names[2] = "root";
  EXPECT_EQ(refusal(shape, call("keyframes", {{"root", Table{{0, 0, 0, 0}}}})),
            "test, effect keyframes: parameter root is the name of a bone too; rename the bone");
  shape.bone_names[2] = "trunk";
  EXPECT_EQ(refusal(shape, call("keyframes")),
            "test, effect keyframes: the effect needs a shape whose bones have a name each");
  shape = tree();
  std::swap(shape.rig.parent[2], shape.rig.parent[3]);
  shape.rig.parent[2] = BoneId{3};
  EXPECT_NE(refusal(shape, call("keyframes")).find("bone right_1 comes before its parent"),
            std::string::npos);
}

}  // namespace
}  // namespace cscd::scenes
