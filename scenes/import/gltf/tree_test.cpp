#include "scenes/import/gltf/test_files.h"

// Nodes are identified by their numbers, and only the nodes of the scene are shown.
namespace cscd::scenes::gltf {
namespace {

TEST(GltfTree, EqualNamesDoNoHarm) {
  TubeFile file;
  for (json& node : file.root["nodes"]) node["name"] = "upper";
  expect_same_motion(read(file), bending_tube());
}

TEST(GltfTree, TheDefaultSceneIsShownElseTheFirstElseAll) {
  TubeFile file;
  file.root["nodes"].push_back({{"mesh", 0}});
  EXPECT_EQ(read(file).parts.size(), 1u);
  file.root["scenes"].push_back({{"nodes", {5}}});
  file.root["scene"] = 1;
  EXPECT_TRUE(read(file).parts[0].joints.empty());
  file.root.erase("scene");
  EXPECT_FALSE(read(file).parts[0].joints.empty());
  file.root.erase("scenes");
  EXPECT_EQ(read(file).parts.size(), 2u);
}

TEST(GltfTree, JointsOutsideTheScenePose) {
  TubeFile file;
  // Only the mesh's node is in the scene; the joints stand under the old root.
  file.root["nodes"][0]["children"] = {2};
  file.root["scenes"][0]["nodes"] = {1};
  expect_same_motion(read(file), bending_tube());
}

TEST(GltfTree, SeveralRootsGetOneAbove) {
  TubeFile file;
  file.root["nodes"].push_back({{"name", "lamp"}});
  const Character character = read(file);
  EXPECT_EQ(character.nodes.size(), 7u);
  EXPECT_EQ(character.nodes[1].parent, 0);
  EXPECT_EQ(character.nodes[6].parent, 0);
  expect_same_motion(character, bending_tube());
}

TEST(GltfTree, MatricesAreTakenAsTheyAre) {
  TubeFile file;
  // A shear, which no scale and rotation gives.
  file.root["nodes"][0] = {{"matrix", {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1}},
                           {"children", {1, 2}}};
  Character wanted = bending_tube();
  wanted.nodes[0].local.column[1] = Vec3(0.5, 1, 0);
  expect_same_motion(read(file), wanted);
  file.root["nodes"][0]["matrix"][3] = 0.5;
  EXPECT_TRUE(says(refusal(file), "last row"));
  file.root["nodes"][0]["matrix"].push_back(1);
  EXPECT_TRUE(says(refusal(file), "a list of 16 numbers"));
}

// The joint that turns mirrors along x and stretches along y. Only its rotation is animated, so its scale
// must stay as the file writes it.
TEST(GltfTree, MirroredAndUnevenScalesStayAsWritten) {
  TubeFile file;
  file.root["nodes"][4]["scale"] = {-1, 2, 1};
  Character wanted = bending_tube();
  wanted.nodes[4].written = ScaleTurnMove{Vec3(1, 0, 0), Quaternion(), Vec3(-1, 2, 1)};
  wanted.nodes[4].local = from_trs(Vec3(1, 0, 0), Quaternion(), Vec3(-1, 2, 1));
  const Character got = read(file);
  expect_same_motion(got, wanted);
  EXPECT_LT(pose_at(got, got.animations[0], 0.7)[4].determinant(), 0);
}

TEST(GltfTree, RotationsNeedADirectionButNoLength) {
  TubeFile file;
  file.root["nodes"][0]["rotation"] = {0, 0, 0, 3};
  expect_same_motion(read(file), bending_tube());
  for (const double x : {0.0, 1e200}) {
    file.root["nodes"][0]["rotation"] = {x, 0, 0, 0};
    EXPECT_TRUE(says(refusal(file), "node 'root' of the glTF file: a rotation is zero or not finite"));
  }
}

TEST(GltfTree, WhatIsNoTreeIsRefused) {
  TubeFile two_parents, loop, no_root, nothing;
  two_parents.root["nodes"][1]["children"] = {2};
  EXPECT_TRUE(says(refusal(two_parents), "child of two nodes"));
  loop.root["nodes"][2]["children"] = {4};
  loop.root["nodes"][4]["children"] = {3};
  loop.root["nodes"][3]["children"] = json::array();
  loop.root["nodes"].push_back({{"children", {6}}});
  loop.root["nodes"].push_back({{"children", {5}}});
  EXPECT_TRUE(says(refusal(loop), "hang below themselves"));
  no_root.root["scenes"][0]["nodes"] = {1};
  EXPECT_TRUE(says(refusal(no_root), "scene names node 1"));
  nothing.root["nodes"] = json::array();
  EXPECT_TRUE(says(refusal(nothing), "has no nodes"));
}

TEST(GltfTree, DeepTreesAreRead) {
  TubeFile file;
  json& nodes = file.root["nodes"];
  for (int n = 5; n < 50'000; ++n) nodes.push_back({{"children", {n + 1}}});
  nodes.push_back(json::object());
  nodes[4]["children"] = {5};
  EXPECT_EQ(read(file).nodes.size(), 50'001u);
}

}  // namespace
}  // namespace cscd::scenes::gltf
