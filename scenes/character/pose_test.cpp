#include "scenes/character/pose.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/test_refusal.h"
#include "scenes/base/test_says.h"
#include "scenes/character/skeleton.h"
#include "scenes/character/test_characters.h"

namespace cscd::scenes {
namespace {

constexpr double kNear = 1e-12;

std::vector<Vec3> skinned(const Character& character, const Pose& pose) {
  std::vector<Vec3> out;
  skin(character, pose, out);
  return out;
}

TEST(Pose, AtRestJointsLeaveVerticesWhereTheMeshPutsThem) {
  const Character tube = bending_tube();
  const std::vector<Vec3> at_rest = skinned(tube, rest_pose(tube));
  for (std::size_t v = 0; v < at_rest.size(); ++v)
    EXPECT_LT((at_rest[v] - tube.parts[0].positions[v] - Vec3(0, 0, 5)).norm(), kNear);
}

TEST(Pose, MovesVerticesWithTheirJoints) {
  const Character tube = bending_tube();
  const std::vector<Vec3> bent = skinned(tube, pose_at(tube, tube.animations[0], 1));
  for (std::size_t v = 0; v < bent.size(); ++v) {
    const Vec3& x = tube.parts[0].positions[v];
    if (x.x() < 1.4) {
      EXPECT_LT((bent[v] - x - Vec3(0, 0, 5)).norm(), kNear);
    } else if (x.x() > 2.6) {
      // The upper joint, at x = 2, makes a quarter turn.
      EXPECT_LT((bent[v] - Vec3(2 - x.y(), x.x() - 2, x.z() + 5)).norm(), kNear);
    }
  }
}

TEST(Pose, HoldsTheFirstAndLastKeyAndTurnsBetween) {
  const Character tube = bending_tube();
  const Animation& bend = tube.animations[0];
  EXPECT_EQ(pose_at(tube, bend, -1)[4].column[0], pose_at(tube, bend, 0)[4].column[0]);
  EXPECT_EQ(pose_at(tube, bend, 9)[4].column[0], pose_at(tube, bend, 1)[4].column[0]);
  const Vec3 half = pose_at(tube, bend, 0.5)[4].column[0];
  EXPECT_LT((half - Vec3(std::sqrt(0.5), std::sqrt(0.5), 0)).norm(), kNear);
}

// A channel that only moves a node must leave the node's rotation at rest, and nodes
// without a channel must stay.
TEST(Pose, PartsWithoutKeysStayAtRest) {
  Character tube = bending_tube();
  tube.nodes[4].local = quarter_turn({1, 0, 0});
  tube.animations[0].channels = {{4, {{0, Vec3(7, 0, 0)}}, {}, {}}};
  const Pose pose = pose_at(tube, tube.animations[0], 0);
  EXPECT_LT((pose[4].column[0] - Vec3(0, 1, 0)).norm(), kNear);
  EXPECT_LT((pose[4].origin - Vec3(8, 0, 5)).norm(), kNear);
  EXPECT_EQ(pose[2].origin, rest_pose(tube)[2].origin);
}

// Returns where one node stands on x at a time, moved by the keys given.
double moved_to(std::vector<Key<Vec3>> keys, double seconds) {
  Character tube = bending_tube();
  tube.animations[0].channels = {{0, std::move(keys), {}, {}}};
  return pose_at(tube, tube.animations[0], seconds)[0].origin.x();
}

TEST(Pose, KeysStayOrGoStraightOrAlongACubicAsTheySay) {
  const Vec3 one(1, 0, 0), two(2, 0, 0), flat = Vec3::Zero(), steep(3, 0, 0);
  EXPECT_EQ(moved_to({{0, one, Between::constant, flat, flat}, {2, two}}, 1.999), 1);
  EXPECT_EQ(moved_to({{0, one, Between::constant, flat, flat}, {2, two}}, 2), 2);
  EXPECT_EQ(moved_to({{0, one, Between::line, flat, flat}, {2, two}}, 1), 1.5);
  // A cubic with flat ends has gone 3 s^2 - 2 s^3 of the way. A slope of 3 a second at the start, over two
  // seconds, adds 6 (s^3 - 2 s^2 + s).
  const Key<Vec3> end{2, two, Between::line, flat, flat};
  EXPECT_NEAR(moved_to({{0, one, Between::cubic, flat, flat}, end}, 0.5), 1 + 3 / 16.0 - 2 / 64.0, kNear);
  EXPECT_NEAR(moved_to({{0, one, Between::cubic, flat, steep}, end}, 0.5),
              1 + 3 / 16.0 - 2 / 64.0 + 6 * (1 / 64.0 - 2 / 16.0 + 1 / 4.0), kNear);
}

TEST(Pose, CubicRotationsAreNormalised) {
  Character tube = bending_tube();
  std::vector<Key<Quaternion>>& keys = tube.animations[0].channels[0].rotations;
  const Quaternion none{0, 0, 0, 0};
  for (Key<Quaternion>& key : keys) key = {key.time, key.value, Between::cubic, none, none};
  const Vec3 turned = pose_at(tube, tube.animations[0], 0.25)[4].column[0];
  // The rotation of the normalised sum of both quaternions, with the second weighted by
  // 3 s^2 - 2 s^3 = 0.15625.
  const double half = std::sqrt(0.5), angle = 2 * std::atan2(0.15625 * half, 0.84375 + 0.15625 * half);
  EXPECT_LT((turned - Vec3(std::cos(angle), std::sin(angle), 0)).norm(), 1e-9);
}

TEST(Pose, ComponentsHaveKeysOfTheirOwnAndElseRest) {
  Character tube = bending_tube();
  Channel channel{4, {}, {}, {}};
  channel.move_components = {
      {{Curve{{{0, 1.0}, {4, 5.0}}}, Curve{}, Curve{{{1, 0.0}, {2, 8.0}}}}, {9, 7, 9}}};
  channel.angles = {{{{Curve{}, Curve{}, Curve{{{0, 0.0}, {1, 90.0}}}}, {90, 0, 0}}}, {0, 1, 2}};
  tube.animations[0].channels = {channel};
  const Transform upper = pose_at(tube, tube.animations[0], 1.5)[4];
  EXPECT_LT((upper.origin - Vec3(1 + 2.5, 7, 5 + 4)).norm(), kNear);
  // First a quarter turn about x, then a quarter turn about z: the z axis goes to -y, and -y goes to x.
  EXPECT_LT((upper.column[2] - Vec3(1, 0, 0)).norm(), 1e-9);
}

// A scale of [1, -1, -1] is kept as the file writes it: a matrix would not tell it from a half turn about x.
TEST(Pose, MirroredScalesAreKeptAsWritten) {
  Character tube = bending_tube();
  tube.nodes[4].written = ScaleTurnMove{{1, 0, 0}, {}, {1, -1, -1}};
  tube.nodes[4].local = from_trs({1, 0, 0}, {}, {1, -1, -1});
  tube.animations[0].channels = {{4, {{0, Vec3(1, 0, 0)}}, {}, {}}};
  EXPECT_EQ(pose_at(tube, tube.animations[0], 0)[4].column, rest_pose(tube)[4].column);
  const double half = std::sqrt(0.5);
  tube.animations[0].channels = {{4, {}, {{0, Quaternion{half, 0, 0, half}}}, {}}};
  const Transform turned = pose_at(tube, tube.animations[0], 0)[4];
  EXPECT_LT((turned.column[1] - Vec3(1, 0, 0)).norm(), kNear);
  EXPECT_LT((turned.column[2] - Vec3(0, 0, -1)).norm(), kNear);
}

TEST(Pose, MorphTargetsAreAddedBeforeJointsMove) {
  Character tube = bending_tube();
  Part& part = tube.parts[0];
  part.targets = {{"wide", std::vector<Vec3>(part.positions.size(), Vec3(0, 1, 0)), 0.25},
                  {"high", std::vector<Vec3>(part.positions.size(), Vec3(0, 0, 2)), 0}};
  tube.animations[0].morphs = {{0, {Layered<1>{}, driven({{0, 0.0}, {1, 1.0}})}}};
  validate(tube, {});
  std::vector<Vec3> out;
  skin(tube, pose_at(tube, tube.animations[0], 1), weights_at(tube, tube.animations[0], 0.5), out);
  for (std::size_t v = 0; v < out.size(); ++v) {
    const Vec3 x = part.positions[v] + Vec3(0, 0.25, 1);
    if (part.positions[v].x() > 2.6) {
      EXPECT_LT((out[v] - Vec3(2 - x.y(), x.x() - 2, x.z() + 5)).norm(), kNear);
    }
  }
  skin(tube, rest_pose(tube), out);
  EXPECT_LT((out[3] - part.positions[3] - Vec3(0, 0.25, 5)).norm(), kNear);
}

TEST(Pose, VerticesWithoutWeightsFollowTheirNode) {
  Character tube = bending_tube();
  Part& part = tube.parts[0];
  part.joints.clear();
  part.influences.clear();
  std::fill(part.first.begin(), part.first.end(), 0);
  part.node = 4;
  const std::vector<Vec3> bent = skinned(tube, pose_at(tube, tube.animations[0], 1));
  const Vec3& x = part.positions[3];
  EXPECT_LT((bent[3] - Vec3(2 - x.y(), x.x(), x.z() + 5)).norm(), kNear);
  EXPECT_EQ(moving_nodes(tube), std::vector<int>{4});
}

// A scale that follows a node with `inverse` cancels it at every time, and one that
// follows it without repeats it.
TEST(Pose, NodesThatFollowAScaleUndoItAtEveryTime) {
  Character tree;
  const ScaleTurnMove twice{Vec3::Zero(), {}, {2, 1, 1}}, half{Vec3::Zero(), {}, {0.5, 1, 1}};
  tree.nodes = {{"root", -1, {}},
                {"scaled", 0, from_trs(Vec3::Zero(), {}, twice.scale), twice},
                {"undone", 1, from_trs(Vec3::Zero(), {}, half.scale), half, FollowedScale{1, true}},
                {"again", 2, from_trs(Vec3::Zero(), {}, twice.scale), twice, FollowedScale{1, false}}};
  Animation grow;
  Channel channel;
  channel.node = 1;
  channel.scales = {{0, {2, 1, 1}}, {1, {6, 1, 1}}};
  grow.channels = {channel};
  for (const double time : {0.0, 0.5, 1.0}) {
    const Pose pose = pose_at(tree, grow, time);
    EXPECT_EQ(pose[1].column[0].x(), 2 + 4 * time);
    EXPECT_NEAR(pose[2].column[0].x(), 1, 1e-15);
    EXPECT_NEAR(pose[3].column[0].x(), 2 + 4 * time, 1e-15);
  }
  EXPECT_EQ(rest_pose(tree)[2].column[0].x(), 1);
  tree.nodes[2].follows = FollowedScale{2, true};
  EXPECT_THROW(validate(tree, {}), InputError);
}

// In files whose nodes rest in the first pose of a clip, the offsets of the joints still
// tell how the skin was bound.
TEST(BindPose, ComesFromTheOffsetsAndNotFromTheRest) {
  Character tube = bending_tube();
  const Pose bound = bind_pose(tube);
  tube.nodes[4].local = quarter_turn({1, 0, 0});
  EXPECT_GT((rest_pose(tube)[4].column[0] - bound[4].column[0]).norm(), 1);
  for (std::size_t n = 0; n < bound.size(); ++n) {
    EXPECT_LT((bind_pose(tube)[n].column[0] - bound[n].column[0]).norm(), kNear);
    EXPECT_LT((bind_pose(tube)[n].origin - bound[n].origin).norm(), kNear);
  }
}

TEST(BlendedPose, KeepsTheUpperJointOnItsWayAboutTheLower) {
  const Character tube = bending_tube();
  Character turned = tube;
  turned.nodes[2].local = quarter_turn();
  const Pose a = rest_pose(tube), b = rest_pose(turned);
  const Pose middle = blend(tube, a, b, 0.5);
  // The joint is half-way on the circle of radius 2, which lies off the chord.
  EXPECT_LT((middle[4].origin - Vec3(std::sqrt(2.0), std::sqrt(2.0), 5)).norm(), kNear);
  EXPECT_EQ(blend(tube, a, b, 1)[4].origin, b[4].origin);
}

TEST(Skeleton, RunsFromJointToJointAndEndsInTheBody) {
  const Character tube = bending_tube();
  const Pose bound = bind_pose(tube);
  const std::vector<Vec3> positions = skinned(tube, bound);
  const Skeleton skeleton = make_skeleton(tube, bound, positions, std::vector<bool>(positions.size(), true));
  ASSERT_EQ(skeleton.node, (std::vector<int>{2, 4}));  // the helper moves nothing
  EXPECT_EQ(skeleton.parent, (std::vector<BoneId>{BoneId{-1}, BoneId{0}}));
  std::vector<Bone> bones;
  bones_at(skeleton, bound, bones);
  EXPECT_LT((bones[0].head - Vec3(0, 0, 5)).norm(), kNear);
  EXPECT_LT((bones[0].tail - bones[1].head).norm(), kNear);
  EXPECT_LT((bones[1].head - Vec3(2, 0, 5)).norm(), kNear);
  EXPECT_GT(bones[1].tail.x(), 2.5);
  EXPECT_LT(bones[1].tail.x(), 4);

  bones_at(skeleton, pose_at(tube, tube.animations[0], 1), bones);
  EXPECT_LT((bones[1].head - Vec3(2, 0, 5)).norm(), kNear);
  EXPECT_GT(bones[1].tail.y(), 0.5);
}

TEST(Skeleton, LeavesOutBonesOfVerticesThatAreNotUsed) {
  const Character tube = bending_tube();
  const Pose bound = bind_pose(tube);
  const std::vector<Vec3> positions = skinned(tube, bound);
  std::vector<bool> used(positions.size());
  for (std::size_t v = 0; v < used.size(); ++v) used[v] = positions[v].x() > 3;
  const Skeleton skeleton = make_skeleton(tube, bound, positions, used);
  EXPECT_EQ(skeleton.node, std::vector<int>{4});
  EXPECT_EQ(skeleton.parent, std::vector<BoneId>{BoneId{-1}});
}

template <class Spoil>
std::string refusal(const Spoil& spoil, const CharacterLimits& limits = {}) {
  Character character = bending_tube();
  spoil(character);
  return test::refusal([&] { validate(character, limits); });
}

TEST(Validate, AcceptsTheTube) {
  EXPECT_EQ(refusal([](Character&) {}), "");
}

TEST(Validate, NamesWhatIsWrong) {
  const double nan = std::nan("");
  EXPECT_TRUE(says(refusal([&](Character& c) { c.parts[0].positions[5].y() = nan; }), "vertex 5"));
  EXPECT_TRUE(says(refusal([](Character& c) { c.parts[0].positions[5].y() = 1e300; }), "vertex 5"));
  EXPECT_TRUE(says(refusal([](Character& c) { c.parts[0].triangles[7][1] = 9999; }), "triangle 7"));
  EXPECT_TRUE(says(refusal([](Character& c) { c.parts[0].triangles[7][1] = -1; }), "triangle 7"));
  EXPECT_TRUE(says(refusal([](Character& c) { c.parts[0].influences[3].weight = 0.5; }), "vertex 3"));
  EXPECT_TRUE(says(refusal([](Character& c) { c.parts[0].influences[3].joint = 2; }), "vertex 3"));
  EXPECT_TRUE(says(refusal([](Character& c) { c.parts[0].first.pop_back(); }), "influences"));
  EXPECT_TRUE(says(refusal([&](Character& c) { c.parts[0].joints[1].offset.origin.x() = nan; }), "'upper'"));
  EXPECT_TRUE(says(refusal([](Character& c) { c.parts[0].joints[1].node = 5; }), "node 5"));
  EXPECT_TRUE(says(refusal([](Character& c) { c.nodes[2].parent = 2; }), "'lower'"));
  EXPECT_TRUE(says(refusal([&](Character& c) { c.nodes[2].local.origin.x() = nan; }), "'lower'"));
  EXPECT_TRUE(
      says(refusal([&](Character& c) { c.animations[0].channels[0].rotations[1].value.w = nan; }), "key 1"));
  EXPECT_TRUE(
      says(refusal([](Character& c) { c.animations[0].channels[0].rotations[1].time = 0; }), "key 1"));
  EXPECT_TRUE(says(refusal([](Character& c) { c.animations[0].channels[0].node = 77; }), "node 77"));
  EXPECT_TRUE(says(refusal([](Character& c) {
                     c.parts[0].targets = {{"smile", {Vec3::Zero()}}};
                   }),
                   "'smile': has 1 displacements"));
  EXPECT_TRUE(says(refusal([](Character& c) {
                     c.animations[0].morphs = {{0, {Layered<1>{}}}};
                   }),
                   "morph targets"));
  EXPECT_TRUE(says(refusal([&](Character& c) {
                     c.animations[0].channels[0].angles.degrees.base.axis[1].keys = {{0, nan}};
                   }),
                   "key 0"));
}

TEST(Validate, HoldsToTheLimits) {
  CharacterLimits few;
  few.joints = 1;
  EXPECT_TRUE(says(refusal([](Character&) {}, few), "2 bones"));
  few = {};
  few.vertices = 100;
  EXPECT_TRUE(says(refusal([](Character&) {}, few), "vertices"));
  few = {};
  few.keys = 1;
  EXPECT_TRUE(says(refusal([](Character&) {}, few), "keys"));
}

}  // namespace
}  // namespace cscd::scenes
