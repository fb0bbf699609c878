#pragma once

#include <cstring>
#include <filesystem>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

#include "core/base/test_folder.h"
#include "core/base/test_refusal.h"
#include "scenes/base/test_says.h"
#include "scenes/character/pose.h"
#include "scenes/character/test_characters.h"
#include "scenes/import/gltf/read_gltf.h"

// glTF files that a test builds in code, so that it can change one thing in them and read the result.
namespace cscd::scenes::gltf {

using nlohmann::json;

template <class Number>
inline constexpr int kComponent = sizeof(Number) == 1   ? (std::is_signed_v<Number> ? 5120 : 5121)
                                  : sizeof(Number) == 2 ? (std::is_signed_v<Number> ? 5122 : 5123)
                                                        : 5125;
template <>
inline constexpr int kComponent<float> = 5126;

// A file of one buffer. Tests change members of `root` at will.
struct TestFile {
  json root = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};
  std::string bytes;

  int view(const void* data, std::size_t size) {
    bytes.resize((bytes.size() + 3) / 4 * 4);
    root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", size}});
    bytes.append(static_cast<const char*>(data), size);
    return static_cast<int>(root["bufferViews"].size()) - 1;
  }
  template <class Number>
  int view(const std::vector<Number>& numbers) {
    return view(numbers.data(), numbers.size() * sizeof(Number));
  }

  template <class Number>
  int accessor(const std::vector<Number>& numbers, const std::string& type, bool normalized = false) {
    const std::size_t width = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : type == "VEC4" ? 4 : 3;
    root["accessors"].push_back({{"bufferView", view(numbers)},
                                 {"componentType", kComponent<Number>},
                                 {"count", numbers.size() / width},
                                 {"type", type}});
    if (normalized) root["accessors"].back()["normalized"] = true;
    return static_cast<int>(root["accessors"].size()) - 1;
  }

  json& primitive(int mesh = 0) { return root["meshes"][static_cast<std::size_t>(mesh)]["primitives"][0]; }

