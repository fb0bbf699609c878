#include <algorithm>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/testing/test_program.h"

// The models of Debian's package assimp-testmodels, which scripts/test installs. They were collected from
// many exporters, so they are what no generator thinks of. Tests skip where the package is absent.
namespace cscd::bench {
namespace {

const fs::path kFolder = "/usr/share/assimp/models";

// A skinned or animated file, and what is known about it from looking at it.
struct Known {
  const char* file;
  std::size_t clips, frames;      // frames: of the first clip at the file's own rate
  std::size_t components, bones;  // bones: of the component that is used
  std::size_t triangles;          // of the component that is used
  bool closed;                    // the component that is used
  bool collides;                  // somewhere in the first clip
};
constexpr Known kKnown[] = {
    {"glTF2/simple_skin/simple_skin.gltf", 1, 166, 1, 2, 8, false, false},
    {"Collada/box_nested_animation.dae", 1, 40, 1, 1, 12, true, false},
    {"Collada/anims_with_full_rotations_between_keys.DAE", 1, 359, 64, 1, 12, true, false},
    {"FBX/animation_with_skeleton.fbx", 1, 21, 1, 14, 2112, true, false},
    {"FBX/huesitos.fbx", 1, 40, 1, 8, 120, true, true},
    {"X/BCN_Epileptic.X", 1, 100, 5, 34, 3090, false, true},
    {"X/Testwuson.X", 3, 30, 51, 37, 3420, false, true},
    {"X/anim_test.x", 1, 24, 1, 3, 840, true, true},
};
void PrintTo(const Known& known, std::ostream* out) {
  *out << known.file;
}

class DebianModels : public testing::TestWithParam<Known> {
 protected:
  void SetUp() override {
    if (!fs::exists(kFolder)) GTEST_SKIP() << "no " << kFolder << "; install assimp-testmodels";
  }
};

// Nothing where a file has an answer, else the one line of its refusal.
std::string refusal(const std::vector<std::string>& arguments) {
  const Outcome outcome = cscd(arguments);
  EXPECT_EQ(outcome.end, Outcome::End::exited) << to_text(outcome);
  EXPECT_TRUE(outcome.code == 0 || outcome.code == 2) << to_text(outcome);
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), outcome.code == 2)
      << outcome.errors;
  return outcome.errors;
}

TEST_P(DebianModels, AreAnsweredAsKnown) {
  const Known& known = GetParam();
  const std::string file = kFolder / known.file;
  const Scratch scratch;
  const auto facts = document_of({"inspect", file, "--component", "auto"});
  ASSERT_EQ(facts["clips"].size(), known.clips);
  EXPECT_EQ(facts["clips"][0]["frames"], known.frames);
  ASSERT_EQ(facts["components"].size(), known.components);
  const auto chosen =
      std::find_if(facts["components"].begin(), facts["components"].end(),
                   [](const nlohmann::json& component) { return component["chosen"].get<bool>(); });
  ASSERT_NE(chosen, facts["components"].end());
  EXPECT_EQ((*chosen)["triangles"], known.triangles);
  EXPECT_EQ((*chosen)["bones"], known.bones);
  EXPECT_EQ((*chosen)["closed"], known.closed);

  const auto base =
      document_of({"query", file, "--clip", "0", "--component", "auto", "--strategy", "base"})["intervals"];
  EXPECT_EQ(base.size(), known.frames - 1);
  EXPECT_EQ(std::any_of(base.begin(), base.end(),
                        [](const nlohmann::json& interval) { return interval["collides"].get<bool>(); }),
            known.collides);
  // A strategy that needs a closed surface refuses an open one. What takes the surface answers as the others
  // do.
  const std::vector<std::string> fast{"query",       file,   "--clip",     "0",
                                      "--component", "auto", "--strategy", "drvbc_fast"};
  if (!known.closed) {
    const std::string text = refusal(fast);
    EXPECT_NE(text.find("boundary edges"), std::string::npos) << text;
  }
  std::vector<std::string> taken = fast;
  if (!known.closed) taken.back() = "drvbc_fast_complete";
  const auto other = document_of(taken)["intervals"];
  ASSERT_EQ(other.size(), base.size());
  for (std::size_t i = 0; i < base.size(); ++i) EXPECT_EQ(other[i]["time"], base[i]["time"]) << i;
}
INSTANTIATE_TEST_SUITE_P(Known, DebianModels, testing::ValuesIn(kKnown), [](const auto& known) {
  std::string word = fs::path(known.param.file).stem();
  std::replace_if(
      word.begin(), word.end(), [](char c) { return !std::isalnum(c); }, '_');
  return word;
});

