#include <filesystem>
#include <gtest/gtest.h>

#include "core/base/test_folder.h"
#include "scenes/character/pose.h"
#include "scenes/character/test_characters.h"
#include "scenes/character/test_gltf.h"
#include "scenes/import/read_model.h"

// Writes characters as glTF and reads them back: what the file says must arrive.
namespace cscd::scenes {
namespace {

Character read_back(const Character& character) {
  const test::Folder folder;
  test::write(folder / "a.gltf", to_gltf(character));
  return read_model(folder / "a.gltf", {});
}

// Compares the vertices at three times of every clip, in their order.
void expect_same_motion(const Character& wanted, const Character& got) {
  ASSERT_EQ(got.animations.size(), wanted.animations.size());
  for (std::size_t a = 0; a < wanted.animations.size(); ++a)
    for (const double share : {0.0, 0.3, 1.0}) {
      const Animation &want = wanted.animations[a], &have = got.animations[a];
      std::vector<Vec3> expected, found;
      skin(wanted, pose_at(wanted, want, want.start + share * want.seconds), expected);
      skin(got, pose_at(got, have, have.start + share * have.seconds), found);
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t v = 0; v < found.size(); ++v)
        ASSERT_LT((found[v] - expected[v]).norm(), 1e-5)
            << "clip " << a << " at " << share << ", vertex " << v;
    }
}

TEST(Gltf, MovesAsItIsWritten) {
  expect_same_motion(bending_tube(), read_back(bending_tube()));
}

// A tube with eight joints that are children of one node, a ninth joint that moves nothing, and eight
// influences a vertex.
Character crowd() {
  Character tube = bending_tube();
  tube.nodes.resize(2);
  Part& part = tube.parts[0];
  part.joints.clear();
  part.influences.clear();
  tube.animations[0].channels.clear();
  for (int j = 0; j < 9; ++j) {
    const Vec3 where(0.5 * j, 0, 0);
    const int node = static_cast<int>(tube.nodes.size());
    tube.nodes.push_back({"joint " + std::to_string(j), 0, moved_by(where)});
    part.joints.push_back({node, moved_by(-where)});
    tube.animations[0].channels.push_back(
        {node, {{0, where}, {1, where + Vec3(0, 0.1 * j * j, 0.3)}}, {}, {}});
  }
  part.first.assign(1, 0);
  for (std::size_t v = 0; v < part.positions.size(); ++v) {
    for (int j = 0; j < 8; ++j) part.influences.push_back({j, (1 + (static_cast<double>(v % 3) + j) / 8)});
    double sum = 0;
    for (std::size_t i = part.first.back(); i < part.influences.size(); ++i) sum += part.influences[i].weight;
    for (std::size_t i = part.first.back(); i < part.influences.size(); ++i) part.influences[i].weight /= sum;
    part.first.push_back(part.influences.size());
  }
  return tube;
}

TEST(Gltf, EightInfluencesAndFlatJointListsArrive) {
  const Character back = read_back(crowd());
  EXPECT_EQ(back.parts[0].first[1], 8u);
  expect_same_motion(crowd(), back);
}

TEST(Gltf, ClipsWithoutNamesAndClipsOfSomeBonesArrive) {
  Character tube = bending_tube();
  tube.animations.push_back(tube.animations[0]);
  tube.animations[1].name = "";
  tube.animations[1].start = 2;
  for (Key<Quaternion>& key : tube.animations[1].channels[0].rotations) key.time += 2;
  const Character back = read_back(tube);
  EXPECT_EQ(back.animations[1].name, "");
  EXPECT_EQ(back.animations[1].channels.size(), 1u);
  EXPECT_EQ(back.animations[1].ticks_per_second, 1);
  EXPECT_NEAR(back.animations[1].start, 2, 1e-6);
  EXPECT_NEAR(back.animations[1].seconds, 1, 1e-6);
  expect_same_motion(tube, back);
}

// A second mesh has no skin and hangs on the joint that turns. Some vertices of the first mesh have zero
// weights only, and follow the node of their mesh.
TEST(Gltf, WhatHasNoWeightsFollowsItsNode) {
  Character tube = bending_tube();
  Part hat = tube.parts[0];
  hat.name = "hat";
  hat.node = 4;
  hat.joints.clear();
  hat.influences.clear();
  hat.first.assign(hat.positions.size() + 1, 0);
  tube.parts.push_back(hat);
  Part& body = tube.parts[0];
  body.influences.resize(body.first[body.positions.size() - 3]);
  for (std::size_t v = body.positions.size() - 3; v <= body.positions.size(); ++v)
    body.first[v] = body.influences.size();
  const Character back = read_back(tube);
  ASSERT_EQ(back.parts.size(), 2u);
  expect_same_motion(tube, back);
}

// The joints of a skinned mesh say where it is; its own node does not.
TEST(Gltf, SkinnedMeshesIgnoreTheirNode) {
  Character tube = bending_tube();
  const Character straight = tube;
  tube.nodes[1].local = quarter_turn({7, 8, 9});
  expect_same_motion(straight, read_back(tube));
}

}  // namespace
}  // namespace cscd::scenes
