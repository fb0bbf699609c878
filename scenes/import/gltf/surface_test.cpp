#include <set>

#include "scenes/import/gltf/test_files.h"

// Checks what the reader makes of a file's meshes and skins.
namespace cscd::scenes::gltf {
namespace {

std::multiset<std::array<std::int32_t, 3>> turned_to_smallest(
    const std::vector<std::array<std::int32_t, 3>>& triangles) {
  std::multiset<std::array<std::int32_t, 3>> out;
  for (std::array<std::int32_t, 3> t : triangles) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    out.insert(t);
  }
  return out;
}

// A square of four corners, which must have the same orientation whether it is a strip or a fan.
TestFile square(int mode, const std::vector<std::uint8_t>& corners) {
  TestFile file;
  const int positions = file.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
  file.root["meshes"] = {{{"primitives",
                           {{{"attributes", {{"POSITION", positions}}},
                             {"mode", mode},
                             {"indices", file.accessor(corners, "SCALAR")}}}}}};
  file.root["nodes"] = {{{"mesh", 0}}};
  return file;
}

TEST(GltfSurfaces, StripsAndFansAreTakenApart) {
  const std::multiset<std::array<std::int32_t, 3>> strip{{0, 1, 3}, {1, 2, 3}}, fan{{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(turned_to_smallest(read(square(5, {0, 1, 3, 2})).parts[0].triangles), strip);
  EXPECT_EQ(turned_to_smallest(read(square(6, {0, 1, 2, 3})).parts[0].triangles), fan);
  EXPECT_EQ(turned_to_smallest(read(square(4, {0, 1, 2, 2, 3, 0})).parts[0].triangles), fan);
  EXPECT_TRUE(has_note(read(square(4, {0, 1, 2, 3})), "1 corners left over"));
  EXPECT_TRUE(says(refusal(square(7, {0, 1, 2})), "mode 7"));
  EXPECT_TRUE(says(refusal(square(4, {0, 1, 9})), "vertex 9 of 4"));
}

TEST(GltfSurfaces, PointsAndLinesAreLeftOutWithANote) {
  TubeFile file;
  json points = file.primitive();
  points["mode"] = 0;
  file.root["meshes"][0]["primitives"].push_back(points);
  const Character character = read(file);
  EXPECT_EQ(character.parts.size(), 1u);
  EXPECT_TRUE(has_note(character, "1 primitives of points and lines"));
}

TEST(GltfSurfaces, MirroredNodesTurnTrianglesRound) {
  TestFile file = square(4, {0, 1, 2, 0, 2, 3});
  file.root["nodes"][0]["scale"] = {-1, 1, 1};
  const std::multiset<std::array<std::int32_t, 3>> other_way{{0, 2, 1}, {0, 3, 2}};
  EXPECT_EQ(turned_to_smallest(read(file).parts[0].triangles), other_way);
}

TEST(GltfSurfaces, FurtherSetsOfJointsAndWeightsCount) {
  TubeFile file;
  std::vector<float> first = file.numbers.weights, second(first.size(), 0);
  std::vector<std::uint8_t> joints(first.size(), 0);
  // Move the weights of the second joint to the second set.
  for (std::size_t i = 0; i < first.size(); ++i)
    if (file.numbers.joints[i] == 1) {
      second[i / 4 * 4] = std::exchange(first[i], 0.f);
      joints[i / 4 * 4] = 1;
    }
  json& attributes = file.primitive()["attributes"];
  attributes["WEIGHTS_0"] = file.accessor(first, "VEC4");
  attributes["WEIGHTS_1"] = file.accessor(second, "VEC4");
  EXPECT_TRUE(says(refusal(file), "JOINTS_1 and WEIGHTS_1"));
  attributes["JOINTS_1"] = file.accessor(joints, "VEC4");
  expect_same_motion(read(file), bending_tube());
}

TEST(GltfSurfaces, WeightsAreMadeToSumToOne) {
  TubeFile file;
  std::vector<float> doubled;
  for (const float w : file.numbers.weights) doubled.push_back(2 * w);
  file.primitive()["attributes"]["WEIGHTS_0"] = file.accessor(doubled, "VEC4");
  expect_same_motion(read(file), bending_tube());
  doubled[1] = -0.5f;
  file.primitive()["attributes"]["WEIGHTS_0"] = file.accessor(doubled, "VEC4");
  EXPECT_TRUE(has_note(read(file), "1 negative weights"));
  doubled[1] = std::numeric_limits<float>::quiet_NaN();
  file.primitive()["attributes"]["WEIGHTS_0"] = file.accessor(doubled, "VEC4");
  EXPECT_TRUE(says(refusal(file), "a weight is not finite"));
}

// Without inverse bind matrices, the vertices are in the coordinates of the joints.
TEST(GltfSurfaces, SkinsWithoutBindMatricesHaveIdentities) {
  TubeFile file;
  file.root["skins"][0].erase("inverseBindMatrices");
  Character wanted = bending_tube();
  for (Joint& joint : wanted.parts[0].joints) joint.offset = Transform();
  expect_same_motion(read(file), wanted);
}

TEST(GltfSurfaces, OneMeshMayFollowTwoSkins) {
  TubeFile file;
  file.root["nodes"].push_back({{"name", "lower"}, {"translation", {0, 10, 0}}, {"children", {6}}});
  file.root["nodes"].push_back({{"name", "upper"}, {"translation", {2, 0, 0}}});
  file.root["nodes"].push_back({{"name", "tube"}, {"mesh", 0}, {"skin", 1}});
  file.root["scenes"][0]["nodes"] = {0, 5, 7};
  file.root["skins"].push_back({{"joints", {5, 6}}, {"inverseBindMatrices", TubeFile::kOffsets}});
  const Character character = read(file);
  ASSERT_EQ(character.parts.size(), 2u);
  const std::size_t count = character.parts[0].positions.size();
  std::vector<Vec3> moving = positions_at(bending_tube(), 1), still;
  for (const Vec3& x : file.character.parts[0].positions) still.push_back(x + Vec3(0, 10, 0));
  const std::vector<Vec3> all = positions_at(character, 1);
  expect_same({all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count)}, moving, 1e-6);
  expect_same({all.begin() + static_cast<std::ptrdiff_t>(count), all.end()}, still, 1e-6);
}

TEST(GltfSurfaces, VerticesWithoutWeightsFollowTheirNode) {
  TubeFile file;
  file.root["nodes"].push_back({{"mesh", 0}});
  file.root["nodes"][4]["children"] = {5};
  const Character character = read(file);
  ASSERT_EQ(character.parts.size(), 2u);
  EXPECT_TRUE(character.parts[1].joints.empty());
  const std::size_t count = character.parts[0].positions.size();
  const Transform upper = pose_at(bending_tube(), bending_tube().animations[0], 1)[4];
  EXPECT_LT((positions_at(character, 1)[count] - upper(bending_tube().parts[0].positions[0])).norm(), 1e-6);
}

// The first target moves every vertex by (0, 0, 1) at full weight; the second target moves no vertex.
TubeFile with_targets() {
  TubeFile file;
  std::vector<float> up;
  for (std::size_t i = 0; i < file.numbers.positions.size(); ++i) up.push_back(i % 3 == 2 ? 1 : 0);
  const int displacements = file.accessor(up, "VEC3");
  file.primitive()["targets"] = {{{"POSITION", displacements}}, {{"NORMAL", displacements}}};
  return file;
}

double raised_by(const Character& character, double seconds) {
  const double raised =
      positions_at(character, seconds)[0].z() - positions_at(bending_tube(), seconds)[0].z();
  return raised;
}

TEST(GltfSurfaces, MorphTargetsHaveTheWeightsOfMeshOrNode) {
  TubeFile file = with_targets();
  EXPECT_NEAR(raised_by(read(file), 0), 0, 1e-6);
  file.root["meshes"][0]["weights"] = {0.25, 0.5};
  file.root["meshes"][0]["extras"]["targetNames"] = {"up", "shine"};
  EXPECT_NEAR(raised_by(read(file), 0), 0.25, 1e-6);
  EXPECT_EQ(read(file).parts[0].targets[1].name, "shine");
  file.root["nodes"][1]["weights"] = {0.75, 0};
  EXPECT_NEAR(raised_by(read(file), 0), 0.75, 1e-6);
  file.root["nodes"][1]["weights"] = {0.75};
  EXPECT_TRUE(says(refusal(file), "1 weights for 2 morph targets"));
}

TEST(GltfSurfaces, MorphTargetsMayBeQuantizedAndSparse) {
  TubeFile file = with_targets();
  file.root["meshes"][0]["weights"] = {1, 0};
  const std::vector<std::uint8_t> where = {0};
  const std::vector<std::int8_t> up = {0, 0, 127};
  file.root["accessors"].push_back(
      {{"componentType", 5120},
       {"normalized", true},
       {"count", file.character.parts[0].positions.size()},
       {"type", "VEC3"},
       {"sparse",
        {{"count", 1},
         {"indices", {{"bufferView", file.view(where)}, {"componentType", 5121}}},
         {"values", {{"bufferView", file.view(up)}}}}}});
  const auto last = file.root["accessors"].size() - 1;
  file.primitive()["targets"][0]["POSITION"] = last;
  const Character character = read(file);
  EXPECT_NEAR(raised_by(character, 0), 1, 1e-6);
  EXPECT_EQ(character.parts[0].targets[0].displacements[1], Vec3::Zero().eval());
  file.root["accessors"][last]["count"] = 3;
  EXPECT_TRUE(says(refusal(file), "3 displacements for"));
}

TEST(GltfSurfaces, WeightsOfMorphTargetsMayBeAnimated) {
  TubeFile file = with_targets();
  file.animate(1, "weights", {0, 1}, file.accessor(std::vector<float>{0, 0, 1, 0}, "SCALAR"));
  EXPECT_NEAR(raised_by(read(file), 0.5), 0.5, 1e-6);
  // The order is arriving tangents, values and leaving tangents of both targets, key by key.
  TubeFile cubic = with_targets();
  cubic.animate(1, "weights", {0, 2},
                cubic.accessor(std::vector<float>{0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, "SCALAR"),
                "CUBICSPLINE");
  // Half-way through two seconds, the leaving slope of 1 adds 2 (1/8 - 2/4 + 1/2).
  EXPECT_NEAR(raised_by(read(cubic), 1), 0.25, 1e-6);
  // Two values for two keys are too few for two targets.
  TubeFile few = with_targets();
  few.animate(1, "weights", {0, 1}, few.accessor(std::vector<float>{0, 1}, "SCALAR"));
  EXPECT_TRUE(says(refusal(few), "has 2 values instead of 4"));
}

TEST(GltfSurfaces, LimitsHoldBeforeAnythingIsRead) {
  CharacterLimits few;
  few.vertices = 10;
  EXPECT_TRUE(says(refusal(TubeFile(), few), "more than the 10"));
  few = {};
  few.displacements = 10;
  EXPECT_TRUE(says(refusal(with_targets(), few), "displacements"));
  few = {};
  few.keys = 1;
  EXPECT_TRUE(says(refusal(TubeFile(), few), "more than the 1"));
  few = {};
  few.parts = 0;
  EXPECT_TRUE(says(refusal(TubeFile(), few), "meshes"));
}

}  // namespace
}  // namespace cscd::scenes::gltf