// Files without a surface, without motion or damaged on purpose, by a word of their refusal.
TEST(DebianRefusals, SayWhatIsWrong) {
  if (!fs::exists(kFolder)) GTEST_SKIP() << "no " << kFolder << "; install assimp-testmodels";
  const std::vector<std::pair<const char*, const char*>> cases = {
      {"BVH/01_01.bvh", "no triangles"},
      {"Collada/cameras.dae", "no triangles"},
      {"FBX/transparentTest.fbx", "its FBX header is damaged"},
      {"glTF2/BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb", "not finite"},
      {"glTF2/MissingBin/BoxTextured.gltf", "BoxTextured0.bin"},
      {"invalid/empty.x", "is empty"}};
  const Scratch scratch;
  for (const auto& [file, what] : cases) {
    const std::string text = refusal({"query", kFolder / file, "--json", scratch / "q.json", "--force"});
    EXPECT_NE(text.find(what), std::string::npos) << file << ": " << text;
    EXPECT_FALSE(fs::exists(scratch / "q.json")) << file;
  }
}

// Files without a clip are answered about their one pose. Whoever needs a motion refuses them.
TEST(DebianPoses, AreAnsweredByThemselves) {
  if (!fs::exists(kFolder)) GTEST_SKIP() << "no " << kFolder << "; install assimp-testmodels";
  for (const char* file : {"Collada/duck.dae", "Collada/cube_UTF16LE.dae", "FBX/spider.fbx",
                           "X/test_cube_text.x", "glTF2/BoxTextured-glTF/BoxTextured.gltf"}) {
    const auto document = document_of({"query", kFolder / file});
    EXPECT_EQ(document["one_pose"], true) << file;
    EXPECT_EQ(document["intervals"].size(), 1u) << file;
    EXPECT_NE(document["summary"]["sentence"].get<std::string>().find(" itself in its one pose"),
              std::string::npos)
        << document["summary"]["sentence"];
    const std::string text = refusal({"export", kFolder / file, "nothing.obj"});
    EXPECT_NE(text.find("no clip, so nothing moves"), std::string::npos) << file << ": " << text;
  }
}

// All files of the package in formats that are read: an answer or one line, and no importer lost on the way.
TEST(DebianRefusals, NoFileCrashesTheImporter) {
  if (!fs::exists(kFolder)) GTEST_SKIP() << "no " << kFolder << "; install assimp-testmodels";
  std::size_t files = 0, refused = 0;
  for (const auto& entry : fs::recursive_directory_iterator(kFolder)) {
    std::string kind = entry.path().extension();
    for (char& c : kind) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    const std::vector<std::string> read{".glb", ".gltf", ".fbx", ".x", ".dae", ".bvh"};
    if (!entry.is_regular_file() || std::find(read.begin(), read.end(), kind) == read.end()) continue;
    SCOPED_TRACE(entry.path());
    const std::string text = refusal({"inspect", entry.path()});
    EXPECT_EQ(text.find("crashed"), std::string::npos) << text;
    EXPECT_EQ(text.find("--import-memory"), std::string::npos) << text;
    ++files;
    refused += !text.empty();
  }
  EXPECT_GT(files, 90u);
  std::printf("%zu files, %zu refused\n", files, refused);
}

}  // namespace
}  // namespace cscd::bench
