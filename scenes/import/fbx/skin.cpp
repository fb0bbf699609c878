#include "scenes/import/fbx/skin.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/error.h"

namespace cscd::scenes::fbx {
namespace {

// The mesh's own node completes weights that sum to less than 1. A gap below this is only rounding.
constexpr double kRounding = 1e-5;

// Reads a matrix of 16 numbers, column by column.
std::optional<Transform> read_matrix(const Element& parent, std::string_view name, const std::string& what) {
  const Element* element = parent.child(name);
  if (element == nullptr) return std::nullopt;
  const std::vector<double> m = reals(*element, 16, what);
  if (m.size() != 16)
    throw InputError(what + ": has " + std::to_string(m.size()) + " numbers, not 16; repair it");
  Transform map;
  for (std::size_t c = 0; c < 3; ++c) map.column[c] = {m[4 * c], m[4 * c + 1], m[4 * c + 2]};
  map.origin = {m[12], m[13], m[14]};
  return map;
}

bool is_zero(const Transform& map) {
  return map.column[0] == Vec3::Zero() && map.column[1] == Vec3::Zero() && map.column[2] == Vec3::Zero();
}

class SkinReader {
 public:
  SkinReader(const Objects& objects, const SkinPlace& place, const CharacterLimits& limits, Part& part,
             SkinLeftOut& left_out)
      : objects_(objects), place_(place), limits_(limits), part_(part), left_out_(left_out) {}

  void read(const Object* skin) {
    if (skin != nullptr) {
      read_shares(*skin);
      for (const Object* deformer : objects_.sources(*skin, "Deformer"))
        if (deformer->subtype == "Cluster") read_cluster(*deformer);
    }
    distribute();
  }

 private:
  struct Entry {
    std::size_t vertex;
    Influence influence;
  };

  std::string where() const { return "mesh '" + part_.name + "'"; }

  // Reads by which share each vertex follows its bones by dual quaternions. In the kind "Blend", a vertex
  // that is not listed is skinned linearly. In the other kinds, the list has no meaning.
  void read_shares(const Object& skin) {
    const Element* type = skin.element->child("SkinningType");
    const std::string_view kind = type == nullptr ? std::string_view() : type->text(0);
    const std::size_t count = part_.positions.size();
    if (kind == "DualQuaternion") part_.dual_quaternion.assign(count, 1);
    const Element *indexes = skin.element->child("Indexes"), *shares = skin.element->child("BlendWeights");
    if (kind != "Blend" || shares == nullptr) return;
    const std::vector<double> share = reals(*shares, limits_.vertices, where());
    const std::vector<std::int64_t> vertex =
        indexes == nullptr ? std::vector<std::int64_t>() : integers(*indexes, limits_.vertices, where());
    if (std::all_of(share.begin(), share.end(), [](double s) { return s == 0; })) return;
    if (vertex.size() != share.size())
      throw InputError(where() + ": its skin has " + std::to_string(vertex.size()) + " vertices and " +
                       std::to_string(share.size()) + " blend weights; repair it");
    part_.dual_quaternion.assign(count, 0);
    for (std::size_t i = 0; i < share.size(); ++i) {
      if (vertex[i] < 0 || vertex[i] >= static_cast<std::int64_t>(count))
        throw InputError(where() + ": its skin blends vertex " + std::to_string(vertex[i]) + " of " +
                         std::to_string(count) + "; repair it");
      if (!std::isfinite(share[i]))
        throw InputError(where() + ", vertex " + std::to_string(vertex[i]) +
                         ": its blend weight is not finite; repair it");
      part_.dual_quaternion[static_cast<std::size_t>(vertex[i])] = std::clamp(share[i], 0.0, 1.0);
    }
  }

