#include "scenes/import/gltf/compressed_mesh.h"

#include <draco/compression/decode.h>

namespace cscd::scenes::gltf {
namespace {

int component_type(draco::DataType type, const std::string& what) {
  switch (type) {
    case draco::DT_INT8:
      return TINYGLTF_COMPONENT_TYPE_BYTE;
    case draco::DT_UINT8:
      return TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
    case draco::DT_INT16:
      return TINYGLTF_COMPONENT_TYPE_SHORT;
    case draco::DT_UINT16:
      return TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
    case draco::DT_UINT32:
      return TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    case draco::DT_FLOAT32:
      return TINYGLTF_COMPONENT_TYPE_FLOAT;
    default:
      throw InputError(what + ": their compressed numbers are of a kind that glTF does not know");
  }
}

}  // namespace

CompressedMesh::CompressedMesh(std::span<const unsigned char> compressed, const std::string& what) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(compressed.data()), compressed.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok())
    throw InputError(what + ": its Draco data are damaged (" + decoded.status().error_msg_string() +
                     "); export it again");
  mesh_ = std::move(decoded).value();
}

std::size_t CompressedMesh::vertices() const {
  return mesh_->num_points();
}

std::size_t CompressedMesh::triangles() const {
  return mesh_->num_faces();
}

std::vector<std::uint32_t> CompressedMesh::corners() const {
  std::vector<std::uint32_t> corners;
  for (draco::FaceIndex f(0); f < mesh_->num_faces(); ++f)
    for (const draco::PointIndex& corner : mesh_->face(f)) corners.push_back(corner.value());
  return corners;
}

Numbers CompressedMesh::attribute(int id, const tinygltf::Accessor& accessor, const std::string& what) const {
  const draco::PointAttribute* attribute = mesh_->GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
  if (attribute == nullptr)
    throw InputError(what + ": the Draco data hold no attribute " + std::to_string(id) + "; export it again");
  Numbers numbers;
  numbers.count = vertices();
  numbers.width =
      static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
  if (attribute->num_components() != numbers.width)
    throw InputError(what + ": the Draco data and their accessor differ in size; export it again");
  const int type = component_type(attribute->data_type(), what);
  const auto component = static_cast<std::size_t>(draco::DataTypeLength(attribute->data_type()));
  const unsigned char* end = attribute->buffer()->data() + attribute->buffer()->data_size();
  if (!attribute->is_mapping_identity() && attribute->indices_map_size() < numbers.count)
    throw InputError(what + ": the Draco data are damaged; export it again");
  numbers.values.reserve(numbers.count * numbers.width);
  for (draco::PointIndex i(0); i < static_cast<std::uint32_t>(numbers.count); ++i) {
    const draco::AttributeValueIndex value = attribute->mapped_index(i);
    const unsigned char* first = value.value() < attribute->size() ? attribute->GetAddress(value) : end;
    if (static_cast<std::size_t>(end - first) < numbers.width * component)
      throw InputError(what + ": the Draco data are damaged; export it again");
    for (std::size_t k = 0; k < numbers.width; ++k)
      numbers.values.push_back(number_at(first + k * component, type, accessor.normalized));
  }
  return numbers;
}

}  // namespace cscd::scenes::gltf
