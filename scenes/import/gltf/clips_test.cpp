#include "scenes/import/gltf/test_files.h"

// Keys are joined as their sampler says, and a clip lasts from its first key to its last.
namespace cscd::scenes::gltf {
namespace {

// Returns where the root stands in a file whose clip moves it by these numbers.
Vec3 root_at(double seconds, const std::vector<float>& times, const std::vector<float>& values,
             const std::string& interpolation) {
  TubeFile file;
  file.root["animations"][0]["channels"].clear();
  file.animate(0, "translation", times, file.accessor(values, "VEC3"), interpolation);
  const Character character = read(file);
  return pose_at(character, character.animations[0], seconds)[0].origin;
}

TEST(GltfClips, StepsLinesAndCubicsAreJoinedAsTheySay) {
  const std::vector<float> times = {1, 3}, values = {0, 0, 0, 8, 0, 0};
  EXPECT_EQ(root_at(2.9, times, values, "STEP").x(), 0);
  EXPECT_EQ(root_at(3, times, values, "STEP").x(), 8);
  EXPECT_NEAR(root_at(1.5, times, values, "LINEAR").x(), 2, 1e-6);
  // The order is arriving tangent, value, leaving tangent. Tangents are per second, and the
  // keys lie two seconds apart.
  const std::vector<float> cubic = {0, 0, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0, 8, 0, 0, 0, 0, 0};
  EXPECT_NEAR(root_at(2, times, cubic, "CUBICSPLINE").x(), 4 + 0.125 * 2 * 1 - 0.125 * 2 * 2, 1e-6);
  EXPECT_EQ(root_at(0, times, cubic, "CUBICSPLINE").x(), 0);
  EXPECT_EQ(root_at(4, times, cubic, "CUBICSPLINE").x(), 8);
}

TEST(GltfClips, CubicRotationsAreNormalised) {
  TubeFile file;
  const float h = file.half;
  file.root["animations"][0]["channels"].clear();
  file.animate(TubeFile::kUpper, "rotation", {0, 1},
               file.accessor(std::vector<float>{0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 2, 0,  //
                                                0, 0, 0, 0, 0, 0, h, h, 0, 0, 0, 0},
                             "VEC4"),
               "CUBICSPLINE");
  const Character character = read(file);
  const Transform upper = pose_at(character, character.animations[0], 0.5)[4];
  EXPECT_NEAR(upper.column[0].norm(), 1, 1e-6);
  // By hand: z = h / 2 + 2 / 8 and w = (1 + h) / 2.
  const double z = static_cast<double>(h) / 2 + 0.25, w = (1 + static_cast<double>(h)) / 2;
  EXPECT_NEAR(upper.column[0].x(), (w * w - z * z) / (w * w + z * z), 1e-6);
}

TEST(GltfClips, SeveralChannelsMoveOneNode) {
  TubeFile file;
  file.animate(TubeFile::kUpper, "translation", {0, 1},
               file.accessor(std::vector<float>{1, 0, 0, 1, 0, 3}, "VEC3"));
  file.animate(TubeFile::kUpper, "scale", {0, 1},
               file.accessor(std::vector<float>{1, 1, 1, -2, 1, 1}, "VEC3"));
  const Character character = read(file);
  ASSERT_EQ(character.animations[0].channels.size(), 1u);
  const Transform upper = pose_at(character, character.animations[0], 1)[4];
  EXPECT_LT((upper.origin - Vec3(2, 0, 8)).norm(), 1e-6);
  EXPECT_LT((upper.column[0] - Vec3(0, -2, 0)).norm(), 1e-6);
}

TEST(GltfClips, AClipLastsFromItsFirstKeyToItsLast) {
  TubeFile file;
  file.animate(2, "translation", {0.5, 2.5}, file.accessor(std::vector<float>(6, 0), "VEC3"));
  // A single key does not bear on the length.
  file.animate(3, "translation", {7}, file.accessor(std::vector<float>{1, 0, 0}, "VEC3"));
  file.root["animations"].push_back(file.root["animations"][0]);
  file.root["animations"][1]["channels"].erase(0);
  file.root["animations"][1].erase("name");
  const Character character = read(file);
  EXPECT_EQ(character.animations[0].start, 0);
  EXPECT_EQ(character.animations[0].seconds, 2.5);
  EXPECT_EQ(character.animations[1].name, "");
  EXPECT_EQ(character.animations[1].start, 0.5);
  EXPECT_EQ(character.animations[1].seconds, 2);
  EXPECT_EQ(character.animations[0].ticks_per_second, 1);
}

TEST(GltfClips, ChannelsThatMoveNothingKnownAreNotedAndOthersRead) {
  TubeFile file;
  json& clip = file.root["animations"][0];
  clip["channels"].push_back({{"sampler", 0}, {"target", {{"path", "rotation"}}}});
  clip["channels"].push_back(
      {{"sampler", 0},
       {"target",
        {{"path", "pointer"},
         {"extensions", {{"KHR_animation_pointer", {{"pointer", "/materials/0/x"}}}}}}}});
  clip["channels"].push_back({{"sampler", 0}, {"target", {{"node", 1}, {"path", "weights"}}}});
  clip["channels"].push_back(clip["channels"][0]);
  const Character character = read(file);
  EXPECT_TRUE(has_note(character, "'/materials/0/x' is ignored"));
  EXPECT_TRUE(has_note(character, "1 animation channels name no node"));
  EXPECT_TRUE(has_note(character, "without morph targets"));
  EXPECT_TRUE(has_note(character, "an earlier channel moves the same"));
  expect_same_motion(character, bending_tube());
}

// Mutation: such a key is left out, and another motion is shown.
TEST(GltfClips, KeysOutOfOrderAreRefused) {
  TubeFile file;
  const float h = file.half;
  file.root["animations"][0]["channels"].clear();
  file.animate(TubeFile::kUpper, "rotation", {0, 0, 1},
               file.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, h, h}, "VEC4"));
  const Character character = read(file);
  EXPECT_TRUE(has_note(character, "1 keys ignored that repeat the key before"));
  expect_same_motion(character, bending_tube());
  for (const std::vector<float>& times : {std::vector<float>{1, 0.5F, 0}, {0, 0, 0}, {0, 2, 1}, {0, 0, 1}}) {
    TubeFile still;
    still.root["animations"][0]["channels"].clear();
    still.animate(TubeFile::kUpper, "rotation", times,
                  still.accessor(std::vector<float>{0, 0, 0, 1, h, 0, 0, h, 0, 0, h, h}, "VEC4"));
    EXPECT_TRUE(says(refusal(still), "its key times do not rise: key "));
  }
  TubeFile resting;  // but a channel that keeps still loses nothing
  resting.animate(TubeFile::kUpper, "scale", {0, 0},
                  resting.accessor(std::vector<float>{1, 1, 1, 1, 1, 1}, "VEC3"));
  EXPECT_EQ(refusal(resting), "");
}

