#include "scenes/import/gltf/surface.h"

#include <algorithm>
#include <cmath>
#include <draco/compression/decode.h>
#include <memory>
#include <numeric>
#include <optional>

#include "scenes/import/gltf/accessor.h"
#include "scenes/import/gltf/extensions.h"

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

// A primitive's mesh as the extension KHR_draco_mesh_compression stores it, decompressed.
class CompressedMesh {
 public:
  // Decompresses a mesh. Throws InputError where the data are damaged.
  CompressedMesh(std::span<const unsigned char> compressed, const std::string& what) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(compressed.data()), compressed.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok())
      throw InputError(what + ": its Draco data are damaged (" + decoded.status().error_msg_string() +
                       "); export it again");
    mesh_ = std::move(decoded).value();
  }

  std::size_t vertices() const { return mesh_->num_points(); }
  std::size_t triangles() const { return mesh_->num_faces(); }
  // Three for each triangle.
  std::vector<std::uint32_t> corners() const {
    std::vector<std::uint32_t> corners;
    for (draco::FaceIndex f(0); f < mesh_->num_faces(); ++f)
      for (const draco::PointIndex& corner : mesh_->face(f)) corners.push_back(corner.value());
    return corners;
  }

  // Returns the attribute with the number that the extension gives for it. `accessor` tells
  // what the attribute's integers mean; its count is ignored, because some exporters write the
  // count before compression. Throws InputError if there is no such attribute, or if its width
  // differs from the accessor's.
  Numbers attribute(int id, const tinygltf::Accessor& accessor, const std::string& what) const {
    const draco::PointAttribute* attribute = mesh_->GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
    if (attribute == nullptr)
      throw InputError(what + ": the Draco data hold no attribute " + std::to_string(id) +
                       "; export it again");
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

 private:
  std::shared_ptr<const draco::Mesh> mesh_;
};

using Corners = std::vector<std::uint32_t>;
using Triangles = std::vector<std::array<std::int32_t, 3>>;

void require_count(std::size_t count, std::size_t limit, const char* what) {
  if (count > limit)
    throw InputError("has more than " + std::to_string(limit) + " " + what + "; simplify the model");
}

// Splits strips and fans into triangles as section 3.7.2.1 of the specification does.
// The corners are in range.
Triangles triangles(const Corners& corners, int mode) {
  Triangles triangles;
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    triangles.push_back({static_cast<std::int32_t>(corners[a]), static_cast<std::int32_t>(corners[b]),
                         static_cast<std::int32_t>(corners[c])});
  };
  const std::size_t step = mode == TINYGLTF_MODE_TRIANGLES ? 3 : 1;
  for (std::size_t i = 0; i + 2 < corners.size(); i += step) {
    if (mode == TINYGLTF_MODE_TRIANGLES) add(i, i + 1, i + 2);
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) add(i, i + 1 + i % 2, i + 2 - i % 2);
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN) add(i + 1, i + 2, 0);
  }
  return triangles;
}

std::vector<Vec3> vectors(const Numbers& numbers) {
  std::vector<Vec3> vectors;
  vectors.reserve(numbers.count);
  for (std::size_t i = 0; i < numbers.count; ++i)
    vectors.emplace_back(numbers[i][0], numbers[i][1], numbers[i][2]);
  return vectors;
}

// Component types of positions: floats, and the integers of KHR_mesh_quantization.
constexpr Components kPositions = Components::floats | Components::bytes | Components::unsigned_bytes |
                                  Components::shorts | Components::unsigned_shorts;

}  // namespace

// The attributes of a primitive, whether they are compressed or not.
class Attributes {
 public:
  Attributes(const tinygltf::Primitive& primitive, Accessors& accessors, const std::string& what)
      : primitive_(primitive), accessors_(accessors), what_(what) {
    const auto extension = primitive.extensions.find(kDraco);
    if (extension == primitive.extensions.end()) return;
    const tinygltf::Value& facts = extension->second;
    if (!facts.Has("bufferView") || !facts.Has("attributes"))
      throw InputError(what + ": its Draco extension names no data; export it again");
    mesh_.emplace(accessors.view(facts.Get("bufferView").GetNumberAsInt(), what), what);
    const tinygltf::Value& ids = facts.Get("attributes");
    for (const std::string& name : ids.Keys()) compressed_[name] = ids.Get(name).GetNumberAsInt();
  }

  std::optional<Numbers> read(const std::string& name, int type, Components components, std::size_t most,
                              bool must_normalize = false) {
    const auto found = primitive_.attributes.find(name);
    if (found == primitive_.attributes.end()) return std::nullopt;
    const Expected expected{what_ + ", " + name, type, components, must_normalize, most};
    const auto id = compressed_.find(name);
    if (id == compressed_.end()) return accessors_.read(found->second, expected);
    require_count(mesh_->vertices(), most, "vertices");
    return mesh_->attribute(id->second, accessors_.checked(found->second, expected), expected.what);
  }

