#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <gtest/gtest.h>
#include <random>
#include <sys/stat.h>

#include "bench/testing/test_generated.h"

namespace cscd::bench {
namespace {

// A reader of untrusted files may answer, or refuse in one line, within its limits, and nothing else.
class Hostile : public testing::Test {
 protected:
  static constexpr double kImportSeconds = 5;
  static constexpr std::size_t kImportMiB = 1024;

  void attack(const std::string& file) {
    const bool ask = ++runs % 2 == 0;
    std::vector<std::string> arguments{ask ? "query" : "inspect", file};
    if (ask)
      arguments.insert(arguments.end(), {"--frames", "0:1", "--interval-seconds", "10", "--json",
                                         scratch / "out.json", "--force"});
    arguments.insert(arguments.end(), {"--import-seconds", std::to_string(kImportSeconds), "--import-memory",
                                       std::to_string(kImportMiB)});
    Limits limits;
    limits.memory_bytes = std::size_t{2 * kImportMiB} << 20;
    limits.seconds = 30;
    const Outcome outcome = cscd(arguments, limits);
    slowest = std::max(slowest, outcome.seconds);
    largest = std::max(largest, outcome.peak_bytes);
    ASSERT_EQ(outcome.end, Outcome::End::exited) << to_text(outcome) << kept(file);
    ASSERT_TRUE(outcome.code == 0 || outcome.code == 2) << to_text(outcome) << kept(file);
    accepted += outcome.code == 0;
    if (outcome.code == 0) {
      EXPECT_EQ(outcome.errors, "") << file;
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

  void report(const char* what) const {
    std::printf(
        "%s: %zu runs, %zu accepted, %zu refused, %zu of them lost importers, %zu late; slowest %.1f s, "
        "largest %zu MiB\n",
        what, runs, accepted, runs - accepted, crashed, timed_out, slowest, largest >> 20);
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

// Generated characters, the shared models, and those of Debian's assimp-testmodels.
std::vector<fs::path> samples(const Scratch& scratch) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const fs::path& folder : {models_folder(), fs::path("/usr/share/assimp/models")})
    for (const auto& entry : fs::recursive_directory_iterator(folder, ignored)) {
      std::string kind = entry.path().extension();
      for (char& c : kind) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      const bool sample = kind == ".glb" || kind == ".gltf" || kind == ".fbx" || kind == ".x" ||
                          kind == ".dae" || kind == ".bvh";
      const std::uintmax_t bytes = sample && entry.is_regular_file(ignored) ? entry.file_size(ignored) : 0;
      if (bytes > 0 && bytes < 2'000'000) files.push_back(entry.path());
    }
  std::sort(files.begin(), files.end());
  for (const GeneratedCharacter& generated : kGenerated)
    files.insert(files.begin(), character_file(generated.name, scratch));
  return files;
}

// $CSCD_HOSTILE damaged copies of each sample; a few without it.
TEST_F(Hostile, DamagedSamplesNeverCrashHangOrFillTheMemory) {
  const char* asked = std::getenv("CSCD_HOSTILE");
  const std::size_t copies = asked ? static_cast<std::size_t>(std::atoll(asked)) : 4;
  for (const fs::path& file : samples(scratch)) {
    const std::string name = file.filename();  // alone decides the damage, whatever other samples there are
    std::seed_seq seed(name.begin(), name.end());
    std::mt19937_64 random(seed);
    const std::string whole = read(file);
    const std::string damaged = scratch / ("damaged" + file.extension().string());
    for (std::size_t i = 0; i < copies && !HasFatalFailure(); ++i) {
      SCOPED_TRACE(file.string() + ", copy " + std::to_string(i));
      const std::size_t kind = i % 4;
      const bool gltf = file.extension() == ".glb" || file.extension() == ".gltf";
      if (kind == 0) write(damaged, whole.substr(0, random() % (i % 8 == 0 ? whole.size() : 256)));
      if (kind == 1 || kind == 2)
        write(damaged, gltf && kind == 2 ? with_other_numbers(whole, random) : flipped(whole, random));
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

}  // namespace
}  // namespace cscd::bench
