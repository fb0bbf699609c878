#pragma once

#include <memory>

#include "scenes/import/gltf/accessor.h"

namespace draco {
class Mesh;
}

namespace cscd::scenes::gltf {

// A primitive's mesh as the extension KHR_draco_mesh_compression stores it, decompressed.
class CompressedMesh {
 public:
  // Decompresses a mesh. Throws InputError where the data are damaged.
  CompressedMesh(std::span<const unsigned char> compressed, const std::string& what);

  std::size_t vertices() const;
  std::size_t triangles() const;
  std::vector<std::uint32_t> corners() const;  // three for each triangle

  // Returns the attribute with the number that the extension gives for it. `accessor` tells
  // what the attribute's integers mean; its count is ignored, because some exporters write the
  // count before compression. Throws InputError if there is no such attribute, or if its width
  // differs from the accessor's.
  Numbers attribute(int id, const tinygltf::Accessor& accessor, const std::string& what) const;

 private:
  std::shared_ptr<const draco::Mesh> mesh_;
};

}  // namespace cscd::scenes::gltf
