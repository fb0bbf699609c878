#include <cmath>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/test_refusal.h"
#include "scenes/base/test_says.h"
#include "scenes/character/pose.h"

namespace cscd::scenes {
namespace {

// One vertex at (1, 2, 3) that three bones move by the given maps, with the weights 0.5, 0.3 and 0.2.
Character three_bones(const std::array<Transform, 3>& maps, double share = 1) {
  Character character;
  character.nodes = {{"root", -1, {}}};
  Part part{"skin", 0, {Vec3(1, 2, 3)}, {}, {}, {0, 3}, {{0, 0.5}, {1, 0.3}, {2, 0.2}}};
  for (int k = 0; k < 3; ++k) {
    character.nodes.push_back({"bone" + std::to_string(k), 0, maps[static_cast<std::size_t>(k)]});
    part.joints.push_back({k + 1, {}});
  }
  part.dual_quaternion = {share};
  character.parts = {part};
  return character;
}

Vec3 moved(const Character& character) {
  validate(character, {});
  std::vector<Vec3> out;
  skin(character, rest_pose(character), out);
  return out.at(0);
}

Transform about_x(double degrees, const Vec3& scale = Vec3::Ones(), const Vec3& move = Vec3::Zero()) {
  return from_trs(move, from_euler({degrees, 0, 0}, {0, 1, 2}), scale);
}

// Rotations about one axis by a, b and c blend to the rotation by the angle of the mean of their unit vectors
// at half the angles.
TEST(DualSkin, TwistedBonesKeepTheDistanceFromTheirAxis) {
  const double angle[3] = {20, 110, -60}, weight[3] = {0.5, 0.3, 0.2};
  const Vec3 was = moved(three_bones({about_x(angle[0]), about_x(angle[1]), about_x(angle[2])}));
  double c = 0, s = 0;
  for (int k = 0; k < 3; ++k) {
    c += weight[k] * std::cos(angle[k] * M_PI / 360);
    s += weight[k] * std::sin(angle[k] * M_PI / 360);
  }
  const double blended = 2 * std::atan2(s, c);
  EXPECT_NEAR(was.x(), 1, 1e-9);
  EXPECT_NEAR(was.y(), 2 * std::cos(blended) - 3 * std::sin(blended), 1e-9);
  EXPECT_NEAR(was.z(), 2 * std::sin(blended) + 3 * std::cos(blended), 1e-9);
}

// A quaternion and its negative are the same rotation: turns that pass 180 degrees go on without a jump.
TEST(DualSkin, BonesBeyondHalfATurnStayTogether) {
  for (const double angle : {170.0, 179.9, 180.1, 190.0, 359.0, 361.0}) {
    const Vec3 was = moved(three_bones({about_x(angle), about_x(angle + 2), about_x(angle - 3)}));
    EXPECT_LT((was - about_x(angle)(Vec3(1, 2, 3))).norm(), 0.05) << angle;
  }
}

TEST(DualSkin, MovesAndScalesAreAveraged) {
  const Vec3 was = moved(three_bones({about_x(40, {1, 2, 3}, {1, 0, 0}), about_x(40, {2, 1, 1}, {0, 10, 0}),
                                      about_x(40, {4, 4, 4}, {0, 0, 5})}));
  const Vec3 scale(0.5 * 1 + 0.3 * 2 + 0.2 * 4, 0.5 * 2 + 0.3 + 0.8, 1.5 + 0.3 + 0.8);
  EXPECT_LT((was - about_x(40, scale, {0.5, 3, 1})(Vec3(1, 2, 3))).norm(), 1e-12);
}

TEST(DualSkin, AShareGoesPartOfTheWayFromLinearSkinning) {
  const std::array<Transform, 3> maps = {about_x(20), about_x(110), about_x(-60)};
  const Vec3 linear = moved(three_bones(maps, 0)), dual = moved(three_bones(maps, 1));
  EXPECT_GT((linear - dual).norm(), 0.1);
  EXPECT_LT((moved(three_bones(maps, 0.25)) - 0.75 * linear - 0.25 * dual).norm(), 1e-12);
  const Vec3 x(1, 2, 3);
  EXPECT_LT((linear - (0.5 * maps[0](x) + 0.3 * maps[1](x) + 0.2 * maps[2](x))).norm(), 1e-12);
}

// A mirrored mesh mirrors by way of each of its bones.
TEST(DualSkin, AMirrorThatAllBonesShareIsKept) {
  const Vec3 mirror(-1, 1, 1);
  const Vec3 was = moved(three_bones({about_x(30, mirror), about_x(30, mirror), about_x(30, mirror)}));
  EXPECT_LT((was - about_x(30, mirror)(Vec3(1, 2, 3))).norm(), 1e-12);
}

std::string refusal(const Transform& second) {
  return test::refusal([&] { moved(three_bones({about_x(0), second, about_x(10)})); });
}

TEST(DualSkin, RefusesWhatHasNoMeaning) {
  Transform sheared;
  sheared.column[1].x() = 0.01;
  EXPECT_TRUE(says(refusal(sheared), "mesh 'skin', bone 'bone1': is sheared in some pose"));
  sheared.column[1].x() = 1e-6;
  EXPECT_EQ(refusal(sheared), "") << "single precision";
  EXPECT_TRUE(says(refusal(about_x(0, {1, 0, 1})), "'bone1': is scaled to nothing"));
  EXPECT_TRUE(says(refusal(about_x(0, {1, -1, 1})), "mirrors unlike another bone"));
  Character shares = three_bones({});
  shares.parts[0].dual_quaternion = {1.5};
  EXPECT_THROW(validate(shares, {}), InputError);
}

}  // namespace
}  // namespace cscd::scenes
