#include "scenes/catalog/scene.h"

#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/test_folder.h"
#include "core/base/test_refusal.h"
#include "scenes/catalog/scene_cache.h"
#include "scenes/catalog/shapes.h"
#include "scenes/catalog/test_scenes.h"
#include "scenes/clip/digest.h"

namespace cscd::scenes {
namespace {

namespace fs = std::filesystem;

std::string refusal(const std::string& from, const std::string& to) {
  std::string text = kSmallScene;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  return test::refusal([&] { generate(parse_scene("small", text, "small.json")); });
}

TEST(SceneFile, SaysWhatTheSceneIs) {
  const Scene scene = parse_scene("small", kSmallScene, "small.json");
  EXPECT_EQ(scene.name, "small");
  EXPECT_EQ(scene.shape, "tube");
  EXPECT_EQ(scene.shape_parameters.number("length"), 20);
  EXPECT_EQ(scene.frames, 6u);
  EXPECT_EQ(scene.substeps, 4);
  ASSERT_EQ(scene.effects.size(), 2u);
  EXPECT_EQ(scene.effects[0].name, "chain_dynamics");
  EXPECT_EQ(scene.effects[0].parameters.vector("gravity"), Vec3(0, 0, -1));
  EXPECT_EQ(scene.effects[0].parameters.table("first_end")[1][3], 2);
  EXPECT_EQ(scene.expected.vertices, 82u);
}

// Nothing that is computed depends on it, so a cache stays valid.
TEST(SceneFile, MaySayWhichAxisPointsUp) {
  std::string text = kSmallScene;
  text.insert(text.find("\"frames\""), "\"up\": \"-y\", ");
  const Scene turned = parse_scene("small", text, "small.json"),
              plain = parse_scene("small", kSmallScene, "small.json");
  EXPECT_EQ(turned.up, "-y");
  EXPECT_EQ(plain.up, "");
  EXPECT_EQ(turned.recipe, plain.recipe);
}

TEST(SceneFile, IsRefusedWithThePlaceOfTheMistake) {
  EXPECT_EQ(refusal("\"frames\"", "\"up\": \"w\", \"frames\""),
            "small.json: up must be one of x, y, z, -x, -y, -z");
  EXPECT_EQ(refusal("\"frames\"", "\"up\": 2, \"frames\""), "small.json: up must be a text");
  EXPECT_TRUE(says(refusal("{", ""), "small.json: is not JSON"));
  EXPECT_EQ(refusal("cscd.scene/1", "cscd.scene/9"), "small.json: schema must be cscd.scene/1");
  EXPECT_EQ(refusal("\"story\"", "\"tale\""), "small.json: tale is unknown; remove it");
  EXPECT_EQ(refusal("\"schema\"", "\"kind\""),
            "small.json: names no schema, so it is no scene file; cscd list scene-file says what one holds");
  EXPECT_EQ(refusal("\"frames\": 6", "\"frames\": 1"),
            "small.json: frames must be a whole number from 2 to 100000000");
  EXPECT_EQ(refusal("\"frames\": 6,", ""), "small.json: frames is missing; add it");
  EXPECT_EQ(refusal("\"name\": \"tube\"", "\"name\": \"pot\""),
            "small.json, shape pot: unknown shape pot; known are: tube, box, limbed_sphere, "
            "skirted_limbed_sphere, sheet, ball");
  EXPECT_EQ(refusal("\"rings\"", "\"rigns\"").substr(0, 61),
            "small.json, shape tube: parameter rigns is unknown; known are");
  EXPECT_EQ(refusal("\"rings\": 10", "\"rings\": true"),
            "small.json, shape tube: parameter rings must be a finite number");
  EXPECT_EQ(refusal("\"rings\": 10", "\"rings\": true, \"zings\": null").substr(0, 61),
            "small.json, shape tube: parameter zings is unknown; known are")
      << "a misspelt name before any value";
  EXPECT_EQ(refusal("skinning_linear", "skinning").substr(0, 49),
            "small.json, effect skinning: unknown effect; know");
  EXPECT_EQ(refusal("\"drag\": 0.5, ", ""),
            "small.json, effect chain_dynamics: parameter drag is missing (share of the velocity that is "
            "lost); add it to the scene file");
  EXPECT_EQ(refusal("\"vertices\": 82", "\"vertices\": 83"),
            "scene small: the shape has 82 vertices, the scene file expects 83; correct one of them");
  EXPECT_TRUE(
      says(refusal("[0, 0, 0, 0]", "[0, 0, 0, \"x\"]"), "parameter first_end must be a list of lists"));
}

TEST(Scene, WithContactResponseHasPredictionsInItsFramesAndItsDigest) {
  std::string text = kSmallScene;
  const std::string skinning = "{\"name\": \"skinning_linear\"}";
  text.replace(text.find(skinning), skinning.size(), skinning + ", {\"name\": \"contact_response\"}");
  const Scene scene = parse_scene("small", text, "small.json");
  std::optional<Clip> clip;
  const Generated generated =
      run_scene(scene, [&](ClipHeader header) -> FrameSink& { return clip.emplace(std::move(header)); });
  ASSERT_TRUE(clip->header().predicted);
  EXPECT_EQ(generated.effects[2].evaluations, 5u);
  DigestSink digest;
  copy_frames(*clip, digest);
  EXPECT_EQ(digest.text(), generated.digest);
  for (std::size_t i = 0; i < 5; ++i)  // no contact occurs here
    EXPECT_TRUE(std::ranges::equal(clip->interval(i).motion.end(), clip->frame(i + 1).positions));
}

TEST(SceneFile, PromisesADigest) {
  const std::string text = test::refusal([] { generate(parse_scene("small", kSmallScene, "small.json")); });
  EXPECT_EQ(text.find("scene small: the frames have digest "), 0u) << text;
  EXPECT_TRUE(says(text, "the scene file expects 0000000000000000"));
}

TEST(Scene, RunsTheEffectsThatItNamesAndNoOther) {
  const Scene scene = parse_scene("small", small_scene_with_digest(), "small.json");
  std::optional<Clip> clip;
  const Generated generated =
      run_scene(scene, [&](ClipHeader header) -> FrameSink& { return clip.emplace(std::move(header)); });
  ASSERT_EQ(generated.effects.size(), 2u);
  EXPECT_EQ(generated.effects[0].name, "chain_dynamics");
  EXPECT_EQ(generated.effects[0].evaluations, 20u) << "5 frames of 4 substeps";
  EXPECT_EQ(generated.effects[1].name, "skinning_linear");
  EXPECT_EQ(generated.effects[1].evaluations, 5u);
  EXPECT_EQ(clip->frame_count(), 6u);
  EXPECT_NE(clip->frame(0).positions[5], clip->frame(5).positions[5]);
}

// A folder of scenes and a folder of caches, both named by environment variables.
class Catalogue : public testing::Test {
 protected:
  Catalogue() {
    fs::create_directory(root / "scenes");
    put("small", small_scene_with_digest());
    setenv("CSCD_SCENES", (root / "scenes").c_str(), 1);
    setenv("CSCD_CACHE", (root / "cache").c_str(), 1);
  }
  ~Catalogue() override {
    unsetenv("CSCD_SCENES");
    unsetenv("CSCD_CACHE");
  }
  void put(const std::string& name, const std::string& text) {
    test::write(root / "scenes" / (name + ".json"), text);
  }
  static std::string digest_of(ClipSource& source) {
    DigestSink sink;
    copy_frames(source, sink);
    return sink.text();
  }
  // Returns how many frames open_scene had to generate.
  static std::size_t generated(const Scene& scene) {
    std::size_t frames = 0;
    const std::unique_ptr<ClipSource> source = open_scene(scene, [&](std::size_t, std::size_t) { ++frames; });
    EXPECT_EQ(digest_of(*source), scene.expected.digest.value_or(digest_of(*source)));
    return frames;
  }
  const test::Folder scratch;
  const fs::path root = scratch.path;
};

TEST_F(Catalogue, ListsItsScenesInOrder) {
  put("another", small_scene_with_digest());
  const std::vector<SceneSummary> scenes = list_scenes();
  ASSERT_EQ(scenes.size(), 2u);
  EXPECT_EQ(scenes[0].name, "another");
  EXPECT_EQ(scenes[1].name, "small");
  EXPECT_EQ(scenes[1].story, "A chain falls. It is led by one end.");
  EXPECT_EQ(scenes[1].effects, (std::vector<std::string>{"chain_dynamics", "skinning_linear"}));
  EXPECT_EQ(test::refusal([] { load_scene("nosuch"); }),
            "unknown scene nosuch; " + scenes_folder().string() + " holds 2 scenes, which `cscd list` names");
  EXPECT_EQ(test::refusal([] { load_scene("../scenes/small"); }).substr(0, 13), "unknown scene");
}

TEST_F(Catalogue, ListsAFaultySceneWithItsFault) {
  put("broken", "{\"schema\": \"cscd.scene/1\"");
  put("scalar", "7");
  put("based", R"({"base": "scalar"})");
  put("odd", R"({"schema": "cscd.scene/1", "story": 5})");
  std::ofstream(root / "scenes" / "nothing.json");
  const std::vector<SceneSummary> scenes = list_scenes();
  ASSERT_EQ(scenes.size(), 6u);
  EXPECT_TRUE(says(scenes[0].fault, "scalar.json: must be an object"));
  EXPECT_TRUE(says(scenes[1].fault, "broken.json: is not JSON"));
  EXPECT_TRUE(says(scenes[2].fault, "nothing.json: is empty"));
  EXPECT_TRUE(says(scenes[3].fault, "odd.json: story must be a text"));
  EXPECT_TRUE(says(scenes[4].fault, "scalar.json: must be an object"));
  EXPECT_EQ(scenes[5].fault, "");
  EXPECT_EQ(test::refusal([] { load_scene("small"); }), "");
}

TEST_F(Catalogue, TakesASceneFileFromAnyPath) {
  const fs::path folder = root / "my scenes ä";
  fs::create_directory(folder);
  const auto put_there = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder / name) << text;
  };
  put_there("own one.json", small_scene_with_digest());
  const Scene scene = load_scene((folder / "own one.json").string());
  EXPECT_EQ(scene.name, "own_one");
  EXPECT_EQ(generated(scene), 6u);
  EXPECT_EQ(generated(scene), 0u) << "from the cache";
  EXPECT_EQ(cache_file(scene).parent_path(), cache_folder());

