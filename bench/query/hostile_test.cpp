#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <gtest/gtest.h>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <sys/stat.h>

#include "bench/inputs/input.h"
#include "bench/output/schema.h"
#include "bench/testing/test_generated.h"

namespace cscd::bench {
namespace {

// A reader of untrusted files may answer, or refuse in one line, within its limits, and nothing else.
class Hostile : public testing::Test {
 protected:
  static constexpr double kImportSeconds = 20;
  static constexpr std::size_t kImportMiB = 1024;

  // Queries, inspects and exports by turns.
  void attack(const std::string& file) {
    constexpr std::array<const char*, 3> kCommands = {"query", "inspect", "export"};
    const std::string command = kCommands[runs++ % kCommands.size()], answer = scratch / "out.json",
                      frames = scratch / "out.h5";
    std::vector<std::string> arguments{command, file};
    if (command == "query")  // few intervals of every clip
      arguments.insert(arguments.end(), {"--fps", "1", "--interval-seconds", "10"});
    if (command == "export") arguments.push_back(frames);
    if (command != "export") arguments.insert(arguments.end(), {"--json", answer});
    arguments.insert(arguments.end(), {"--force", "--import-seconds", std::to_string(kImportSeconds),
                                       "--import-memory", std::to_string(kImportMiB)});
    Limits limits;
    limits.memory_bytes = std::size_t{2 * kImportMiB} << 20;
    limits.seconds =
        300;  // many times what the program's own limits come to, because the machine may be busy
    const Outcome outcome = cscd(arguments, limits);
    slowest = std::max(slowest, outcome.seconds);
    largest = std::max(largest, outcome.peak_bytes);
    ASSERT_EQ(outcome.end, Outcome::End::exited) << command << to_text(outcome) << kept(file);
    ASSERT_TRUE(outcome.code == 0 || outcome.code == 2) << command << to_text(outcome) << kept(file);
    if (outcome.code == 0) {
      ++accepted;
      EXPECT_EQ(outcome.errors, "") << file;
      if (command == "query") expect_sound_answer(read(answer));
      if (command == "export") expect_finite_frames(frames);
      if (HasFailure()) std::printf("%s%s\n", command.c_str(), kept(file).c_str());
    } else {
      EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << file << outcome.errors;
      EXPECT_TRUE(outcome.errors.starts_with("cscd: ")) << file << outcome.errors;
      crashed += outcome.errors.find("crashed") != std::string::npos;
      timed_out += outcome.errors.find("-seconds") != std::string::npos;
    }
#if !defined(__SANITIZE_ADDRESS__)
    EXPECT_LT(outcome.peak_bytes, (kImportMiB + 256) << 20) << file;
#endif
  }

  // JSON has no word for a number that is not finite: it becomes null, which the schema allows in few places.
  void expect_sound_answer(const std::string& text) {
    const auto answer = nlohmann::ordered_json::parse(text, nullptr, false);
    ASSERT_FALSE(answer.is_discarded()) << text;
    EXPECT_EQ(schema_violation(answer, "query.schema.json"), "");
    const auto clips = answer.value("clips", nlohmann::ordered_json::array({answer}));
    for (const auto& clip : clips)
      for (const auto& interval : clip.at("intervals")) {
        EXPECT_TRUE(interval.at("seconds").is_number()) << "a model file has a rate";
        ++verdicts[interval.at("verdict")];
      }
  }

  void expect_finite_frames(const std::string& file) {
    const Input input = open_input(file);
    const auto finite = [](const Vec3& x) { return x.allFinite(); };
    EXPECT_TRUE(std::ranges::all_of(input.rest(), finite));
    for (std::size_t i = 0; i < input.clip->frame_count(); ++i)
      ASSERT_TRUE(std::ranges::all_of(input.clip->load_frame(i).positions, finite)) << "frame " << i;
    exported_frames += input.clip->frame_count();
  }

  // The figures are also properties of the test, which --gtest_output=json:FILE writes.
  void report(const char* what, std::size_t samples) {
    std::printf(
        "%s: %zu samples, %zu runs, %zu accepted, %zu refused, %zu of them lost importers, %zu late; slowest "
        "%.1f s, largest %zu MiB; %zu frames exported, all finite;",
        what, samples, runs, accepted, runs - accepted, crashed, timed_out, slowest, largest >> 20,
        exported_frames);
    for (const auto& [verdict, count] : verdicts) {
      std::printf(" %s %zu", verdict.c_str(), count);
      RecordProperty("verdict_" + verdict, static_cast<int>(count));
    }
    std::printf("\n");
    const std::pair<const char*, std::size_t> figures[] = {
        {"samples", samples},
        {"runs", runs},
        {"accepted", accepted},
        {"refused", runs - accepted},
        {"lost_importers", crashed},
        {"late", timed_out},
        {"slowest_ms", static_cast<std::size_t>(slowest * 1000)},
        {"largest_mib", largest >> 20},
        {"exported_frames", exported_frames}};
    for (const auto& [name, value] : figures) RecordProperty(name, static_cast<int>(value));
  }

  // A file that did it outlives the test.
  std::string kept(const std::string& file) const {
    const fs::path copy =
        fs::temp_directory_path() / ("cscd-hostile-" + std::to_string(getpid()) + "-" + std::to_string(runs) +
                                     fs::path(file).extension().string());
    std::error_code error;
    fs::copy_file(file, copy, error);
    return error ? ": " + file : "; kept as " + copy.string();
  }

