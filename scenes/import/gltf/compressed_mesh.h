#pragma once

#include <memory>

#include "scenes/import/gltf/accessor.h"

namespace draco {
class Mesh;
}

namespace cscd::scenes::gltf {

// A primitive's mesh as KHR_draco_mesh_compression keeps it.
class CompressedMesh {
 public:
  // Decompresses a mesh. Throws InputError where the data are damaged.
  CompressedMesh(std::span<const unsigned char> compressed, const std::string& what);

  std::size_t vertices() const;
  std::size_t triangles() const;
  std::vector<std::uint32_t> corners() const;  // three of each triangle

  // The attribute of a number that the extension gives; `accessor` says how its integers are meant. Its count
  // is not looked at: some exporters write the count before compression. Throws InputError where there is no
  // such attribute, or not as wide as the accessor.
  Numbers attribute(int id, const tinygltf::Accessor& accessor, const std::string& what) const;

 private:
  std::shared_ptr<const draco::Mesh> mesh_;
};

}  // namespace cscd::scenes::gltf
