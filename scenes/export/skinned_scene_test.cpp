#include "scenes/export/skinned_scene.h"

#include <algorithm>
#include <gtest/gtest.h>

#include "core/base/test_refusal.h"
#include "scenes/catalog/test_scenes.h"
#include "scenes/clip/digest.h"
#include "scenes/export/test_round_trip.h"

namespace cscd::scenes {
namespace {

// The frames of a scene, turned so that y points up, as it does in glTF.
Clip upright(const Scene& scene) {
  const Clip clip = generate(scene);
  const Transform turn = from_trs(Vec3::Zero(), turn_to_y(scene.up), Vec3::Ones());
  Clip out(clip.header());
  for (std::size_t f = 0; f < clip.frame_count(); ++f) {
    const FrameView frame = clip.frame(f);
    std::vector<Vec3> positions;
    for (const Vec3& x : frame.positions) positions.push_back(turn(x));
    out.append({positions, frame.bones});
  }
  return out;
}

// Mutation: the root is not turned; the octopus, the urchin, the man and the box have z up.
void expect_round_trip(const Scene& scene) {
  SCOPED_TRACE(scene.name);
  const Clip wanted = upright(scene);
  const Character character = skinned_scene(scene);
  const ReadBack back = read_back(to_glb(character));
  expect_same_frames(wanted, back.clip);
  EXPECT_EQ(back.clip.header().bone_parent.size(), wanted.header().bone_parent.size());
  ASSERT_EQ(back.report.clips.size(), 1u);
  EXPECT_EQ(back.report.clips[0].name, scene.name);
}

std::string refusal(const Scene& scene) {
  return test::refusal([&] { skinned_scene(scene); });
}

// Sets the scene's expected digest to that of its frames.
void promise(Scene& scene) {
  DigestSink sink;
  scene.expected.digest = run_scene(scene, [&](const ClipHeader&) -> FrameSink& { return sink; }).digest;
}

// A scene of the catalogue with a patch, and with the digest of the frames that result.
Scene changed(const std::string& base, const std::string& patch) {
  Scene scene = parse_scene(base,
                            R"({"schema": "cscd.scene/1", "base": ")" + base +
                                R"(", "story": "For a test.", "patch": [)" + patch +
                                R"(], "expected": {"digest": "none yet"}})",
                            "test");
  promise(scene);
  return scene;
}

TEST(SkinnedScene, ASmallChainIsReadBackAsItWas) {
  expect_round_trip(parse_scene("small", small_scene_with_digest(), "small.json"));
}

// A reader that knows nodes by name would let the keys of the bone move the surface's node. Mutation: the
// node of the surface keeps the scene's name.
TEST(SkinnedScene, ASceneMayBeCalledLikeABone) {
  Scene scene = parse_scene("bone_2", small_scene_with_digest(), "small.json");
  EXPECT_EQ(skinned_scene(scene).nodes[0].name, "bone_2_surface");
  expect_round_trip(scene);
}

// Every scene that ends in linear skinning is read back as it was. All others are refused, and the error
// names the effect that is in the way.
TEST(SkinnedScene, EverySceneOfTheCatalogueIsReadBackOrRefused) {
  std::vector<std::string> written;
  for (const std::string& name : tracked_scenes()) {
    const Scene scene = load_scene(name);
    const std::string& last = scene.effects.back().name;
    if (last == "skinning_linear") {
      expect_round_trip(scene);
      written.push_back(scene.name);
    } else {
      EXPECT_NE(refusal(scene).find("scene " + scene.name + ": its last effect is " + last),
                std::string::npos);
    }
  }
  EXPECT_EQ(written, (std::vector<std::string>{"octopus", "rope", "urchin"}));
}

// Bodies with limbs, with linear skinning instead of their own: the bones form a tree, and up
// to four blend at a vertex.
TEST(SkinnedScene, TreesOfBonesAreReadBackAsTheyWere) {
  const std::string frames = R"({"op": "replace", "path": "/frames", "value": 41})";
  expect_round_trip(changed(
      "man", frames + R"(, {"op": "replace", "path": "/effects/3", "value": {"name": "skinning_linear"}})"));
  expect_round_trip(changed(
      "box", frames + R"(, {"op": "replace", "path": "/effects/3", "value": {"name": "skinning_linear"}})"));
}

TEST(SkinnedScene, ClothWithoutBonesIsRefused) {
  const Scene scene = changed("man", R"({"op": "replace", "path": "/frames", "value": 2},
      {"op": "replace", "path": "/effects", "value": [{"name": "skinning_linear"}]},
      {"op": "replace", "path": "/shape/name", "value": "skirted_limbed_sphere"},
      {"op": "add", "path": "/shape/skirts", "value": [{"points": 3, "aspect": 1, "edge": 2, "first_row": 20,
        "last_row": 40, "band_rows": 1, "apex": [0, 0, 130]}]})");
  EXPECT_NE(refusal(scene).find("its cloth has no bones"), std::string::npos);
}

// With far too few substeps, the bones of a chain do not stay rigid.
TEST(SkinnedScene, BonesThatStretchAreRefused) {
  EXPECT_NE(refusal(changed("rope", R"({"op": "replace", "path": "/frames", "value": 4},
      {"op": "remove", "path": "/effects/1"}, {"op": "remove", "path": "/effects/0/steady_bone"},
      {"op": "replace", "path": "/substeps", "value": 4},
      {"op": "replace", "path": "/shape/bones", "value": 400},
      {"op": "replace", "path": "/expected/bones", "value": 400})"))
                .find("is stretched or sheared"),
            std::string::npos);
}

TEST(SkinnedScene, WhatIsNotLinearOrNotAsPromisedIsRefused) {
  Scene scene = parse_scene("small", small_scene_with_digest(), "small.json");
  EXPECT_EQ(refusal(scene), "");
  Scene other = scene;
  other.expected.digest = "0000000000000000";
  EXPECT_NE(refusal(other).find("the scene file expects 0000000000000000"), std::string::npos);
  other = scene;
  other.effects.pop_back();  // the surface stays at rest while the bones move
  EXPECT_NE(refusal(other).find("its last effect is chain_dynamics"), std::string::npos);
  other = scene;
  std::reverse(other.effects.begin(), other.effects.end());
  EXPECT_NE(refusal(other).find("export it as .h5"), std::string::npos);
  other = scene;
  other.effects.clear();
  EXPECT_NE(refusal(other).find("its last effect is none"), std::string::npos);
  other = scene;
  other.frames = 100'000'000;
  EXPECT_NE(refusal(other).find("100000000 frames of 4 bones are more keys"), std::string::npos);
}

}  // namespace
}  // namespace cscd::scenes