  put_there("variant.json", R"({"base": "small", "story": "A. B.", "frames": 7})");
  EXPECT_EQ(load_scene((folder / "variant.json").string()).shape_parameters.number("radius"), 1)
      << "of the folder of scenes";
  std::string other = kSmallScene;
  put_there("small.json", other.replace(other.find("\"radius\": 1"), 11, "\"radius\": 2"));
  EXPECT_EQ(load_scene((folder / "variant.json").string()).shape_parameters.number("radius"), 2)
      << "beside the file first";
  EXPECT_EQ(load_scene("small").shape_parameters.number("radius"), 1);

  EXPECT_TRUE(says(test::refusal([&] { load_scene((folder / "no.json").string()); }), "no such file"));
  fs::create_directory(folder / "folder.json");
  EXPECT_TRUE(
      says(test::refusal([&] { load_scene((folder / "folder.json").string()); }), "not an ordinary file"));
}

TEST_F(Catalogue, DoesWithoutCountsAndDigestUntilTheyAreAccepted) {
  std::string text = kSmallScene;
  text.erase(text.find(",\n  \"expected\""), text.rfind('\n') - text.find(",\n  \"expected\""));
  put("small", text);
  const Scene open = load_scene("small");
  EXPECT_FALSE(open.expected.vertices || open.expected.digest);
  EXPECT_EQ(generated(open), 6u);
  EXPECT_EQ(generated(open), 0u);
  const fs::path cache = cache_file(open);
  {
    std::fstream stream(cache, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(static_cast<std::streamoff>(fs::file_size(cache) - 1000));
    stream.put('\x5a');
  }
  EXPECT_EQ(generated(open), 6u) << "a damaged cache is told by the digest beside it";

  const fs::path file = root / "scenes" / "small.json";
  fs::create_symlink(file, root / "link.json");
  const Expected found = accept_scene(root / "link.json");
  EXPECT_TRUE(fs::is_symlink(root / "link.json"));
  EXPECT_EQ(found.vertices, 82u);
  EXPECT_EQ(found.triangles, 160u);
  EXPECT_EQ(found.bones, 4u);
  const Scene accepted = load_scene("small");
  EXPECT_EQ(accepted.expected.digest, found.digest);
  EXPECT_EQ(accepted.recipe, open.recipe);
  EXPECT_NO_THROW(open_scene(accepted));
  std::ifstream stream(file);
  const std::string written{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_EQ(written, small_scene_with_digest()) << "nothing else changes";
}

TEST_F(Catalogue, AcceptsInPlaceOfWrongExpectations) {
  put("small", kSmallScene);
  EXPECT_TRUE(says(test::refusal([] { open_scene(load_scene("small")); }), "cscd scene accept"));
  accept_scene(root / "scenes" / "small.json");
  EXPECT_NO_THROW(open_scene(load_scene("small")));
}

TEST_F(Catalogue, DoesNotTakeTheCountsOfABaseOfAnotherShape) {
  put("variant", R"({"base": "small", "story": "A. B.", "shape": {"rings": 20}})");
  EXPECT_FALSE(load_scene("variant").expected.vertices);
  EXPECT_NO_THROW(open_scene(load_scene("variant")));
}

TEST_F(Catalogue, TakesFromItsBaseWhatASceneDoesNotSay) {
  const Scene base = load_scene("small");
  put("variant", R"({"base": "small", "story": "It falls harder. It is led by one end.",
                     "shape": {"radius": 0.5}, "frames": 7, "effects": [{"name": "skinning_linear"}],
                     "expected": {"digest": "00"}})");
  const Scene scene = load_scene("variant");
  EXPECT_EQ(scene.story, "It falls harder. It is led by one end.");
  EXPECT_EQ(scene.frames, 7u);
  EXPECT_EQ(scene.substeps, base.substeps);
  EXPECT_EQ(scene.shape_parameters.number("radius"), 0.5) << "objects merge";
  EXPECT_EQ(scene.shape_parameters.number("length"), 20);
  EXPECT_EQ(scene.effects.size(), 1u) << "lists are replaced";
  EXPECT_FALSE(scene.expected.vertices) << "the base's counts are of another shape";
  EXPECT_EQ(scene.expected.digest, "00");
  EXPECT_NE(scene.recipe, base.recipe);

  put("variant", R"({"base": "small", "story": "It falls slowly. It is led by one end.",
                     "patch": [{"op": "add", "path": "/effects/0/drag", "value": 0.25}],
                     "expected": {"digest": "00"}})");
  const std::vector<EffectCall> patched = load_scene("variant").effects;
  ASSERT_EQ(patched.size(), base.effects.size());
  EXPECT_EQ(patched[0].parameters.number("drag"), 0.25);
  EXPECT_EQ(load_scene("variant").expected.vertices, base.expected.vertices);

  const auto file = (root / "scenes" / "variant.json").string();
  put("variant", R"({"patch": []})");
  EXPECT_TRUE(says(test::refusal([] { load_scene("variant"); }), "changes a base, and none is named"));
  put("variant", R"({"base": "small", "patch": [{"op": "replace", "path": "/effects/9/drag", "value": 1}]})");
  EXPECT_TRUE(says(test::refusal([] { load_scene("variant"); }), "its patch (RFC 6902) does not fit"));
  put("variant", R"({"base": "small", "expected": {"digest": "00"}})");
  EXPECT_EQ(test::refusal([] { load_scene("variant"); }), file + ": story is missing; add it");
  put("variant", R"({"base": "small", "story": "A. B."})");
  EXPECT_EQ(test::refusal([] { load_scene("variant"); }), "") << "a digest may come later";
  put("variant", R"({"base": "nosuch"})");
  EXPECT_TRUE(says(test::refusal([] { load_scene("variant"); }), "nosuch.json: no such file"));
  put("second", R"({"base": "variant"})");
  EXPECT_TRUE(says(test::refusal([] { load_scene("second"); }), "has a base itself"));
}

