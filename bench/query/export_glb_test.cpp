#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/testing/test_program.h"
#include "scenes/catalog/generate.h"
#include "scenes/clip/digest.h"
#include "scenes/clip/point_cache.h"
#include "scenes/export/glb.h"
#include "scenes/export/skinned_scene.h"

// The program's .glb files: what it answers about one is what it answers about the scene.
namespace cscd::bench {
namespace {

// How many intervals of a closed character collide, alike in both answers.
std::size_t expect_same_verdicts(const nlohmann::json& scene, const nlohmann::json& model) {
  EXPECT_EQ(scene.size(), model.size());
  std::size_t contacts = 0;
  for (std::size_t i = 0; i < std::min(scene.size(), model.size()); ++i) {
    SCOPED_TRACE(i);
    EXPECT_EQ(model[i].at("starts_embedded"), scene[i].at("starts_embedded"));
    EXPECT_EQ(model[i].at("collides"), scene[i].at("collides"));
    if (scene[i].at("time").is_null() || model[i].at("time").is_null()) continue;
    ++contacts;
    EXPECT_NEAR(model[i].at("time").get<double>(), scene[i].at("time").get<double>(), 1e-4);
  }
  return contacts;
}

TEST(ExportGlb, ASceneIsAnsweredAlike) {
  const Scratch scratch;
  const Outcome exported = cscd({"export", "urchin", scratch / "urchin.glb"});
  ASSERT_EQ(exported.code, 0) << exported.errors;
  const auto answer = [](const std::string& input) {
    return document_of({"query", input, "--frames", "0:80"})["intervals"];
  };
  EXPECT_EQ(expect_same_verdicts(answer("urchin"), answer(scratch / "urchin.glb")), 0u);
  // The same bytes again, for whoever compares files.
  ASSERT_EQ(cscd({"export", "urchin", scratch / "again.glb"}).code, 0);
  EXPECT_EQ(read(scratch / "again.glb"), read(scratch / "urchin.glb"));
}

// The urchin with spikes that sway so wide that they go through each other.
TEST(ExportGlb, ContactsAreFoundAtTheSameTimes) {
  scenes::Scene scene = scenes::parse_scene("wild", R"({
      "schema": "cscd.scene/1", "base": "urchin", "story": "For a test.", "frames": 61,
      "patch": [{"op": "add", "path": "/effects/1/weight", "value": 1.5},
                {"op": "add", "path": "/effects/2/weight", "value": 1.5}],
      "expected": {"digest": "none yet"}})",
                                            "test");
  const Scratch scratch;
  std::optional<scenes::PointCacheWriter> cache;
  scene.expected.digest = scenes::run_scene(scene, [&](scenes::ClipHeader header) -> scenes::FrameSink& {
                            return cache.emplace(scratch / "wild.h5", std::move(header), false);
                          }).digest;
  cache->finish();
  write(scratch.path / "wild.glb", scenes::to_glb(scenes::skinned_scene(scene)));
  EXPECT_GT(expect_same_verdicts(document_of({"query", scratch / "wild.h5"})["intervals"],
                                 document_of({"query", scratch / "wild.glb"})["intervals"]),
            10u);
}

// In one line, before any work is done, and without a file left.
TEST(ExportGlb, WhatCannotBeExportedIsRefused) {
  const Scratch scratch;
  const std::string out = scratch / "out.glb";
  write(scratch.path / "there.glb", "something");
  write(scratch.path / "model.gltf", "{}");
  write(scratch.path / "cache.h5", "");
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"man", out}, "scene man: its last effect is skinning_dual_quaternion"},
      {{"box", out}, "scene box: its last effect is skinning_dual_quaternion"},
      {{"rope_contact", out}, "its last effect is contact_response"},
      {{"nobody", out}, "unknown scene nobody"},
      {{scratch / "model.gltf", out}, "only a scene, by its name"},
      {{scratch / "cache.h5", out}, "is a point cache, which has no weights"},
      {{"urchin", out, "--fps", "60"}, "leave out the options of model files"},
      {{"urchin", scratch / "there.glb"}, "exists"},
      {{"urchin", scratch / "nowhere/out.glb"}, "choose a folder that exists"}};
  for (const auto& [words, what] : cases) {
    std::vector<std::string> arguments{"export"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    expect_refused(arguments, what);
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(scratch.path), {}), 3);
  EXPECT_EQ(read(scratch / "there.glb"), "something");
}

}  // namespace
}  // namespace cscd::bench