TEST(GltfClips, WhatDoesNotFitIsRefused) {
  expect_refusals(TubeFile(), "/animations/0",
                  {
                      {"/samplers/0/interpolation", "\"BEZIER\"", "'BEZIER' is unknown"},
                      {"/samplers/0/input", "1", "times: have a wrong type"},
                      {"/samplers/0/output", "0", "values: have a wrong type"},
                      {"/samplers/0/interpolation", "\"CUBICSPLINE\"", "2 values instead of 6"},
                      {"/channels/0/sampler", "3", "animation sampler 3 of 1"},
                      {"/channels/0/target/node", "30", "node 30"},
                      {"/channels/0/target/path", "\"color\"", "the unknown 'color'"},
                      {"/channels/0/target", "[]", "target is not an object"},
                  });
  TubeFile endless, missing;
  const float infinity = std::numeric_limits<float>::infinity();
  endless.animate(2, "translation", {0, infinity}, endless.accessor(std::vector<float>(6, 0), "VEC3"));
  EXPECT_TRUE(says(refusal(endless), "time is not finite"));
  missing.animate(2, "translation", {0, 1}, missing.accessor(std::vector<float>(6, infinity), "VEC3"));
  EXPECT_TRUE(says(refusal(missing), "is not finite"));
  TubeFile no_turn, no_number;
  no_turn.root["animations"][0]["samplers"][0]["output"] =
      no_turn.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 0}, "VEC4");
  EXPECT_TRUE(says(refusal(no_turn), "rotation is zero"));
  no_number.root["animations"][0]["samplers"][0]["output"] = no_number.accessor(
      std::vector<float>{0, 0, 0, 1, 0, 0, 0, std::numeric_limits<float>::quiet_NaN()}, "VEC4");
  EXPECT_TRUE(says(refusal(no_number), "not finite"));
}

}  // namespace
}  // namespace cscd::scenes::gltf