  // Returns the corners in the order of the primitive's mode. Draco always holds separate triangles.
  Corners corners(std::size_t vertices, std::size_t most) {
    if (mesh_) {
      require_count(3 * mesh_->triangles(), most, "corners of triangles");
      return mesh_->corners();
    }
    const std::optional<Numbers> indices =
        read(kIndices, TINYGLTF_TYPE_SCALAR,
             Components::unsigned_bytes | Components::unsigned_shorts | Components::unsigned_ints, most);
    Corners corners(indices ? indices->count : vertices);
    if (!indices) std::iota(corners.begin(), corners.end(), 0u);
    for (std::size_t i = 0; indices && i < corners.size(); ++i)
      corners[i] = static_cast<std::uint32_t>(indices->values[i]);
    return corners;
  }

  int mode() const { return mesh_ ? TINYGLTF_MODE_TRIANGLES : primitive_.mode; }

 private:
  const tinygltf::Primitive& primitive_;
  Accessors& accessors_;
  std::string what_;
  std::optional<CompressedMesh> mesh_;
  std::map<std::string, int> compressed_;  // names of attributes to their numbers in the extension
};

std::vector<Part> Surfaces::read(const tinygltf::Node& node, int own_place, const std::vector<int>& place) {
  std::vector<Part> parts;
  const tinygltf::Mesh& mesh = at(document_.model.meshes, node.mesh, "mesh");
  for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
    const tinygltf::Primitive& primitive = mesh.primitives[p];
    if (primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
      throw InputError("mesh " + std::to_string(node.mesh) + " of the glTF file: its mode " +
                       std::to_string(primitive.mode) + " is unknown; repair the file");
    if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
      ++no_triangles_;
    } else if (!primitive.attributes.contains("POSITION")) {
      ++no_positions_;
    } else {
      require_count(++parts_, limits_.parts, "meshes");
      parts.push_back(read_primitive(node, static_cast<int>(p), place));
      parts.back().node = own_place;
    }
  }
  return parts;
}

Part Surfaces::read_primitive(const tinygltf::Node& node, int primitive_index,
                              const std::vector<int>& place) {
  const tinygltf::Mesh& mesh = document_.model.meshes[static_cast<std::size_t>(node.mesh)];
  const tinygltf::Primitive& primitive = mesh.primitives[static_cast<std::size_t>(primitive_index)];
  Part part;
  part.name = mesh.name;
  part.mesh = node.mesh;
  part.primitive = primitive_index;
  const std::string where =
      "mesh " + std::to_string(node.mesh) + " of the glTF file, primitive " + std::to_string(primitive_index);
  Attributes attributes(primitive, accessors_, where);

  const auto positions =
      attributes.read("POSITION", TINYGLTF_TYPE_VEC3, kPositions, limits_.vertices - vertices_);
  part.positions = vectors(*positions);
  vertices_ += part.positions.size();

  const Corners corners = attributes.corners(part.positions.size(), 3 * limits_.triangles);
  for (const std::uint32_t corner : corners)
    if (corner >= part.positions.size())
      throw InputError(where + ": names vertex " + std::to_string(corner) + " of " +
                       std::to_string(part.positions.size()) + "; repair the file");
  if (attributes.mode() == TINYGLTF_MODE_TRIANGLES) odd_corners_ += corners.size() % 3;
  part.triangles = triangles(corners, attributes.mode());
  require_count(triangles_ += part.triangles.size(), limits_.triangles, "triangles");

  part.first.assign(part.positions.size() + 1, 0);
  if (node.skin >= 0 && primitive.attributes.contains("JOINTS_0")) {
    read_skin(at(document_.model.skins, node.skin, "skin"), place, part);
    read_influences(attributes, part, where);
  }
  read_targets(mesh, node, primitive, part, where);
  return part;
}

void Surfaces::read_skin(const tinygltf::Skin& skin, const std::vector<int>& place, Part& part) {
  const Expected matrices{"inverse bind matrices", TINYGLTF_TYPE_MAT4, Components::floats, false,
                          limits_.nodes};
  const int bind = skin.inverseBindMatrices;
  // The limit is ten times that on nodes, because parts may share a skin.
  joints_ += std::max(skin.joints.size(), bind >= 0 ? accessors_.checked(bind, matrices).count : 0);
  require_count(joints_, 10 * limits_.nodes, "joints of all meshes together");
  std::optional<Numbers> offsets;
  if (bind >= 0) offsets = accessors_.read(bind, matrices);
  if (offsets && offsets->count < skin.joints.size())
    throw InputError("a skin of the glTF file has " + std::to_string(skin.joints.size()) + " joints, but " +
                     std::to_string(offsets->count) + " inverse bind matrices; export it again");
  for (std::size_t j = 0; j < skin.joints.size(); ++j)
    part.joints.push_back({at(place, skin.joints[j], "joint"),
                           offsets ? affine((*offsets)[j], "inverse bind matrix") : Transform()});
}

