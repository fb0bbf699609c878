#include <algorithm>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/testing/test_generated.h"

// These tests ask of generated characters, which every clone has, what model_test.cpp asks of shared models.
namespace cscd::bench {
namespace {

class Generated : public testing::Test {
 protected:
  static nlohmann::json queried(const std::string& file, std::vector<std::string> options) {
    options.insert(options.begin(), {"query", file});
    return document_of(options);
  }
  // The closed body alone, which every strategy takes.
  nlohmann::json queried_body(const std::string& file, std::vector<std::string> options) {
    options.insert(options.end(), {"--component", "auto"});
    return queried(file, std::move(options));
  }
  // The one line of a refusal; nothing where the file is accepted.
  std::string refusal(const std::string& file, std::vector<std::string> options = {}) {
    options.insert(options.begin(), {"query", file, "--fps", "1", "--json", scratch / "q.json", "--force"});
    const Outcome asked = cscd(options);
    EXPECT_EQ(std::count(asked.errors.begin(), asked.errors.end(), '\n'), asked.code == 2) << asked.errors;
    return asked.code == 2 ? asked.errors : std::string();
  }

  const Scratch scratch;
  const std::string figure = character_file("generated_figure.glb", scratch);
};

TEST_F(Generated, TheFigureTouchesItselfInOneClipOfTwo) {
  const auto walk = queried_body(figure, {"--clip", "walk", "--from-bind-pose"})["intervals"];
  for (const auto& interval : walk) {
    EXPECT_EQ(interval.at("starts_embedded"), true);
    EXPECT_EQ(interval.at("collides"), false);
    EXPECT_EQ(interval.at("proven"), true);
  }
  // Every strategy finds the same first contact at the same time, as long as starts are embedded.
  const auto base =
      queried_body(figure, {"--clip", "hug", "--from-bind-pose", "--strategy", "base"})["intervals"];
  ASSERT_EQ(base.size(), 45u);
  for (const char* strategy : {"mcd", "selfccd", "rvbc", "drvbc", "drvbc_fast", "drvbc_fast_complete"}) {
    const auto other =
        queried_body(figure, {"--clip", "hug", "--from-bind-pose", "--strategy", strategy})["intervals"];
    std::size_t contacts = 0;
    for (std::size_t i = 0; i < base.size(); ++i) {
      EXPECT_EQ(other[i].at("starts_embedded"), base[i].at("starts_embedded"));
      EXPECT_EQ(other[i].at("time"), base[i].at("time")) << strategy << ", interval " << i;
      contacts += base[i].at("collides").get<bool>();
    }
    EXPECT_GT(contacts, 0u);
  }
}

// Eyes that cross the head and an open shirt: told apart by inspect, answered completely where asked for.
TEST_F(Generated, EyesAndShirtAreComponentsOfTheirOwn) {
  const auto facts = document_of({"inspect", figure});
  const auto& parts = facts["components"];
  ASSERT_EQ(parts.size(), 4u);
  EXPECT_EQ(parts[0]["triangles"], 2272);
  EXPECT_EQ(parts[0]["chosen"], true);
  EXPECT_EQ(facts["together"]["embedding"][0]["embedded"], false);
  std::size_t open = 0, eyes = 0;
  for (const auto& part : parts) {
    EXPECT_EQ(part["embedding"][0]["embedded"], true);
    open += part["closed"] == false;
    eyes += part["triangles"] == 80;
  }
  EXPECT_EQ(open, 1u);
  EXPECT_EQ(eyes, 2u);
  const auto all = queried(figure, {"--clip", "walk", "--component", "all", "--frames", "0:4"})["intervals"];
  for (const auto& interval : all) {
    EXPECT_EQ(interval.at("starts_embedded"), false);
    EXPECT_EQ(interval.at("proven"), true);
  }
  EXPECT_NE(refusal(figure, {"--component", "1", "--strategy", "drvbc"}).find("boundary edges"),
            std::string::npos);
}

TEST_F(Generated, BothFormsOfAFileAreAnsweredAlike) {
  const std::string text = character_file("generated_figure.gltf", scratch);
  const std::vector<std::string> options{"--clip", "hug", "--fps", "10", "--from-bind-pose"};
  const auto one = queried(figure, options), other = queried(text, options);
  ASSERT_EQ(one["intervals"].size(), 15u);  // 11 frames of one second after 5 of the lead-in
  ASSERT_EQ(other["intervals"].size(), 15u);
  EXPECT_EQ(one["import"]["clip"], 1);
  for (std::size_t i = 0; i < 15; ++i) EXPECT_EQ(one["intervals"][i]["time"], other["intervals"][i]["time"]);
}

TEST_F(Generated, FramesAreExportedAndOptionsOfModelsRefusedForThem) {
  const Outcome exported = cscd({"export", figure, scratch / "figure.h5", "--clip", "hug"});
  ASSERT_EQ(exported.code, 0) << exported.errors;
  const auto model = queried(figure, {"--clip", "hug"})["intervals"],
             cache = queried(scratch / "figure.h5", {})["intervals"];
  ASSERT_EQ(cache.size(), model.size());
  for (std::size_t i = 0; i < model.size(); ++i) EXPECT_EQ(cache[i]["time"], model[i]["time"]);
  expect_refused({"inspect", scratch / "figure.h5", "--fps", "10"}, "is no model file");
}

TEST_F(Generated, DefectiveOnesSayWhy) {
  const auto says = [&](const scenes::Character& character, const std::string& what,
                        const std::vector<std::string>& options = {}) {
    write(scratch.path / "defective.gltf", scenes::to_gltf(character));
    const std::string text = refusal(scratch / "defective.gltf", options);
    EXPECT_NE(text.find(what), std::string::npos) << text << " for " << what;
  };
  // Whoever needs a motion refuses what is one pose; query answers about that pose.
  const auto is_one_pose = [&](const scenes::Character& character, const std::string& what,
                               const std::vector<std::string>& options = {}) {
    const std::string file = scratch / "pose.gltf";
    write(file, scenes::to_gltf(character));
    std::vector<std::string> exported{"export", file, scratch / "out.h5"};
    exported.insert(exported.end(), options.begin(), options.end());
    expect_refused(exported, what);
    EXPECT_EQ(queried(file, options)["one_pose"], true) << what;
  };
  scenes::Character still = scenes::bending_tube();
  still.animations.clear();
  is_one_pose(still, "no clip, so nothing moves (5 nodes, 2 bones)");
  scenes::Character bones = scenes::bending_tube();
  bones.parts.clear();
  says(bones, "no triangles");
  scenes::Character holed = scenes::bending_tube();
  holed.parts[0].triangles.erase(holed.parts[0].triangles.begin() + 9);
  says(holed, "boundary edges: 3", {"--strategy", "drvbc"});
  // A fin of one triangle on an edge that has two already.
  scenes::Character finned = scenes::bending_tube();
  finned.parts[0].triangles.push_back(
      {finned.parts[0].triangles[5][1], finned.parts[0].triangles[5][0], finned.parts[0].triangles[200][0]});
  says(finned, "non-manifold edges: 1", {"--strategy", "drvbc"});
  scenes::Character flat = scenes::bending_tube();
  flat.animations[0].channels[0].rotations = {{0, {}}};
  is_one_pose(flat, "none of its clips moves the surface: 0 'bend'");
  is_one_pose(flat, "is one pose", {"--clip", "bend"});
}

TEST_F(Generated, TimeAndMemoryLimitsEndInOneLine) {
  const std::string large = character_file("generated_large_tube.glb", scratch);
  expect_refused({"inspect", large, "--import-seconds", "0.01"}, "--import-seconds");
#if !defined(__SANITIZE_ADDRESS__)
  // Wherever memory runs out, the importer says so, until there is enough.
  bool enough = false;
  std::size_t refused = 0;
  for (int mib = 40; mib <= 1024 && !enough; mib += mib / 8) {
    const Outcome asked = cscd({"inspect", large, "--import-memory", std::to_string(mib)});
    enough = asked.code == 0;
    refused += !enough;
    if (!enough) {
      EXPECT_NE(asked.errors.find("--import-memory"), std::string::npos) << mib << ": " << asked.errors;
    }
  }
  EXPECT_TRUE(enough);
  EXPECT_GT(refused, 0u);
#endif
}

}  // namespace
}  // namespace cscd::bench