  void read_cluster(const Object& cluster) {
    const std::string what = where() + ", cluster '" + cluster.name + "'";
    const Element* mode = cluster.element->child("Mode");
    const std::string_view kind = mode == nullptr ? std::string_view() : mode->text(0);
    if (kind == "Additive")
      throw InputError(what + ": its link mode is additive; choose normalized weights on export");
    total_one_ = total_one_ || kind == "Total1";
    const Element *indexes = cluster.element->child("Indexes"), *weights = cluster.element->child("Weights");
    if (indexes == nullptr || weights == nullptr) return;
    const std::vector<std::int64_t> vertices = integers(*indexes, limits_.influences, what);
    const std::vector<double> shares = reals(*weights, limits_.influences, what);
    if (vertices.size() != shares.size())
      throw InputError(what + ": has " + std::to_string(vertices.size()) + " vertices and " +
                       std::to_string(shares.size()) + " weights; repair it");
    const std::optional<int> bone = bone_of(cluster, what);
    if (!bone) {
      left_out_.weights += vertices.size();
      return;
    }
    const int joint = static_cast<int>(part_.joints.size());
    part_.joints.push_back({*bone, composed(mesh_to_bone(cluster, what), place_.geometry)});
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      if (vertices[i] < 0 || vertices[i] >= static_cast<std::int64_t>(part_.positions.size()))
        throw InputError(what + ": weighs vertex " + std::to_string(vertices[i]) + " of " +
                         std::to_string(part_.positions.size()) + "; repair it");
      if (!std::isfinite(shares[i]))
        throw InputError(what + ": its weight of vertex " + std::to_string(vertices[i]) +
                         " is not a number; repair it");
      if (shares[i] > 0)
        entries_.push_back({static_cast<std::size_t>(vertices[i]), {joint, shares[i]}});
      else if (shares[i] != 0)
        ++left_out_.weights;
    }
    if (entries_.size() > limits_.influences)
      throw InputError(what + ": the mesh has more than " + std::to_string(limits_.influences) +
                       " weights; simplify the model");
  }

  std::optional<int> bone_of(const Object& cluster, const std::string& what) const {
    const std::vector<const Object*> links = objects_.sources(cluster, "Model");
    if (links.size() > 1) throw InputError(what + ": follows several nodes; export it again");
    if (links.empty()) return std::nullopt;
    const auto found = place_.node_of.find(links.front());
    if (found == place_.node_of.end()) return std::nullopt;
    return found->second;
  }

  Transform mesh_to_bone(const Object& cluster, const std::string& what) const {
    const auto transform = read_matrix(*cluster.element, "Transform", what + ", Transform");
    if (transform && !is_zero(*transform)) return *transform;
    const auto link = read_matrix(*cluster.element, "TransformLink", what + ", TransformLink");
    if (!link) throw InputError(what + ": says nowhere how it was bound; export it again");
    return composed(inverse(*link), place_.mesh_at_rest);
  }

  // Sorts the influences by vertex and makes the weights of each vertex sum to 1. In the mode "total 1",
  // the mesh's node takes the weight that is missing from 1.
  void distribute() {
    const std::size_t vertices = part_.positions.size();
    std::vector<double> sum(vertices, 0);
    for (const Entry& entry : entries_) sum[entry.vertex] += entry.influence.weight;
    if (total_one_) complete(sum);
    std::vector<std::size_t> count(vertices + 1, 0);
    for (const Entry& entry : entries_) ++count[entry.vertex + 1];
    for (std::size_t v = 0; v < vertices; ++v) count[v + 1] += count[v];
    part_.first = count;
    part_.influences.resize(entries_.size());
    for (const Entry& entry : entries_)
      part_.influences[count[entry.vertex]++] = {entry.influence.joint,
                                                 entry.influence.weight / sum[entry.vertex]};
  }

  void complete(std::vector<double>& sum) {
    const int own = static_cast<int>(part_.joints.size());
    bool used = false;
    for (std::size_t v = 0; v < sum.size(); ++v) {
      if (sum[v] > 1 + kRounding)
        throw InputError(where() + ", vertex " + std::to_string(v) +
                         ": its weights sum to more than 1; normalize the weights before the export");
      if (!(sum[v] > 0) || sum[v] >= 1 - kRounding) continue;
      entries_.push_back({v, {own, 1 - sum[v]}});
      sum[v] = 1;
      used = true;
    }
    if (used) part_.joints.push_back({part_.node, {}});
  }

  const Objects& objects_;
  const SkinPlace& place_;
  const CharacterLimits& limits_;
  Part& part_;
  SkinLeftOut& left_out_;
  std::vector<Entry> entries_;
  bool total_one_ = false;
};

}  // namespace

const Object* skin_of(const Objects& objects, const Object& geometry) {
  const Object* skin = nullptr;
  for (const Object* deformer : objects.sources(geometry, "Deformer")) {
    if (deformer->subtype != "Skin" || objects.sources(*deformer, "Deformer").empty()) continue;
    if (skin != nullptr)
      throw InputError(told("mesh", geometry) +
                       ": several skins move it one after the other; combine them before the export");
    skin = deformer;
  }
  return skin;
}

void read_skin(const Objects& objects, const Object* skin, const SkinPlace& place,
               const CharacterLimits& limits, Part& part, SkinLeftOut& left_out) {
  SkinReader(objects, place, limits, part, left_out).read(skin);
}

}  // namespace cscd::scenes::fbx
