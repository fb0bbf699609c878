#include "scenes/import/gltf/test_files.h"

// The way in which an accessor's numbers lie in a file must not matter.
namespace cscd::scenes::gltf {
namespace {

TEST(GltfAccessors, APlainFileMovesAsItsCharacter) {
  expect_same_motion(read(TubeFile()), bending_tube());
}

template <class Number>
std::vector<Number> scaled(const std::vector<float>& numbers, double largest) {
  std::vector<Number> out;
  for (const float x : numbers)
    out.push_back(static_cast<Number>(std::lround(static_cast<double>(x) * largest)));
  return out;
}

TEST(GltfAccessors, WeightsMayBeNormalizedIntegers) {
  TubeFile shorts, bytes;
  shorts.primitive()["attributes"]["WEIGHTS_0"] =
      shorts.accessor(scaled<std::uint16_t>(shorts.numbers.weights, 65535), "VEC4", true);
  expect_same_motion(read(shorts), bending_tube(), 2e-4);
  bytes.primitive()["attributes"]["WEIGHTS_0"] =
      bytes.accessor(scaled<std::uint8_t>(bytes.numbers.weights, 255), "VEC4", true);
  expect_same_motion(read(bytes), bending_tube(), 3e-2);
}

TEST(GltfAccessors, JointsMayBeShorts) {
  TubeFile file;
  file.primitive()["attributes"]["JOINTS_0"] = file.accessor(
      std::vector<std::uint16_t>(file.numbers.joints.begin(), file.numbers.joints.end()), "VEC4");
  expect_same_motion(read(file), bending_tube());
}

TEST(GltfAccessors, RotationsMayBeNormalizedIntegers) {
  const double half = std::sqrt(0.5);
  TubeFile shorts, bytes;
  const auto s = static_cast<std::int16_t>(std::lround(32767 * half));
  const int turned = shorts.accessor(std::vector<std::int16_t>{0, 0, 0, 32767, 0, 0, s, s}, "VEC4", true);
  shorts.root["animations"][0]["samplers"][0]["output"] = turned;
  expect_same_motion(read(shorts), bending_tube(), 1e-6);
  const auto b = static_cast<std::int8_t>(std::lround(127 * half));
  bytes.root["animations"][0]["samplers"][0]["output"] =
      bytes.accessor(std::vector<std::int8_t>{0, 0, 0, 127, 0, 0, b, b}, "VEC4", true);
  expect_same_motion(read(bytes), bending_tube(), 1e-6);
  // Integers that are not marked as normalized have no meaning as a rotation.
  shorts.root["accessors"][static_cast<std::size_t>(turned)].erase("normalized");
  EXPECT_TRUE(says(refusal(shorts), "without being normalized"));
}

// Positions are 16-bit integers in a box, and the joints' bind matrices undo the scale of the box
// (KHR_mesh_quantization).
TEST(GltfAccessors, PositionsMayBeQuantized) {
  for (const bool normalized : {true, false}) {
    TubeFile file;
    const double largest = normalized ? 32767 : 1, unit = normalized ? 4 : 1.0 / 1024;
    std::vector<float> small;
    for (const float x : file.numbers.positions)
      small.push_back(static_cast<float>(static_cast<double>(x) / unit));
    file.primitive()["attributes"]["POSITION"] =
        file.accessor(scaled<std::int16_t>(small, largest), "VEC3", normalized);
    // Elements of three shorts are padded to four.
    std::vector<std::int16_t> padded;
    const auto numbers = scaled<std::int16_t>(small, largest);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      padded.push_back(numbers[i]);
      if (i % 3 == 2) padded.push_back(0);
    }
    const int view = file.view(padded);
    file.root["bufferViews"][static_cast<std::size_t>(view)]["byteStride"] = 8;
    file.root["accessors"].back()["bufferView"] = view;
    const auto u = static_cast<float>(unit);
    file.root["skins"][0]["inverseBindMatrices"] =
        file.accessor(std::vector<float>{u, 0, 0, 0, 0, u, 0, 0, 0, 0, u, 0, 0,  0, 0, 1,
                                         u, 0, 0, 0, 0, u, 0, 0, 0, 0, u, 0, -2, 0, 0, 1},
                      "MAT4");
    file.root["extensionsUsed"] = file.root["extensionsRequired"] = {"KHR_mesh_quantization"};
    expect_same_motion(read(file), bending_tube(), 2e-3);
  }
}

TEST(GltfAccessors, IndicesMayBeOfEveryWidthOrAbsent) {
  TubeFile bytes, ints, none;
  std::vector<std::uint8_t> few(30);
  for (std::size_t i = 0; i < few.size(); ++i) few[i] = static_cast<std::uint8_t>(bytes.numbers.corners[i]);
  bytes.primitive()["indices"] = bytes.accessor(few, "SCALAR");
  const Character from_bytes = read(bytes);
  ASSERT_EQ(from_bytes.parts[0].triangles.size(), 10u);
  EXPECT_EQ(from_bytes.parts[0].triangles[9], bending_tube().parts[0].triangles[9]);
  ints.primitive()["indices"] = ints.accessor(
      std::vector<std::uint32_t>(ints.numbers.corners.begin(), ints.numbers.corners.end()), "SCALAR");
  EXPECT_EQ(read(ints).parts[0].triangles, bending_tube().parts[0].triangles);
  none.primitive().erase("indices");
  const Character without = read(none);
  EXPECT_EQ(without.parts[0].triangles[1], (std::array<std::int32_t, 3>{3, 4, 5}));
}

TEST(GltfAccessors, OffsetsAndStridesAreFollowed) {
  TubeFile file;
  // Positions and weights lie side by side, in 12 and 16 bytes, after 8 bytes that are not used.
  const std::size_t count = file.character.parts[0].positions.size();
  std::vector<float> mixed(2, 7.f);
  for (std::size_t v = 0; v < count; ++v) {
    for (std::size_t k = 0; k < 3; ++k) mixed.push_back(file.numbers.positions[3 * v + k]);
    for (std::size_t k = 0; k < 4; ++k) mixed.push_back(file.numbers.weights[4 * v + k]);
  }
  const auto view = static_cast<std::size_t>(file.view(mixed));
  file.root["bufferViews"][view]["byteStride"] = 28;
  for (const auto& [accessor, offset] : {std::pair(TubeFile::kPositions, 8), {TubeFile::kWeights, 20}}) {
    file.root["accessors"][static_cast<std::size_t>(accessor)]["bufferView"] = view;
    file.root["accessors"][static_cast<std::size_t>(accessor)]["byteOffset"] = offset;
  }
  expect_same_motion(read(file), bending_tube());
  // Moved by one byte more, the last element ends beyond the view.
  file.root["accessors"][TubeFile::kWeights]["byteOffset"] = 21;
  EXPECT_TRUE(says(refusal(file), "beyond their buffer view"));
}

TEST(GltfAccessors, SparseNumbersReplaceOthers) {
  TubeFile file;
  std::vector<float> spoiled = file.numbers.positions;
  const std::vector<std::uint16_t> where = {1, 5};
  std::vector<float> right;
  for (const std::size_t v : where)
    for (std::size_t k = 0; k < 3; ++k) right.push_back(std::exchange(spoiled[3 * v + k], 99.f));
  file.primitive()["attributes"]["POSITION"] = file.accessor(spoiled, "VEC3");
  const json sparse = {{"count", 2},
                       {"indices", {{"bufferView", file.view(where)}, {"componentType", 5123}}},
                       {"values", {{"bufferView", file.view(right)}}}};
  json& accessor = file.root["accessors"].back();
  accessor["sparse"] = sparse;
  expect_same_motion(read(file), bending_tube());
  // The sparse part replaces an element that does not exist.
  const std::vector<std::uint16_t> beyond = {1, 30000};
  accessor["sparse"]["indices"]["bufferView"] = file.view(beyond);
  EXPECT_TRUE(says(refusal(file), "sparse part: replaces element 30000"));
}

TEST(GltfAccessors, SparseNumbersNeedNoOthers) {
  TubeFile file;
  const std::size_t count = file.character.parts[0].positions.size();
  std::vector<std::uint32_t> where(count);
  for (std::size_t v = 0; v < count; ++v) where[v] = static_cast<std::uint32_t>(v);
  json& accessor = file.root["accessors"][TubeFile::kPositions];
  accessor.erase("bufferView");
  accessor["sparse"] = {{"count", count},
                        {"indices", {{"bufferView", file.view(where)}, {"componentType", 5125}}},
                        {"values", {{"bufferView", file.view(file.numbers.positions)}}}};
  // Indices may be sparse too.
  std::vector<std::uint16_t> corner_places(file.numbers.corners.size());
  for (std::size_t i = 0; i < corner_places.size(); ++i) corner_places[i] = static_cast<std::uint16_t>(i);
  json& corners = file.root["accessors"][TubeFile::kCorners];
  corners.erase("bufferView");
  corners["sparse"] = {{"count", corner_places.size()},
                       {"indices", {{"bufferView", file.view(corner_places)}, {"componentType", 5123}}},
                       {"values", {{"bufferView", file.view(file.numbers.corners)}}}};
  const Character character = read(file);
  expect_same_motion(character, bending_tube());
  EXPECT_EQ(character.parts[0].triangles, bending_tube().parts[0].triangles);
}

TEST(GltfAccessors, WhatDoesNotFitIsRefused) {
  expect_refusals(
      TubeFile(), "",
      {
          {"/accessors/0/count", "1000000000", "more than the"},
          {"/accessors/0/count", "100000", "beyond their buffer view"},
          {"/accessors/0/count", "-1", "accessors[0].count is not a whole number"},
          {"/accessors/0/count", "3.5", "accessors[0].count is not a whole number"},
          {"/accessors/0/count", "1e300", "accessors[0].count is not a whole number"},
          {"/accessors/0/count", "18446744073709551615", "accessors[0].count is not a whole number"},
          {"/accessors/0/byteOffset", "-4", "accessors[0].byteOffset"},
          {"/accessors/0/byteOffset", "2147483647", "beyond their buffer view"},
          {"/accessors/0/bufferView", "77", "buffer view 77"},
          {"/accessors/0/componentType", "5125", "UNSIGNED_INT, which glTF does not allow"},
          {"/accessors/0/componentType", "5124", "INT, which glTF does not allow"},
          {"/accessors/0/componentType", "5130", "unknown, which glTF does not allow"},
          {"/accessors/0/type", "\"VEC2\"", "have a wrong type"},
          {"/accessors/0/type", "\"VEC5\"", "VEC5"},
          {"/accessors/0/normalized", "1", "neither true nor false"},
          {"/accessors/1/componentType", "5126", "FLOAT, which glTF does not allow"},
          {"/accessors/2/count", "4", "one entry each a vertex"},
          {"/bufferViews/0/buffer", "1", "buffer 1 of 1"},
          {"/bufferViews/0/byteLength", "2147483647", "reaches beyond its buffer"},
          {"/bufferViews/0/byteOffset", "2147483647", "reaches beyond its buffer"},
          {"/bufferViews/0/byteStride", "8", "overlap"},
          {"/bufferViews/0/byteStride", "13", "byteStride"},
          {"/meshes/0/primitives/0/indices", "99", "99"},
          {"/meshes/0/primitives/0/attributes/POSITION", "99", "accessor 99"},
          {"/meshes/0/primitives/0/attributes/POSITION", "\"0\"", "attributes.POSITION"},
          {"/skins/0/joints/0", "12", "joint 12"},
          {"/skins/0/inverseBindMatrices", "0", "wrong type"},
          {"/skins/0/joints", "[2]", "names joint 1 of the skin's 1"},
          {"/skins/0/joints", "[2, 3, 4]", "3 joints, but 2 inverse bind matrices"},
          {"/nodes/1/mesh", "5", "mesh 5"},
          {"/nodes/1/skin", "5", "skin 5"},
          {"/nodes/1/translation", "[1, 2]", "a list of 3 numbers"},
          {"/nodes/1/translation", "[1, 2, \"3\"]", "something else than numbers"},
          {"/nodes/1/scale", "1", "a list of 3 numbers"},
          {"/nodes/4/translation", "[1e200, 0, 0]", "beyond 1e15"},
          {"/nodes", "{}", "'nodes' is not a list"},
          {"/nodes/1", "3", "nodes[1] is not an object"},
          {"/scene", "4", "scene 4"},
          {"/scenes/0/nodes/0", "44", "node 44"},
      });
}

}  // namespace
}  // namespace cscd::scenes::gltf