  const Scratch scratch;
  std::size_t runs = 0, accepted = 0, crashed = 0, timed_out = 0, largest = 0, exported_frames = 0;
  double slowest = 0;
  std::map<std::string, std::size_t> verdicts;  // of the intervals that were queried
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

// The JSON text of a glTF file with some of its numbers exchanged for others; the binary chunk of a .glb file
// stays as it is. Bytes changed at random seldom leave JSON that can still be read.
std::string with_other_numbers(const std::string& file, std::mt19937_64& random) {
  constexpr std::array kValues = {"-1",    "0",          "2",          "0.5", "1e300", "65536",
                                  "5121",  "2147483647", "4294967296", "[]",  "{}",    "null",
                                  "\"x\"", "true",       "99999999",   "-0.0"};
  const auto word = [&](std::size_t at) {
    std::uint32_t n = 0;
    std::memcpy(&n, file.data() + at, sizeof n);
    return static_cast<std::size_t>(n);
  };
  const bool binary = file.size() > 20 && file.starts_with("glTF");
  const std::size_t begin = binary ? 20 : 0,
                    size = binary ? std::min(word(12), file.size() - begin) : file.size();
  std::string text = file.substr(begin, size);
  const std::size_t changes = std::size_t{1} << (random() % 3);
  for (std::size_t i = 0; i < changes; ++i) {
    const std::size_t first = text.find_first_of("0123456789", text.find(':', random() % text.size()));
    if (first == std::string::npos) continue;
    const std::size_t end = std::min(text.find_first_not_of("0123456789.eE+-", first), text.size());
    text.replace(first, end - first, kValues[random() % kValues.size()]);
  }
  if (!binary) return text;
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto bytes = [](std::size_t n) {
    const auto number = static_cast<std::uint32_t>(n);
    return std::string(reinterpret_cast<const char*>(&number), sizeof number);
  };
  const std::string rest = file.substr(begin + size);
  return file.substr(0, 8) + bytes(begin + text.size() + rest.size()) + bytes(text.size()) +
         file.substr(16, 4) + text + rest;
}

// The lower-case extension of a file's name, with its dot.
std::string extension(const fs::path& file) {
  std::string kind = file.extension();
  for (char& c : kind) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return kind;
}

// Generated characters, the shared models, and those of Debian's assimp-testmodels, with this extension.
std::vector<fs::path> samples(const std::string& kind, const Scratch& scratch) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const fs::path& folder : {models_folder(), fs::path("/usr/share/assimp/models")})
    for (const auto& entry : fs::recursive_directory_iterator(folder, ignored)) {
      const bool sample = extension(entry.path()) == kind && entry.is_regular_file(ignored);
      const std::uintmax_t bytes = sample ? entry.file_size(ignored) : 0;
      if (bytes > 0 && bytes < 2'000'000) files.push_back(entry.path());
    }
  std::sort(files.begin(), files.end());
  for (const GeneratedCharacter& generated : kGenerated)
    if (extension(generated.name) == kind)
      files.insert(files.begin(), character_file(generated.name, scratch));
  return files;
}

class HostileKinds : public Hostile, public testing::WithParamInterface<const char*> {};

// Makes $CSCD_HOSTILE damaged copies of each sample, or a few without it. $CSCD_HOSTILE_SAMPLE names the one
// sample to damage, for instance to repeat a failure.
TEST_P(HostileKinds, DamagedSamplesNeverCrashHangOrFillTheMemory) {
  const char* asked = std::getenv("CSCD_HOSTILE");
  const std::size_t copies = asked ? static_cast<std::size_t>(std::atoll(asked)) : 2;
  std::vector<fs::path> files = samples(std::string(".") + GetParam(), scratch);
  if (const char* only = std::getenv("CSCD_HOSTILE_SAMPLE"))
    std::erase_if(files, [&](const fs::path& file) { return file.filename() != only; });
  if (files.empty()) GTEST_SKIP() << "no samples of this kind";
  for (const fs::path& file : files) {
    const std::string name = file.filename();  // alone decides the damage, whatever other samples there are
    std::seed_seq seed(name.begin(), name.end());
    std::mt19937_64 random(seed);
    const std::string whole = read(file);
    const std::string damaged = scratch / ("damaged" + file.extension().string());
    const std::size_t first_kind = copies < 4 ? random() % 4 : 0;
    for (std::size_t i = 0; i < copies && !HasFatalFailure(); ++i) {
      SCOPED_TRACE(file.string() + ", copy " + std::to_string(i));
      const std::size_t kind = (first_kind + i) % 4;
      const bool gltf = file.extension() == ".glb" || file.extension() == ".gltf";
      if (kind == 0) write(damaged, whole.substr(0, random() % (i % 8 == 0 ? whole.size() : 256)));
      if (kind == 1 || kind == 2)
        write(damaged, gltf && kind == 2 ? with_other_numbers(whole, random) : flipped(whole, random));
      if (kind == 3) write(damaged, scribbled(whole, random));
      attack(damaged);
    }
  }
  report("damaged samples", files.size());
}

INSTANTIATE_TEST_SUITE_P(Damaged, HostileKinds, testing::Values("glb", "gltf", "fbx", "dae", "x", "bvh"),
                         [](const auto& kind) { return std::string(kind.param); });

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
  report("no models", files.size());
}

}  // namespace
}  // namespace cscd::bench
