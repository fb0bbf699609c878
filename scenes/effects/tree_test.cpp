#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "scenes/effects/keys.h"
#include "scenes/effects/rotation.h"
#include "scenes/effects/test_effects.h"
#include "scenes/effects/tree_pose.h"

namespace cscd::scenes {
namespace {

// A trunk along z with two arms at its top. Each arm has three bones of length 1; one arm points along x,
// the other against x.
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
  const double h = 1e-6;  // the periods meet at frame 2, in the middle of a rise with slope 1 / 3
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
  // right_1 turns about y, which the trunk has carried to -x. So it turns from the y axis downwards.
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
  EXPECT_EQ(select_bones(shape, "left_2 *_1 right_1", "test"), (std::vector<std::size_t>{2, 5, 6}));
  EXPECT_THROW(select_bones(shape, "left_2 left_3", "test"), InputError);
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
  expect_near(state.bones[3].tail, {7, 1, 2});  // the bone is folded back
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

TEST(TravellingWave, RunsAlongItsChains) {
  const Shape shape = tree();
  const Values values = {{"bones", "*t_*"},    {"towards", std::vector<double>{0, 0, 3}},
                         {"amplitude", 0.2},   {"first_amplitude", 0.1},
                         {"wave_length", 4.0}, {"period", 16.0},
                         {"phase", 0.125},     {"chain_phase", 0.5}};
  const SceneState state = run(shape, {call("travelling_wave", values)}, 6);
  // At frame 6 of a period of 16 the phases are 3/8 + 1/8 - place/4. The second chain is half a turn later.
  const double turns[] = {0.1 * 0, 0.15 * 1, 0.2 * 0};  // sines of 1/2, 1/4, 0 turns
  double angle = 0;
  Vec3 right(0, 0, 2), left(0, 0, 2);
  for (std::size_t i = 0; i < 3; ++i) {
    angle += 2 * std::numbers::pi * turns[i];
    right += Vec3(std::cos(angle), 0, std::sin(angle));
    left += Vec3(-std::cos(angle), 0, -std::sin(angle));
    expect_near(state.bones[1 + i].tail, right);
    expect_near(state.bones[4 + i].tail, left);
  }
  expect_near(state.bones[0].tail, {0, 0, 2});
}

TEST(TravellingWave, IsABendWhereItStandsStill) {
  const Shape shape = tree();
  const Values values = {{"bones", "right_*"},
                         {"towards", std::vector<double>{0, 0, 1}},
                         {"first_amplitude", 0.25},
                         {"amplitude", 0.25},
                         {"phase", 0.25}};
  for (const int frame : {1, 9})
    expect_near(run(shape, {call("travelling_wave", values)}, frame).bones[3].tail, {-1, 0, 2});
}

TEST(TravellingWave, FadesAndAddsUp) {
  const Shape shape = tree();
  Values values = {{"bones", "right_0"}, {"axis", std::vector<double>{0, 0, 2}},
                   {"amplitude", 0.25},  {"wave_length", 1.0},
                   {"period", 40.0},     {"start", 5.0},
                   {"fade", 10.0}};
  const EffectCall wave = call("travelling_wave", values);
  expect_near(run(shape, {wave}, 5).bones[1].tail, {1, 0, 2});
  // At frame 10 the wave is at its crest and half faded in.
  expect_near(run(shape, {wave}, 10).bones[1].tail, {std::sqrt(0.5), std::sqrt(0.5), 2});
  expect_near(run(shape, {wave, wave}, 10).bones[1].tail, {0, 1, 2});
  const EffectCall keys = call("keyframes", {{"right_0", Table{{0, 0, 0, -0.125}}}});
  expect_near(run(shape, {keys, wave}, 10).bones[1].tail, {1, 0, 2});
}

TEST(Twist, SharesItsTurnsAmongTheBones) {
  const Shape shape = tree();
  const EffectCall twist = call("twist", {{"bones", "right_*"}, {"turns", Table{{0, 0}, {8, 0.5}}}});
  const SceneState state = run(shape, {twist}, 8);
  EXPECT_EQ(state.rotations[1], Eigen::Matrix3d::Identity());
  expect_near(rotated(state.rotations[2], Vec3::UnitY()), Vec3::UnitZ());
  expect_near(rotated(state.rotations[3], Vec3::UnitY()), -Vec3::UnitY());
  expect_near(state.bones[3].tail, {3, 0, 2});
  EXPECT_EQ(state.rotations[4], Eigen::Matrix3d::Identity());
  // A bone twists about its present axis, not about its axis at rest.
  const SceneState bent = run(shape, {call("keyframes", {{"right_2", Table{{0, 0, 0, 0.25}}}}), twist}, 8);
  expect_near(bent.bones[3].tail, {2, 0, 3});
  expect_near(rotated(bent.rotations[3], Vec3::UnitZ()), {1, 0, 0});
}

TEST(SpringFollow, SwingsLikeADampedSpringAndSettles) {
  const Shape shape = tree();
  // The trunk jumps aside. At small angles the mass is a damped oscillator in one dimension.
  const double jump = 1e-4;
  const EffectCall keys = call("keyframes", {{"trunk", Table{{0, 0, jump, 0}}}});
  const EffectCall spring =
      call("spring_follow", {{"bones", "trunk"}, {"stiffness", 0.04}, {"damping", 0.1}});
  EffectSequence sequence(std::vector{keys, spring}, shape, 256);
  SceneState state(shape);
  const double aside = 2 * 2 * std::numbers::pi * jump, decay = 0.05;
  const double frequency = std::sqrt(0.04 - decay * decay);
  for (int frame = 1; frame <= 60; ++frame) {
    sequence.advance(state, frame);
    const double expected =
        aside * (1 - std::exp(-decay * frame) *
                         (std::cos(frequency * frame) + decay / frequency * std::sin(frequency * frame)));
    ASSERT_NEAR(state.bones[0].tail.x(), expected, 0.005 * aside) << "frame " << frame;
  }
  EXPECT_LT((state.bones[1].head - state.bones[0].tail).norm(), 1e-12) << "arms hang on the trunk";
  EXPECT_NEAR((state.bones[0].tail - state.bones[0].head).norm(), 2, 1e-12);
}

TEST(SpringFollow, StaysBoundedWhateverItsParameters) {
  const Shape shape = tree();
  const EffectCall keys =
      call("keyframes", {{"trunk", Table{{0, 0, 0, 0}, {1, 0.4, 0, 0}, {2, 0, 0.5, 0}}}, {"period", 3.0}});
  for (const double stiffness : {0.0, 1e-6, 0.3, 1e9})
    for (const double damping : {0.0, 1e-3, 1e9}) {
      const EffectCall spring =
          call("spring_follow", {{"bones", "*"}, {"stiffness", stiffness}, {"damping", damping}});
      const SceneState state = run(shape, {keys, spring}, 300);
      for (std::size_t bone = 0; bone < 7; ++bone) {
        EXPECT_NEAR((state.bones[bone].tail - state.bones[bone].head).norm(), bone == 0 ? 2 : 1, 1e-9);
        EXPECT_LT(
            (state.rotations[bone] * state.rotations[bone].transpose() - Eigen::Matrix3d::Identity()).norm(),
            1e-9);
      }
    }
}

TEST(SpringFollow, IsThePoseWhereTheSpringIsStiff) {
  const Shape shape = tree();
  const EffectCall keys = call("keyframes", {{"*", Table{{0, 0, 0, 0}, {10, 0.03, 0.05, -0.02}}}});
  const EffectCall stiff = call("spring_follow", {{"bones", "*"}, {"stiffness", 1e9}, {"damping", 0.0}});
  const SceneState plain = run(shape, {keys}, 7), sprung = run(shape, {keys, stiff}, 7);
  for (std::size_t bone = 0; bone < 7; ++bone)
    EXPECT_LT((plain.bones[bone].tail - sprung.bones[bone].tail).norm(), 1e-6);
}

TEST(TreeEffects, RefuseWhatTheyCannotUse) {
  Shape shape = tree();
  const Values wave = {{"bones", "right_*"}, {"amplitude", 0.1}, {"wave_length", 3.0}, {"period", 9.0}};
  const auto with = [](Values values, const Values& more) {
    for (const auto& [name, value] : more) values.insert_or_assign(name, value);
    return values;
  };
  const std::vector<double> x = {1, 0, 0}, z = {0, 0, 1};
  EXPECT_EQ(refusal(shape, call("travelling_wave", with(wave, {{"axis", z}}))), "");
  EXPECT_EQ(refusal(shape, call("travelling_wave", wave)),
            "test, effect travelling_wave: give one of the parameters axis and towards");
  EXPECT_EQ(
      refusal(shape, call("travelling_wave", with(wave, {{"towards", x}}))),
      "test, effect travelling_wave: bone right_0 lies along the direction to turn towards, or that is zero; "
      "choose another");
  EXPECT_NE(refusal(shape, call("travelling_wave", with(wave, {{"axis", z}, {"bones", "leg*"}})))
                .find("no bone is called leg*; known are: trunk"),
            std::string::npos);
  EXPECT_EQ(refusal(shape, call("travelling_wave", with(wave, {{"axis", z}, {"wave_length", 0.0}}))),
            "test, effect travelling_wave: parameter wave_length must not be 0");
  EXPECT_EQ(refusal(shape, call("twist", {{"bones", "trunk"}, {"turns", Table{{0, 0}}}})),
            "test, effect twist: bone trunk is a chain of its own; choose chains of at least two bones");
  EXPECT_EQ(refusal(shape, call("twist", {{"bones", "*"}, {"turns", Table{{2, 0}, {1, 0}}}})),
            "test, effect twist: parameter turns: the frames of its keys must increase");
  EXPECT_EQ(refusal(shape, call("spring_follow", {{"bones", "*"}, {"stiffness", -1.0}, {"damping", 0.0}})),
            "test, effect spring_follow: parameter stiffness is -1; it must be in [0, 1e+09]");
  shape.rig.reference[4].tail = shape.rig.reference[4].head;
  EXPECT_EQ(refusal(shape, call("spring_follow", {{"bones", "*"}, {"stiffness", 1.0}, {"damping", 0.0}})),
            "test, effect spring_follow: bone left_0 has no length; leave it out");
}

}  // namespace
}  // namespace cscd::scenes