  // Adds a channel with a sampler of its own to the first clip.
  void animate(int node, const std::string& path, const std::vector<float>& times, int output,
               const std::string& interpolation = "LINEAR") {
    json& clip = root["animations"][0];
    clip["channels"].push_back(
        {{"sampler", clip["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
    clip["samplers"].push_back(
        {{"input", accessor(times, "SCALAR")}, {"output", output}, {"interpolation", interpolation}});
  }

  std::string glb() const {
    json whole = root;
    if (!bytes.empty()) whole["buffers"][0]["byteLength"] = bytes.size();
    std::string text = whole.dump(), binary = bytes;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    const auto word = [](std::size_t n) {
      const auto number = static_cast<std::uint32_t>(n);
      std::string out(4, '\0');
      std::memcpy(out.data(), &number, 4);
      return out;
    };
    return "glTF" + word(2) + word(28 + text.size() + binary.size()) + word(text.size()) + "JSON" + text +
           word(binary.size()) + std::string("BIN\0", 4) + binary;
  }
};

// A folder that is removed after the test.
struct TestFolder : test::Folder {
  std::filesystem::path write(const std::string& name, const std::string& contents) const {
    test::write(path / name, contents);
    return path / name;
  }
};

inline Character read_bytes(const std::string& contents, const CharacterLimits& limits = {}) {
  const TestFolder folder;
  Character character = read_gltf(folder.write("test.glb", contents), limits);
  validate(character, limits);
  return character;
}
inline Character read(const TestFile& file, const CharacterLimits& limits = {}) {
  return read_bytes(file.glb(), limits);
}

// Returns the error that a file is refused with; empty where the file is accepted.
inline std::string refusal(const TestFile& file, const CharacterLimits& limits = {}) {
  return test::refusal([&] { read(file, limits); });
}

inline bool has_note(const Character& character, const std::string& words) {
  for (const std::string& note : character.notes)
    if (note.find(words) != std::string::npos) return true;
  return false;
}

inline std::vector<Vec3> positions_at(const Character& character, double seconds) {
  std::vector<Vec3> positions;
  const Animation& clip = character.animations.at(0);
  skin(character, pose_at(character, clip, seconds), weights_at(character, clip, seconds), positions);
  return positions;
}

inline void expect_same(const std::vector<Vec3>& got, const std::vector<Vec3>& wanted, double tolerance) {
  ASSERT_EQ(got.size(), wanted.size());
  for (std::size_t v = 0; v < got.size(); ++v)
    ASSERT_LT((got[v] - wanted[v]).norm(), tolerance) << "vertex " << v;
}

inline void expect_same_motion(const Character& got, const Character& wanted, double tolerance = 1e-6) {
  for (const double seconds : {0.0, 0.3, 0.5, 1.0})
    expect_same(positions_at(got, seconds), positions_at(wanted, seconds), tolerance);
}

inline std::vector<float> flat(const std::vector<Vec3>& vectors) {
  std::vector<float> out;
  for (const Vec3& v : vectors)
    for (const double x : v) out.push_back(static_cast<float>(x));
  return out;
}

// The numbers of a part's mesh, with four joints and weights a vertex.
struct MeshNumbers {
  std::vector<float> positions, weights;
  std::vector<std::uint8_t> joints;
  std::vector<std::uint16_t> corners;

  explicit MeshNumbers(const Part& part) : positions(flat(part.positions)) {
    for (std::size_t v = 0; v < part.positions.size(); ++v)
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t i = part.first[v] + k;
        const bool any = i < part.first[v + 1];
        joints.push_back(any ? static_cast<std::uint8_t>(part.influences[i].joint) : 0);
        weights.push_back(any ? static_cast<float>(part.influences[i].weight) : 0);
      }
    for (const auto& triangle : part.triangles)
      for (const std::int32_t corner : triangle) corners.push_back(static_cast<std::uint16_t>(corner));
  }
};

// A file of the tube of bending_tube(): nodes 0 to 4, skin 0, mesh 0, clip 'bend'. The constants give the
// numbers of the accessors.
struct TubeFile : TestFile {
  const Character character = bending_tube();
  const MeshNumbers numbers{character.parts[0]};
  static constexpr int kPositions = 0, kJoints = 1, kWeights = 2, kCorners = 3, kOffsets = 4;
  static constexpr int kUpper = 4;  // the node that turns
  const float half = std::sqrt(0.5f);

  TubeFile() {
    accessor(numbers.positions, "VEC3");
    accessor(numbers.joints, "VEC4");
    accessor(numbers.weights, "VEC4");
    accessor(numbers.corners, "SCALAR");
    accessor(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,
                                1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -2, 0, 0, 1},
             "MAT4");
    root["meshes"] = {
        {{"name", "tube"},
         {"primitives",
          {{{"attributes", {{"POSITION", kPositions}, {"JOINTS_0", kJoints}, {"WEIGHTS_0", kWeights}}},
            {"indices", kCorners}}}}}};
    root["skins"] = {{{"joints", {2, 4}}, {"inverseBindMatrices", kOffsets}}};
    root["nodes"] = {{{"name", "root"}, {"translation", {0, 0, 5}}, {"children", {1, 2}}},
                     {{"name", "tube"}, {"mesh", 0}, {"skin", 0}},
                     {{"name", "lower"}, {"children", {3}}},
                     {{"name", "helper"}, {"translation", {1, 0, 0}}, {"children", {4}}},
                     {{"name", "upper"}, {"translation", {1, 0, 0}}}};
    root["animations"] = {{{"name", "bend"}, {"channels", json::array()}, {"samplers", json::array()}}};
    animate(kUpper, "rotation", {0, 1}, accessor(std::vector<float>{0, 0, 0, 1, 0, 0, half, half}, "VEC4"));
  }
};

// A member of a file, the value that spoils the member, and words of the refusal that names what is wrong.
struct Spoiled {
  const char *where, *value, *words;
};

// Spoils one member of the file at a time. `within` is the JSON pointer to which the members are relative.
inline void expect_refusals(const TubeFile& whole, const std::string& within,
                            std::initializer_list<Spoiled> members) {
  for (const auto& [where, value, words] : members) {
    TubeFile file = whole;
    file.root[json::json_pointer(within + where)] = json::parse(value);
    EXPECT_TRUE(says(refusal(file), words)) << where << " = " << value;
  }
}

}  // namespace cscd::scenes::gltf
