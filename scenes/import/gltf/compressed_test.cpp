#include "scenes/import/gltf/test_compressed.h"

// Reads files that the libraries' own encoders have compressed.
namespace cscd::scenes::gltf {
namespace {

TEST(GltfCompressed, MeshoptAttributesAndTriangles) {
  const TubeFile file = with_meshopt();
  const std::vector<std::uint16_t>& corners = file.numbers.corners;
  const Character character = read(file);
  expect_same_motion(character, bending_tube());
  ASSERT_EQ(character.parts[0].triangles.size(), bending_tube().parts[0].triangles.size());
  // The codec may list a triangle from another first corner.
  for (std::size_t t = 0; t < corners.size() / 3; ++t) {
    auto got = character.parts[0].triangles[t], wanted = bending_tube().parts[0].triangles[t];
    std::rotate(got.begin(), std::min_element(got.begin(), got.end()), got.end());
    std::rotate(wanted.begin(), std::min_element(wanted.begin(), wanted.end()), wanted.end());
    EXPECT_EQ(got, wanted);
  }
}

TEST(GltfCompressed, MeshoptIndexSequences) {
  TubeFile file;
  const std::vector<unsigned> corners(file.numbers.corners.begin(), file.numbers.corners.end());
  std::vector<unsigned char> packed(meshopt_encodeIndexSequenceBound(corners.size(), 1000));
  packed.resize(meshopt_encodeIndexSequence(packed.data(), packed.size(), corners.data(), corners.size()));
  compress(file, TubeFile::kCorners, packed, corners.size(), 2, "INDICES");
  EXPECT_EQ(read(file).parts[0].triangles, bending_tube().parts[0].triangles);
}

TEST(GltfCompressed, MeshoptExponentialFilter) {
  TubeFile file;
  const std::size_t vertices = file.character.parts[0].positions.size();
  std::vector<float> filtered(file.numbers.positions.size());
#if MESHOPTIMIZER_VERSION < 190
  meshopt_encodeFilterExp(filtered.data(), vertices, 12, 24, file.numbers.positions.data());
#else  // version 0.18 always encodes like this
  meshopt_encodeFilterExp(filtered.data(), vertices, 12, 24, file.numbers.positions.data(),
                          meshopt_EncodeExpSharedVector);
#endif
  compress(file, TubeFile::kPositions, packed_vertices(filtered.data(), vertices, 12), vertices, 12,
           "ATTRIBUTES", "EXPONENTIAL");
  expect_same_motion(read(file), bending_tube(), 1e-5);
}

TEST(GltfCompressed, MeshoptQuaternionFilter) {
  TubeFile file;
  const float turns[8] = {0, 0, 0, 1, 0, 0, file.half, file.half};
  std::int16_t filtered[8];
  meshopt_encodeFilterQuat(filtered, 2, 8, 16, turns);
  const int output = file.accessor(std::vector<std::int16_t>(8), "VEC4", true);
  compress(file, output, packed_vertices(filtered, 2, 8), 2, 8, "ATTRIBUTES", "QUATERNION");
  file.root["animations"][0]["samplers"][0]["output"] = output;
  expect_same_motion(read(file), bending_tube(), 2e-4);
}

// The octahedral filter is meant for normals, but a morph target may be written with it.
TEST(GltfCompressed, MeshoptOctahedralFilter) {
  TubeFile file;
  const std::size_t vertices = file.character.parts[0].positions.size();
  std::vector<float> up(4 * vertices, 0);
  for (std::size_t v = 0; v < vertices; ++v) up[4 * v + 2] = 1;
  std::vector<std::int8_t> filtered(4 * vertices);
  meshopt_encodeFilterOct(filtered.data(), vertices, 4, 8, up.data());
  const int target = file.accessor(std::vector<std::int8_t>(3 * vertices), "VEC3", true);
  compress(file, target, packed_vertices(filtered.data(), vertices, 4), vertices, 4, "ATTRIBUTES",
           "OCTAHEDRAL");
  file.primitive()["targets"] = {{{"POSITION", target}}};
  file.root["meshes"][0]["weights"] = {1};
  EXPECT_LT((positions_at(read(file), 0)[5] - positions_at(bending_tube(), 0)[5] - Vec3(0, 0, 1)).norm(),
            1e-2);
}

TEST(GltfCompressed, MeshoptDataThatDoNotFitAreRefused) {
  TubeFile file = with_meshopt();
  const auto view = file.root["accessors"][TubeFile::kPositions]["bufferView"].get<std::size_t>();
  const std::string within = "/bufferViews/" + std::to_string(view) + "/extensions/EXT_meshopt_compression";
  expect_refusals(file, within,
                  {
                      {"/mode", "\"TREES\"", "unknown mode 'TREES'"},
                      {"/mode", "\"TRIANGLES\"", "does not fit its mode"},
                      {"/mode", "4", "mode is not a text"},
                      {"/filter", "\"SHARP\"", "unknown filter 'SHARP'"},
                      {"/filter", "\"QUATERNION\"", "does not fit its mode and filter"},
                      {"/byteStride", "16", "as many bytes as its buffer view"},
                      {"/byteStride", "0", "does not fit its mode"},
                      {"/count", "2147483647", "as many bytes as its buffer view"},
                      {"/byteLength", "100", "is damaged"},
                      {"/byteLength", "1", "fewer elements than it says"},
                      {"/byteOffset", "2147483647", "beyond its buffer"},
                      {"/buffer", "1", "holds nothing"},
                  });
  file.root["bufferViews"][view].erase("extensions");
  EXPECT_TRUE(says(refusal(file), "a buffer that holds nothing"));
}

TEST(GltfCompressed, DracoMeshes) {
  const Character got = read(with_draco()), wanted = bending_tube();
  ASSERT_EQ(got.parts[0].positions.size(), wanted.parts[0].positions.size());
  ASSERT_EQ(got.parts[0].triangles.size(), wanted.parts[0].triangles.size());
  // Draco numbers vertices anew, so they are matched by where they are at rest.
  for (const double seconds : {0.0, 0.5, 1.0}) {
    const std::vector<Vec3> found = positions_at(got, seconds), expected = positions_at(wanted, seconds);
    for (std::size_t v = 0; v < found.size(); ++v) {
      std::size_t same = 0;
      while (same < expected.size() &&
             (wanted.parts[0].positions[same] - got.parts[0].positions[v]).norm() > 1e-6)
        ++same;
      ASSERT_LT(same, expected.size());
      EXPECT_LT((found[v] - expected[same]).norm(), 1e-6);
    }
  }
}

TEST(GltfCompressed, DracoDataThatDoNotFitAreRefused) {
  expect_refusals(with_draco(), "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression",
                  {
                      {"/bufferView", "0", "Draco data are damaged"},
                      {"/bufferView", "1000", "buffer view 1000"},
                      {"/attributes/POSITION", "77", "no attribute 77"},
                      {"/attributes/POSITION", "1", "differ in size"},
                      {"/attributes", "{}", "names no data"},
                  });
  TubeFile file = with_draco();
  file.root["accessors"][0]["type"] = "VEC4";
  EXPECT_TRUE(says(refusal(file), "wrong type"));
  CharacterLimits few;
  few.vertices = 100;
  TubeFile counted_before = with_draco();
  counted_before.root["accessors"][0]["count"] = 1;
  EXPECT_EQ(refusal(counted_before), "");
  EXPECT_TRUE(says(refusal(counted_before, few), "more than 100 vertices"));
}

}  // namespace
}  // namespace cscd::scenes::gltf