TEST_F(Catalogue, FindsItsFolder) {
  EXPECT_EQ(scenes_folder(), root / "scenes");
  const fs::path before = fs::current_path();
  unsetenv("CSCD_SCENES");
  unsetenv("CSCD_CACHE");
  fs::create_directories(root / "a" / "b");
  fs::current_path(root / "a" / "b");
  EXPECT_TRUE(fs::equivalent(scenes_folder(), root / "scenes")) << "going up from the current directory";
  EXPECT_EQ(cache_folder(), scenes_folder().parent_path() / ".cache");
  fs::current_path(before);
  setenv("CSCD_SCENES", (root / "a").c_str(), 1);
  EXPECT_TRUE(says(test::refusal([] { scenes_folder(); }), "holds no scene file"));
}

TEST_F(Catalogue, GeneratesOnceAndAgainWhenTheCacheIsDamaged) {
  const Scene scene = load_scene("small");
  EXPECT_EQ(generated(scene), 6u);
  EXPECT_EQ(generated(scene), 0u) << "from the cache";

  const fs::path file = cache_file(scene);
  const auto size = fs::file_size(file);
  {
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(static_cast<std::streamoff>(size - 1000));
    stream.put('\x5a');
  }
  EXPECT_EQ(generated(scene), 6u) << "one byte differs";
  fs::resize_file(file, size / 2);
  EXPECT_EQ(generated(scene), 6u) << "cut short";
  EXPECT_EQ(generated(scene), 0u);
}

