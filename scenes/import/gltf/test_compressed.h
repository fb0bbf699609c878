#pragma once

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include "scenes/import/gltf/test_files.h"

// Files of the tube, compressed by the encoders of the libraries that read them.
namespace cscd::scenes::gltf {

// Replaces the view of an accessor by a compressed view. The plain bytes are dropped, and a
// buffer stands in for them.
inline void compress(TubeFile& file, int accessor, const std::vector<unsigned char>& compressed,
                     std::size_t count, std::size_t stride, const char* mode, const char* filter = nullptr) {
  const auto packed = static_cast<std::size_t>(file.view(compressed));
  json meshopt = file.root["bufferViews"][packed];
  meshopt["byteStride"] = stride;
  meshopt["count"] = count;
  meshopt["mode"] = mode;
  if (filter != nullptr) meshopt["filter"] = filter;
  json& view = file.root["bufferViews"][packed];
  view = {
      {"buffer", 1}, {"byteLength", count * stride}, {"extensions", {{"EXT_meshopt_compression", meshopt}}}};
  if (std::string(mode) == "ATTRIBUTES") view["byteStride"] = stride;
  file.root["buffers"] = {
      json::object(),
      {{"byteLength", count * stride}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
  file.root["accessors"][static_cast<std::size_t>(accessor)]["bufferView"] = packed;
  file.root["extensionsUsed"] = file.root["extensionsRequired"] = {"EXT_meshopt_compression"};
}

inline std::vector<unsigned char> packed_vertices(const void* data, std::size_t count, std::size_t stride) {
  std::vector<unsigned char> out(meshopt_encodeVertexBufferBound(count, stride));
  out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), data, count, stride));
  return out;
}

// Encodes the tube's mesh with Draco, and sets `ids` to the attributes of the extension.
inline std::vector<unsigned char> packed_mesh(const TubeFile& file, json& ids) {
  const MeshNumbers& numbers = file.numbers;
  draco::TriangleSoupMeshBuilder builder;
  const int faces = static_cast<int>(numbers.corners.size() / 3);
  builder.Start(faces);
  const int positions = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int joints = builder.AddAttribute(draco::GeometryAttribute::GENERIC, 4, draco::DT_UINT8);
  const int weights = builder.AddAttribute(draco::GeometryAttribute::GENERIC, 4, draco::DT_FLOAT32);
  for (int f = 0; f < faces; ++f) {
    const std::uint16_t* corner = &numbers.corners[static_cast<std::size_t>(3 * f)];
    const auto add = [&](int attribute, const auto& values, std::size_t width) {
      builder.SetAttributeValuesForFace(attribute, draco::FaceIndex(static_cast<unsigned>(f)),
                                        &values[width * corner[0]], &values[width * corner[1]],
                                        &values[width * corner[2]]);
    };
    add(positions, numbers.positions, 3);
    add(joints, numbers.joints, 4);
    add(weights, numbers.weights, 4);
  }
  const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
  ids = {{"POSITION", mesh->attribute(positions)->unique_id()},
         {"JOINTS_0", mesh->attribute(joints)->unique_id()},
         {"WEIGHTS_0", mesh->attribute(weights)->unique_id()}};
  draco::Encoder encoder;
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  return {buffer.data(), buffer.data() + buffer.size()};
}

inline TubeFile with_draco() {
  TubeFile file;
  json ids;
  const int view = file.view(packed_mesh(file, ids));
  file.primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", view}, {"attributes", ids}};
  // Exporters write accessors that describe the decompressed data and have no bytes of their own.
  for (const std::size_t a : {0u, 1u, 2u, 3u}) file.root["accessors"][a].erase("bufferView");
  file.root["extensionsUsed"] = file.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return file;
}

// The tube with positions and triangles encoded by meshoptimizer.
inline TubeFile with_meshopt() {
  TubeFile file;
  const std::size_t vertices = file.character.parts[0].positions.size();
  compress(file, TubeFile::kPositions, packed_vertices(file.numbers.positions.data(), vertices, 12), vertices,
           12, "ATTRIBUTES");
  const std::vector<unsigned> corners(file.numbers.corners.begin(), file.numbers.corners.end());
  std::vector<unsigned char> packed(meshopt_encodeIndexBufferBound(corners.size(), vertices));
  meshopt_encodeIndexVersion(1);
  packed.resize(meshopt_encodeIndexBuffer(packed.data(), packed.size(), corners.data(), corners.size()));
  compress(file, TubeFile::kCorners, packed, corners.size(), 2, "TRIANGLES");
  return file;
}

}  // namespace cscd::scenes::gltf
