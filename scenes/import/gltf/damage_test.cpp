#include <cstdlib>
#include <ctime>
#include <new>
#include <random>

#include "scenes/import/gltf/test_compressed.h"

// Changes a few members or bytes in files of every kind at random. Each file must be read to finite
// positions, or refused, within a time limit.
namespace cscd::scenes::gltf {
namespace {

using Random = std::mt19937_64;

// A file with sparse positions, a strip, a cubic, weights of morph targets, a matrix and two sets of joints.
TubeFile with_everything() {
  TubeFile file;
  const std::vector<std::uint16_t> where = {1, 5};
  file.root["accessors"][0]["sparse"] = {
      {"count", 2},
      {"indices", {{"bufferView", file.view(where)}, {"componentType", 5123}, {"byteOffset", 0}}},
      {"values", {{"bufferView", file.view(std::vector<float>(6, 1))}, {"byteOffset", 0}}}};
  json& primitive = file.primitive();
  primitive["mode"] = 5;
  primitive["attributes"]["JOINTS_1"] = TubeFile::kJoints;
  primitive["attributes"]["WEIGHTS_1"] = TubeFile::kWeights;
  primitive["targets"] = {{{"POSITION", 0}}};
  file.root["nodes"][1]["weights"] = {0.5};
  file.root["nodes"][3] = {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1}}, {"children", {4}}};
  file.root["nodes"].push_back({{"mesh", 0}});
  file.root["scenes"].push_back({{"nodes", {0, 5}}});
  file.root["scene"] = 1;
  const int cubic = file.accessor(std::vector<float>(18, 0.25f), "VEC3");
  file.animate(2, "translation", {0, 2}, cubic, "CUBICSPLINE");
  file.animate(1, "weights", {0, 1}, file.accessor(std::vector<float>{0, 1}, "SCALAR"), "STEP");
  file.root["accessors"][1]["byteOffset"] = 0;
  file.root["bufferViews"][2]["byteStride"] = 16;
  return file;
}

void collect(json& value, std::vector<json*>& out) {
  for (auto& item : value) {
    out.push_back(&item);
    if (item.is_structured()) collect(item, out);
  }
}

void spoil_member(json& root, Random& random) {
  std::vector<json*> members;
  collect(root, members);
  json& member = *members[random() % members.size()];
  static const json kValues = json::parse(R"([-1, 0, 1, 2, 5, 0.5, 1e300, 1e-300, -1e18, 255, 65536, 5121,
      5126, "x", null, true, [], {}, "VEC3", "MAT4", 2147483647, 4294967296, 1000000, 18446744073709551615])");
  if (random() % 8 == 0 && member.is_structured() && !member.empty()) {
    if (member.is_object())
      member.erase(std::next(member.begin(), static_cast<std::ptrdiff_t>(random() % member.size())).key());
    else
      member.erase(random() % member.size());
  } else if (random() % 4 == 0 && member.is_number_integer()) {
    member = member.get<std::int64_t>() + static_cast<std::int64_t>(random() % 5) - 2;
  } else {
    member = kValues[random() % kValues.size()];
  }
}

void spoil_bytes(std::string& bytes, Random& random) {
  const std::size_t first = random() % bytes.size(),
                    count = std::min<std::size_t>(1 + random() % 16, bytes.size() - first);
  const bool same = random() % 2;
  for (std::size_t i = first; i < first + count; ++i) bytes[i] = same ? '\xff' : static_cast<char>(random());
}

// Returns whether the file was accepted.
bool survives(const std::string& bytes) {
  try {
    const Character character = read_bytes(bytes);
    for (const Animation& clip : character.animations) {
      std::vector<Vec3> positions;
      skin(character, pose_at(character, clip, clip.start), weights_at(character, clip, clip.start),
           positions);
    }
    return true;
  } catch (const InputError&) {
  } catch (const std::bad_alloc&) {  // the importer reports this as a lack of memory
  }
  return false;
}

TEST(GltfDamage, DamagedFilesAreReadOrRefused) {
  const char* asked = std::getenv("CSCD_HOSTILE");
  const int copies = asked ? 20 * std::atoi(asked) : 300;
  Random random(2014);
  std::size_t accepted = 0, runs = 0;
  for (const TubeFile& whole : {TubeFile(), with_everything(), with_meshopt(), with_draco()}) {
    ASSERT_TRUE(survives(whole.glb()));
    for (int i = 0; i < copies; ++i) {
      TubeFile file = whole;
      const std::size_t changes = 1 + random() % 3;
      for (std::size_t c = 0; c < changes; ++c)
        if (i % 2 == 0)
          spoil_member(file.root, random);
        else
          spoil_bytes(file.bytes, random);
      const std::clock_t start = std::clock();  // processor time: others may use the machine too
      std::string bytes;
      try {
        bytes = file.glb();
      } catch (const json::exception&) {  // the damage has turned the buffers into another kind
        bytes = file.root.dump();
      }
      accepted += survives(bytes);
      ++runs;
      ASSERT_LT(std::clock() - start, 10 * CLOCKS_PER_SEC) << file.root.dump();
    }
  }
  EXPECT_GT(accepted, runs / 20);
  EXPECT_LT(accepted, runs);
}

}  // namespace
}  // namespace cscd::scenes::gltf