void Surfaces::read_influences(Attributes& attributes, Part& part, const std::string& where) {
  struct Set {
    Numbers joints, weights;
  };
  std::vector<Set> sets;
  const std::size_t vertices = part.positions.size();
  for (;;) {
    require_count(influences_ + 4 * vertices * sets.size(), limits_.influences, "weights");
    const std::string number = std::to_string(sets.size());
    auto joints = attributes.read("JOINTS_" + number, TINYGLTF_TYPE_VEC4,
                                  Components::unsigned_bytes | Components::unsigned_shorts, vertices);
    auto weights = attributes.read(
        "WEIGHTS_" + number, TINYGLTF_TYPE_VEC4,
        Components::floats | Components::unsigned_bytes | Components::unsigned_shorts, vertices);
    if (!joints && !weights) break;
    if (!joints || !weights || joints->count != vertices || weights->count != vertices)
      throw InputError(where + ": JOINTS_" + number + " and WEIGHTS_" + number +
                       " do not give one entry each a vertex; export it again");
    sets.push_back({std::move(*joints), std::move(*weights)});
  }
  for (std::size_t v = 0; v < vertices; ++v) {
    const std::size_t first = part.influences.size();
    double sum = 0;
    for (const Set& set : sets)
      for (std::size_t k = 0; k < 4; ++k) {
        const double weight = set.weights[v][k];
        const auto joint = static_cast<std::size_t>(set.joints[v][k]);
        if (!std::isfinite(weight))
          throw InputError(where + ", vertex " + std::to_string(v) + ": a weight is not finite; repair it");
        negative_ += weight < 0;
        if (!(weight > 0)) continue;
        if (joint >= part.joints.size())
          throw InputError(where + ", vertex " + std::to_string(v) + ": names joint " +
                           std::to_string(joint) + " of the skin's " + std::to_string(part.joints.size()) +
                           "; repair it");
        part.influences.push_back({static_cast<int>(joint), weight});
        sum += weight;
      }
    for (std::size_t i = first; i < part.influences.size(); ++i) part.influences[i].weight /= sum;
    weightless_ += !sets.empty() && first == part.influences.size();
    part.first[v + 1] = part.influences.size();
  }
  influences_ += part.influences.size();
}

void Surfaces::read_targets(const tinygltf::Mesh& mesh, const tinygltf::Node& node,
                            const tinygltf::Primitive& primitive, Part& part, const std::string& where) {
  const std::size_t count = primitive.targets.size(), vertices = part.positions.size();
  if (count == 0) return;
  require_count(displacements_ += count * vertices, limits_.displacements, "displacements of morph targets");
  const std::vector<double>& weights = node.weights.empty() ? mesh.weights : node.weights;
  if (!weights.empty() && weights.size() != count)
    throw InputError(where + ": has " + std::to_string(weights.size()) + " weights for " +
                     std::to_string(count) + " morph targets; repair the file");
  const auto& names = document_.target_names[static_cast<std::size_t>(part.mesh)];
  for (std::size_t t = 0; t < count; ++t) {
    MorphTarget& target = part.targets.emplace_back();
    if (t < names.size()) target.name = names[t];
    if (!weights.empty()) target.weight = weights[t];
    const auto found = primitive.targets[t].find("POSITION");
    // A target may change normals alone.
    if (found == primitive.targets[t].end()) {
      target.displacements.assign(vertices, Vec3::Zero());
      continue;
    }
    const std::string what = where + ", morph target " + std::to_string(t);
    target.displacements =
        vectors(accessors_.read(found->second, {what, TINYGLTF_TYPE_VEC3, kPositions, false, vertices}));
    if (target.displacements.size() != vertices)
      throw InputError(what + ": has " + std::to_string(target.displacements.size()) + " displacements for " +
                       std::to_string(vertices) + " vertices; export it again");
  }
}

std::vector<std::string> Surfaces::notes() const {
  std::vector<std::string> notes;
  const auto note = [&](std::size_t count, const char* what) {
    if (count > 0) notes.push_back(std::to_string(count) + " " + what);
  };
  note(no_triangles_, "primitives of points and lines left out");
  note(no_positions_, "primitives without positions left out");
  note(odd_corners_, "corners left over after the last triangle ignored");
  note(negative_, "negative weights ignored");
  note(weightless_, "vertices of skins have no weight above 0: they follow the node of their mesh");
  return notes;
}

Transform affine(std::span<const double> m, const std::string& what) {
  // A matrix that an exporter multiplied out in floats may have roundings in its last row.
  constexpr double kRounding = 1e-4;
  const bool last_row = std::abs(m[3]) < kRounding && std::abs(m[7]) < kRounding &&
                        std::abs(m[11]) < kRounding && std::abs(m[15] - 1) < kRounding;
  if (!last_row)
    throw InputError("the glTF file holds an " + what + " whose last row is not 0 0 0 1; repair the file");
  return {{Vec3(m[0], m[1], m[2]), Vec3(m[4], m[5], m[6]), Vec3(m[8], m[9], m[10])}, {m[12], m[13], m[14]}};
}

}  // namespace cscd::scenes::gltf
