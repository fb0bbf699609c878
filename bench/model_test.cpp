#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <random>
#include <sys/stat.h>
#include <unistd.h>

#include "bench/catalogue.h"
#include "bench/input.h"
#include "core/base/error.h"
#include "core/detect/embedding.h"
#include "scenes/catalog/scene.h"
#include "scenes/clip/test_sparse_cache.h"
#include "scenes/sandbox/run_limited.h"

// Model files from end to end: real characters, which are not part of the repository ($CSCD_MODELS, else
// ../shared/models beside it; tests skip where they are absent), and the same files damaged.
namespace cscd::bench {
namespace {

namespace fs = std::filesystem;
using scenes::Limits;
using scenes::Outcome;

fs::path models_folder() {
  if (const char* named = std::getenv("CSCD_MODELS")) return named;
  return scenes::scenes_folder().parent_path() / ".." / "shared" / "models";
}

std::string model(const std::string& name) {
  return (models_folder() / name).string();
}

bool absent(const std::string& name) {
  std::error_code error;
  return !fs::exists(model(name), error);
}

Outcome cscd(const std::vector<std::string>& arguments, const Limits& limits = {}) {
  return scenes::run_limited(fs::read_symlink("/proc/self/exe").parent_path() / "cscd", arguments, limits);
}

// A folder that is gone after the test.
struct Scratch {
  fs::path path = fs::temp_directory_path() / ("cscd-model-test-" + std::to_string(getpid()));
  Scratch() {
    fs::remove_all(path);
    fs::create_directories(path);
  }
  ~Scratch() { fs::remove_all(path); }
  std::string operator/(const std::string& name) const { return (path / name).string(); }
};

void write(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}
std::string read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

constexpr const char* kUsable[] = {"cesium_man.glb",
                                   "fox_khronos.glb",
                                   "hand_xrtools_right.glb",
                                   "horse.glb",
                                   "kenney_humanoid.glb",
                                   "shiba_inu.glb",
                                   "dembones_bone_all.fbx",
                                   "dembones_decomposition20.fbx",
                                   "eagle.fbx"};

class Characters : public testing::TestWithParam<const char*> {};

// The time of the first decided contact.
std::optional<double> first_contact(Detector& detector, const scenes::ClipInterval& interval) {
  ContactSet found;
  detector.detect(interval.motion, interval.bones ? &*interval.bones : nullptr, found);
  found.sort();
  for (const Contact& contact : found.contacts)
    if (contact.verdict == Verdict::contact) return contact.time;
  return std::nullopt;
}

// On every embedded start of some intervals of every clip, every strategy that can finds the reference's
// first contact at the reference's time.
TEST_P(Characters, NoFirstContactIsLost) {
  if (absent(GetParam())) GTEST_SKIP() << "no " << model(GetParam());
  const ElementaryTest& exact = elementary_test_named("exact");
  ModelOptions options;
  options.import.from_bind_pose = true;
  std::size_t clips = 1, intervals = 0, embedded = 0, with_contact = 0;
  for (std::size_t clip = 0; clip < clips; ++clip) {
    options.import.clip = std::to_string(clip);
    Input input = open_input(model(GetParam()), options);
    clips = input.import->clips.size();
    ASSERT_TRUE(input.mesh.closed_and_oriented());
    ASSERT_TRUE(input.rig.has_value());
    std::vector<std::unique_ptr<Detector>> detectors;
    for (const Strategy* strategy : strategies_in(""))
      detectors.push_back(strategy->make(input.setup(exact)).detector);
    EmbeddingTest embedding(input.mesh, input.reference);
    // Some tens of thousands of triangles a clip, spread over it.
    const std::size_t most = std::max<std::size_t>(2, 60'000 / (clips * input.mesh.triangle_count()) + 2);
    const std::size_t step = std::max<std::size_t>(1, input.clip->interval_count() / most);
    for (std::size_t i = 0; i < input.clip->interval_count(); i += step) {
      const scenes::ClipInterval interval = input.clip->load(i);
      ++intervals;
      if (!embedding.embedded(interval.motion.start())) continue;
      ++embedded;
      const std::optional<double> expected = first_contact(*detectors[0], interval);
      with_contact += expected.has_value();
      for (std::size_t d = 1; d < detectors.size(); ++d)
        EXPECT_EQ(first_contact(*detectors[d], interval), expected)
            << "clip " << clip << ", interval " << i << ", strategy " << strategies_in("")[d]->name;
    }
  }
  EXPECT_GT(embedded, 0u);
  std::printf("%s: %zu clips, %zu intervals, %zu start embedded, %zu of them with a contact\n", GetParam(),
              clips, intervals, embedded, with_contact);
}
INSTANTIATE_TEST_SUITE_P(Shared, Characters, testing::ValuesIn(kUsable), [](const auto& name) {
  std::string word = name.param;
  std::replace_if(
      word.begin(), word.end(), [](char c) { return !std::isalnum(c); }, '_');
  return word;
});

TEST(Models, QueryAndInspectAnswerInJson) {
  if (absent("fox_khronos.glb")) GTEST_SKIP();
  const Scratch scratch;
  const Outcome asked = cscd({"query", model("fox_khronos.glb"), "--clip", "Walk", "--fps", "10",
                              "--from-bind-pose", "--json", scratch / "q.json"});
  ASSERT_EQ(asked.code, 0) << asked.errors;
  const auto answer = nlohmann::json::parse(read(scratch / "q.json"));
  EXPECT_EQ(answer["intervals"].size(), 12u);  // 8 frames of 0.7 s after 5 of the lead-in
  EXPECT_EQ(answer["import"]["clips"].size(), 3u);
  EXPECT_EQ(answer["import"]["clip"], 1);
  const Outcome looked = cscd({"inspect", model("fox_khronos.glb"), "--json", scratch / "i.json"});
  ASSERT_EQ(looked.code, 0) << looked.errors;
  const auto facts = nlohmann::json::parse(read(scratch / "i.json"));
  ASSERT_EQ(facts["components"].size(), 1u);
  EXPECT_EQ(facts["components"][0]["triangles"], 576);
  EXPECT_EQ(facts["components"][0]["closed"], true);
  EXPECT_EQ(facts["components"][0]["embedding"].size(), 4u);
  EXPECT_EQ(facts["components"][0]["strategies"].size(), strategies().size());
  // What is asked of a model file makes no sense for a point cache.
  const Outcome exported = cscd({"export", model("fox_khronos.glb"), scratch / "fox.h5"});
  ASSERT_EQ(exported.code, 0) << exported.errors;
  EXPECT_EQ(cscd({"inspect", scratch / "fox.h5"}).code, 0);
  const Outcome wrong = cscd({"inspect", scratch / "fox.h5", "--fps", "10"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_NE(wrong.errors.find("is no model file"), std::string::npos);
}

TEST(Models, LeaveNothingBehind) {
  if (absent("fox_khronos.glb")) GTEST_SKIP();
  const fs::path cache = scenes::scenes_folder().parent_path() / ".cache";
  std::error_code ignored;
  const auto left = [&] {
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(cache, ignored))
      count += entry.path().filename().string().starts_with("import-");
    return count;
  };
  const std::size_t before = left();
  cscd({"inspect", model("fox_khronos.glb")});
  cscd({"inspect", model("bvh/cmu_02_01_walk.bvh")});
  cscd({"inspect", model("horse.glb"), "--import-seconds", "0.01"});
  EXPECT_LE(left(), before);
}

TEST(Models, DefectiveOnesSayWhy) {
  if (absent("nonclosed/spider.glb")) GTEST_SKIP();
  const Scratch scratch;
  const auto refusal = [&](const std::string& name, const std::string& strategy) {
    const Outcome outcome = cscd({"query", model(name), "--strategy", strategy, "--frames", "0:1", "--json",
                                  scratch / "out.json", "--force"});
    return outcome.code == 2 ? outcome.errors : std::string();
  };
  EXPECT_NE(refusal("nonclosed/spider.glb", "drvbc").find("non-manifold edges: 8, boundary edges: 4"),
            std::string::npos);
  EXPECT_NE(
      refusal("nonclosed/bcn_epileptic.x", "drvbc").find("boundary edges: 62, non-manifold vertices: 1"),
      std::string::npos);
  EXPECT_NE(refusal("bvh/cmu_02_01_walk.bvh", "base").find("38 nodes and 1 clips, but no triangles"),
            std::string::npos);
  EXPECT_NE(refusal("hand_xrtools_left.gltf", "base").find("no clip, so nothing moves (28 nodes, 20 bones)"),
            std::string::npos);
  EXPECT_EQ(refusal("nonclosed/spider.glb", "base"), "");

  // Each of the 28 pieces is sound; together they poke into each other.
  const Outcome outcome =
      cscd({"inspect", model("nonclosed/shark_28_components.glb"), "--json", scratch / "s.json"});
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  const auto shark = nlohmann::json::parse(read(scratch / "s.json"));
  EXPECT_EQ(shark["components"].size(), 28u);
  for (const auto& piece : shark["components"]) EXPECT_EQ(piece["closed"], true);
  EXPECT_EQ(shark["together"]["embedding"][0]["embedded"], false);
}

TEST(Models, TimeAndMemoryLimitsEndInOneLine) {
  if (absent("eagle.fbx")) GTEST_SKIP();
  const Outcome late = cscd({"inspect", model("eagle.fbx"), "--import-seconds", "0.02"});
  EXPECT_EQ(late.code, 2);
  EXPECT_NE(late.errors.find("--import-seconds"), std::string::npos) << late.errors;
#if !defined(__SANITIZE_ADDRESS__)
  const Outcome large = cscd({"inspect", model("eagle.fbx"), "--import-memory", "48"});
  EXPECT_EQ(large.code, 2);
  EXPECT_NE(large.errors.find("--import-memory"), std::string::npos) << large.errors;
#endif
}

// What a reader of untrusted files may do: answer, or refuse in one line, within its limits.
class Hostile : public testing::Test {
 protected:
  static constexpr double kImportSeconds = 5;
  static constexpr std::size_t kImportMiB = 1024;

  void attack(const std::string& file) {
    const bool ask = ++runs % 2 == 0;
    std::vector<std::string> arguments{ask ? "query" : "inspect", file};
    if (ask)
      arguments.insert(arguments.end(), {"--frames", "0:1", "--json", scratch / "out.json", "--force"});
    arguments.insert(arguments.end(), {"--import-seconds", std::to_string(kImportSeconds), "--import-memory",
                                       std::to_string(kImportMiB)});
    Limits limits;
    limits.memory_bytes = std::size_t{2 * kImportMiB} << 20;
    limits.seconds = 30;
    const Outcome outcome = cscd(arguments, limits);
    slowest = std::max(slowest, outcome.seconds);
    largest = std::max(largest, outcome.peak_bytes);
    ASSERT_EQ(outcome.end, Outcome::End::exited) << file << ": " << to_text(outcome);
    ASSERT_TRUE(outcome.code == 0 || outcome.code == 2) << file << ": " << to_text(outcome);
    accepted += outcome.code == 0;
    if (outcome.code == 0) {
      EXPECT_EQ(outcome.errors, "") << file;
    } else {
      EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << file << outcome.errors;
      EXPECT_TRUE(outcome.errors.starts_with("cscd: ")) << file << outcome.errors;
      crashed += outcome.errors.find("crashed") != std::string::npos;
      timed_out += outcome.errors.find("not done after") != std::string::npos;
    }
#if !defined(__SANITIZE_ADDRESS__)
    EXPECT_LT(outcome.peak_bytes, (kImportMiB + 256) << 20) << file;
#endif
  }

  void report(const char* what) const {
    std::printf(
        "%s: %zu runs, %zu accepted, %zu refused, %zu of them lost importers, %zu late; slowest %.1f s, "
        "largest %zu MiB\n",
        what, runs, accepted, runs - accepted, crashed, timed_out, slowest, largest >> 20);
  }

  const Scratch scratch;
  std::size_t runs = 0, accepted = 0, crashed = 0, timed_out = 0, largest = 0;
  double slowest = 0;
};

std::string flipped(std::string bytes, std::mt19937_64& random) {
  const std::size_t flips = std::size_t{1} << (random() % 7);
  // Half of them all over the file, half near its beginning, where headers and counts stand.
  const std::size_t reach = random() % 2 ? bytes.size() : std::min<std::size_t>(bytes.size(), 4096);
  for (std::size_t i = 0; i < flips; ++i) bytes[random() % reach] ^= static_cast<char>(1u << (random() % 8));
  return bytes;
}

std::string scribbled(std::string bytes, std::mt19937_64& random) {
  const std::size_t first = random() % bytes.size(),
                    count = std::min<std::size_t>(random() % 64 + 1, bytes.size() - first);
  const bool same = random() % 2;
  const char value = static_cast<char>(random() % 3 == 0 ? 0xff : random());
  for (std::size_t i = first; i < first + count; ++i) bytes[i] = same ? value : static_cast<char>(random());
  return bytes;
}

std::vector<fs::path> samples() {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const fs::path& folder : {models_folder(), models_folder() / "nonclosed", models_folder() / "bvh",
                                 fs::path("/usr/share/assimp/models/Collada")})
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
      const std::string kind = entry.path().extension();
      const bool sample = kind == ".glb" || kind == ".gltf" || kind == ".fbx" || kind == ".x" ||
                          kind == ".dae" || kind == ".bvh";
      if (sample && entry.is_regular_file(ignored) && entry.file_size(ignored) < 2'000'000)
        files.push_back(entry.path());
    }
  std::sort(files.begin(), files.end());
  return files;
}

// $CSCD_HOSTILE damaged copies of each sample; a few without it.
TEST_F(Hostile, DamagedSamplesNeverCrashHangOrFillTheMemory) {
  const char* asked = std::getenv("CSCD_HOSTILE");
  const std::size_t copies = asked ? static_cast<std::size_t>(std::atoll(asked)) : 4;
  const std::vector<fs::path> files = samples();
  if (files.empty()) GTEST_SKIP() << "no samples in " << models_folder();
  std::mt19937_64 random(2014);
  for (const fs::path& file : files) {
    const std::string whole = read(file);
    const std::string damaged = scratch / ("damaged" + file.extension().string());
    for (std::size_t i = 0; i < copies && !HasFatalFailure(); ++i) {
      SCOPED_TRACE(file.string() + ", copy " + std::to_string(i));
      const std::size_t kind = i % 4;
      if (kind == 0) write(damaged, whole.substr(0, random() % (i % 8 == 0 ? whole.size() : 256)));
      if (kind == 1 || kind == 2) write(damaged, flipped(whole, random));
      if (kind == 3) write(damaged, scribbled(whole, random));
      attack(damaged);
    }
  }
  report("damaged samples");
}

TEST_F(Hostile, WhatIsNoModelAtAllIsRefused) {
  const std::string glb = std::string("glTF\x02\0\0\0", 8);
  const auto word = [](std::uint32_t n) {
    std::string bytes(4, '\0');
    for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<char>(n >> (8 * i));
    return bytes;
  };
  std::string noise(100'000, '\0');
  std::mt19937 random(1);
  for (char& c : noise) c = static_cast<char>(random());
  std::string deep = R"({"asset":{"version":"2.0"},"scenes":)";
  for (int i = 0; i < 200'000; ++i) deep += '[';
  const std::vector<std::pair<std::string, std::string>> files = {
      {"empty.glb", ""},
      {"empty.fbx", ""},
      {"noise.glb", noise},
      {"noise.fbx", noise},
      {"noise.dae", noise},
      {"noise.x", noise},
      {"noise.bvh", noise},
      {"noise.xyz", noise},
      {"noise.h5", noise},
      {"huge.glb", glb + word(0xffffffff) + word(0xfffffff0) + "JSON{}"},
      {"huge.fbx", std::string("Kaydara FBX Binary  \0\x1a\0", 23) + word(7400) + word(0xfffffff0) +
                       word(0xffffffff) + word(0xffffffff)},
      {"count.gltf",
       R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4000000000}],"bufferViews":[{"buffer":0,"byteLength":4000000000}],"accessors":[{"bufferView":0,"componentType":5126,"count":333333333,"type":"VEC3"}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],"scene":0})"},
      {"outside.gltf",
       R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":100,"uri":"../../../../../../../etc/passwd"}]})"},
      {"device.gltf", R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":100,"uri":"/dev/zero"}]})"},
      {"deep.gltf", deep},
      {"deep.dae", [] {
         std::string text = "<COLLADA version=\"1.4.1\">";
         for (int i = 0; i < 100'000; ++i) text += "<node>";
         return text;
       }()}};
  for (const auto& [name, bytes] : files) {
    SCOPED_TRACE(name);
    write(scratch.path / name, bytes);
    attack(scratch / name);
    attack(scratch / name);
  }
  // Not even opened: it would block.
  ASSERT_EQ(mkfifo((scratch / "pipe.glb").c_str(), 0600), 0);
  attack(scratch / "pipe.glb");
  fs::create_directories(scratch / "folder.glb");
  attack(scratch / "folder.glb");
  attack(scratch / "absent.glb");
  attack("/dev/zero");
  write(scratch.path / "large.fbx", "");
  fs::resize_file(scratch.path / "large.fbx", std::uintmax_t{1} << 40);
  attack(scratch / "large.fbx");
  EXPECT_EQ(accepted, 0u);
  report("no models");
}

// 20 GB of frames, nearly all of them a hole in the file, at both ends of the clip.
TEST(LargeClips, AreStreamed) {
  const Scratch scratch;
  const std::string file = scratch / "large.h5";
  const test::Shape sphere = test::icosphere(5);
  constexpr hsize_t frames = 82'000;
  const hsize_t stored[] = {0, 1, 2, frames - 2, frames - 1};
  scenes::write_sparse_cache(file, sphere, frames, stored);
  ASSERT_GT(frames * sphere.positions.size() * sizeof(Vec3), 20'000'000'000u);
  Limits limits;
  limits.memory_bytes = std::size_t{1} << 30;
  for (const char* range : {"0:2", "81998:81999"}) {
    const Outcome outcome =
        cscd({"query", file, "--frames", range, "--json", scratch / "out.json", "--force"}, limits);
    ASSERT_EQ(outcome.end, Outcome::End::exited) << to_text(outcome);
    EXPECT_EQ(outcome.code, 0) << outcome.errors;
#if !defined(__SANITIZE_ADDRESS__)
    EXPECT_LT(outcome.peak_bytes, std::size_t{200} << 20);
#endif
    const auto answer = nlohmann::json::parse(read(scratch / "out.json"));
    for (const auto& interval : answer["intervals"]) {
      EXPECT_EQ(interval["starts_embedded"], true) << "the frame that is stored there";
      EXPECT_EQ(interval["collides"], false);
    }
  }
}

}  // namespace
}  // namespace cscd::bench