TEST_F(Catalogue, GeneratesOnceForProcessesThatMissTheSameCache) {
  const Scene scene = load_scene("small");
  const auto generated_slowly = [&] {
    std::size_t frames = 0;
    open_scene(scene, [&](std::size_t, std::size_t) { ++frames, usleep(20'000); });
    return frames;
  };
  const pid_t child = fork();
  if (child == 0) _exit(static_cast<int>(generated_slowly()));
  const std::size_t frames = generated_slowly();
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(frames + static_cast<std::size_t>(WEXITSTATUS(status)), 6u);
}

TEST_F(Catalogue, KeepsWhatEachEffectTook) {
  const Scene scene = load_scene("small");
  open_scene(scene);
  const std::vector<EffectCost> costs = effect_costs(scene);
  ASSERT_EQ(costs.size(), 2u);
  EXPECT_EQ(costs[0].name, "chain_dynamics");
  EXPECT_EQ(costs[0].evaluations, 5u * static_cast<unsigned>(scene.substeps)) << "runs at every substep";
  EXPECT_EQ(costs[1].name, "skinning_linear");
  EXPECT_EQ(costs[1].evaluations, 5u) << "runs once a frame";
  for (const EffectCost& cost : costs) EXPECT_GT(cost.ms, 0) << cost.name;

  const fs::path file = cache_file(scene).replace_extension(".json");
  std::ofstream(file) << "{";
  EXPECT_TRUE(
      says(test::refusal([&] { effect_costs(scene); }), "remove it, and the scene is generated anew"));
  fs::remove(file);
  EXPECT_EQ(generated(scene), 6u) << "a cache that does not tell is none";
}

TEST_F(Catalogue, NamesClothWithoutBones) {
  Scene scene = load_scene("small");
  EXPECT_TRUE(cloth_names(scene).empty());
  const Parameters skirt = scene.shape_parameters;
  scene.shape_parameters = skirt.with("skirts", std::vector<Parameters>{skirt});
  EXPECT_EQ(cloth_names(scene), std::vector<std::string>{"skirt"});
  scene.shape_parameters = skirt.with("skirts", std::vector<Parameters>{skirt, skirt});
  EXPECT_EQ(cloth_names(scene), (std::vector<std::string>{"skirt 0", "skirt 1"}));
}

// Mutation: a damaged file is taken for a scene without bones.
TEST_F(Catalogue, KeepsTheNamesOfBones) {
  const Scene scene = load_scene("small");
  open_scene(scene);
  const std::vector<std::string> names = make_shape(scene.shape, scene.shape_parameters).bone_names;
  ASSERT_FALSE(names.empty());
  EXPECT_EQ(bone_names(scene), names);
  std::ofstream(cache_file(scene).replace_extension(".json")) << "{\"bones\": [\"bone_";
  EXPECT_EQ(bone_names(scene), names);
}

TEST_F(Catalogue, CachesByWhatTheFramesDependOn) {
  const fs::path file = cache_file(load_scene("small"));
  std::string text = small_scene_with_digest();
  text.replace(text.find("A chain falls."), 14, "It just falls.");
  put("small", "\n" + text);
  EXPECT_EQ(cache_file(load_scene("small")), file) << "neither story nor white space matter";
  text.replace(text.find("\"drag\": 0.5"), 11, "\"drag\": 0.6");
  put("small", text);
  EXPECT_NE(cache_file(load_scene("small")), file);
  EXPECT_TRUE(says(test::refusal([] { open_scene(load_scene("small")); }), "the frames have digest"));
  EXPECT_FALSE(fs::exists(cache_file(load_scene("small")))) << "unverified frames are not kept";
}

TEST_F(Catalogue, SaysWhereItCannotCache) {
  for (const char* folder : {"/proc/no/such", "/proc"}) {  // cannot be made; holds no file of ours
    setenv("CSCD_CACHE", folder, 1);
    EXPECT_TRUE(
        says(test::refusal([] { open_scene(load_scene("small")); }), "let CSCD_CACHE name a folder that can"))
        << folder;
  }
}

}  // namespace
}  // namespace cscd::scenes
