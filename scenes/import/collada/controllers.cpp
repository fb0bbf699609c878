#include <algorithm>
#include <string>

#include "core/base/error.h"
#include "scenes/import/collada/parts.h"

namespace cscd::scenes::collada {
namespace {

constexpr char kIdentity[] = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1";
constexpr std::size_t kMatrix = 16;

// How many positions the geometry of a skin has.
std::size_t vertices_of(const Document& document, pugi::xml_node skin) {
  const pugi::xml_node geometry = document.target_of(skin.attribute("source").value());
  const std::optional<Source> positions =
      document.numbers_of_source(geometry.child("mesh").child("vertices"), "POSITION");
  return positions ? positions->count : 0;
}

pugi::xml_node input_of(pugi::xml_node owner, std::string_view meaning) {
  for (const pugi::xml_node input : owner.children("input"))
    if (input.attribute("semantic").value() == meaning) return input;
  return {};
}

// The list of the names of a skin's joints.
struct JointNames {
  pugi::xml_node source, array;
  std::size_t count = 0;
};

JointNames names_of(const Document& document, pugi::xml_node skin) {
  JointNames names;
  names.source = document.source_of(skin.child("joints"), "JOINT");
  const pugi::xml_node accessor = names.source.child("technique_common").child("accessor");
  names.array = document.target_of(accessor.attribute("source").value());
  names.count = words_of(names.array).size();
  if (names.array && (count_in(names.array, "count", std::nullopt) != names.count ||
                      count_in(accessor, "count", std::nullopt) != names.count ||
                      count_in(accessor, "offset", 0) != 0 || count_in(accessor, "stride", 1) != 1))
    throw InputError(told(names.source) + ": does not say that it has the " + std::to_string(names.count) +
                     " names that it has, one after another; export it again");
  return names;
}

void set_count(pugi::xml_node element, std::size_t count) {
  element.attribute("count").set_value(std::to_string(count).c_str());
}

void append_text(pugi::xml_node element, const std::string& more) {
  element.text().set((std::string(element.child_value()) + " " + more).c_str());
}

class Skin {
 public:
  Skin(const Document& document, pugi::xml_node skin)
      : document_(document),
        skin_(skin),
        weighted_(skin.child("vertex_weights")),
        names_(names_of(document, skin)) {}

  // Returns how many vertices have no weight.
  std::size_t check() {
    check_bind_poses();
    return weighted_.child("v") ? check_weights() : vertices_of(document_, skin_);
  }

 private:
  void check_bind_poses() {
    if (const pugi::xml_node shape = skin_.child("bind_shape_matrix")) {
      if (numbers_of(shape).size() != kMatrix)
        throw InputError(told(shape) + ": has not the 16 numbers of a matrix; export it again");
    } else {
      skin_.prepend_child("bind_shape_matrix").text().set(kIdentity);
    }
    bind_poses_ = document_.numbers_of_source(skin_.child("joints"), "INV_BIND_MATRIX");
    if (bind_poses_ && (bind_poses_->count < names_.count || bind_poses_->stride < kMatrix))
      throw InputError(told(bind_poses_->element) + ": has fewer matrices than the " +
                       std::to_string(names_.count) + " joints; export it again");
  }

  std::size_t check_weights() {
    const std::optional<Source> weights = document_.numbers_of_source(weighted_, "WEIGHT");
    const pugi::xml_node joint_input = input_of(weighted_, "JOINT"),
                         weight_input = input_of(weighted_, "WEIGHT");
    if (!weights || !joint_input)
      throw InputError(told(weighted_) + ": names no joints or no weights; export it again");
    if (document_.source_of(weighted_, "JOINT") != names_.source)
      throw InputError(told(weighted_) + ": counts joints in another list than <joints>; export it again");
    std::size_t stride = 1;
    for (const pugi::xml_node input : weighted_.children("input"))
      stride = std::max(stride, count_in(input, "offset", 0) + 1);
    const std::size_t joint = count_in(joint_input, "offset", 0),
                      weight = count_in(weight_input, "offset", 0);

    const std::vector<long> counts = indices_of(weighted_.child("vcount"), 0);
    const std::vector<long> entries = indices_of(weighted_.child("v"), -1);
    std::size_t pairs = 0;
    for (const long count : counts) pairs += static_cast<std::size_t>(count);
    if (counts.size() != count_in(weighted_, "count", std::nullopt) || entries.size() != pairs * stride)
      throw InputError(told(weighted_) +
                       ": its count, <vcount> and <v> do not fit one another; export it again");
    if (const std::size_t vertices = vertices_of(document_, skin_); counts.size() < vertices)
      throw InputError(told(weighted_) + ": has weights for " + std::to_string(counts.size()) + " of " +
                       std::to_string(vertices) + " vertices; export it again");

    std::string written;
    bool bound = false;               // a vertex follows the bind shape
    std::vector<bool> weighs(pairs);  // pair by pair
    for (std::size_t i = 0; i < entries.size(); i += stride) {
      const long of = entries[i + joint], by = entries[i + weight];
      if (of >= static_cast<long>(names_.count))
        refuse(i + joint, "joint " + std::to_string(of) + " of " + std::to_string(names_.count));
      if (by < 0 || by >= static_cast<long>(weights->count))
        refuse(i + weight, "weight " + std::to_string(by) + " of " + std::to_string(weights->count));
      const double value = weights->numbers[weights->offset + weights->stride * static_cast<std::size_t>(by)];
      if (value < 0) refuse(i + weight, "weight " + std::to_string(by) + ", which is negative");
      weighs[i / stride] = value > 0;
      bound |= of < 0;
      written +=
          std::to_string(of < 0 ? static_cast<long>(names_.count) : of) + " " + std::to_string(by) + " ";
    }
    std::size_t without = 0, first = 0;
    for (const long count : counts) {
      const auto from = weighs.begin() + static_cast<std::ptrdiff_t>(first);
      without += std::find(from, from + count, true) == from + count;
      first += static_cast<std::size_t>(count);
    }
    if (!bound && stride == 2 && joint == 0 && weight == 1) return without;
    // assimp takes <v> for pairs of a joint and a weight.
    weighted_.child("v").text().set(written.c_str());
    while (weighted_.child("input")) weighted_.remove_child("input");
    add_input("WEIGHT", weights->element, "1");
    add_input("JOINT", names_.source, "0");
    if (bound) add_bind_shape();
    return without;
  }

  [[noreturn]] void refuse(std::size_t entry, const std::string& what) const {
    throw InputError(told(weighted_) + ": entry " + std::to_string(entry) +
                     " of <v> (counted from 0) names " + what + "; repair it or export the file again");
  }

  void add_input(const char* meaning, pugi::xml_node source, const char* offset) {
    pugi::xml_node input = weighted_.prepend_child("input");
    input.append_attribute("semantic").set_value(meaning);
    input.append_attribute("source").set_value(("#" + std::string(source.attribute("id").value())).c_str());
    input.append_attribute("offset").set_value(offset);
  }

  // Adds a joint that stands at the origin of the scene and does not move.
  void add_bind_shape() {
    if (!bind_poses_ || bind_poses_->offset != 0 || bind_poses_->stride != kMatrix ||
        bind_poses_->numbers.size() != kMatrix * names_.count)
      throw InputError(told(skin_) +
                       ": has vertices on joint -1, the bind shape, and bind poses that are not one matrix a "
                       "joint; export it again");
    std::string name = "bind_shape";
    while (document_.is_taken(name)) name += "_";
    pugi::xml_node scene = document_.scene();
    if (!scene.find_child_by_attribute("node", "id", name.c_str())) {
      pugi::xml_node node = scene.append_child("node");
      for (const char* attribute : {"id", "sid", "name"})
        node.append_attribute(attribute).set_value(name.c_str());
      node.append_attribute("type").set_value("JOINT");
    }
    append_text(names_.array, name);
    append_text(bind_poses_->array, kIdentity);
    set_count(names_.array, names_.count + 1);
    set_count(names_.source.child("technique_common").child("accessor"), names_.count + 1);
    set_count(bind_poses_->array, bind_poses_->numbers.size() + kMatrix);
    set_count(bind_poses_->accessor, names_.count + 1);
  }

  const Document& document_;
  pugi::xml_node skin_, weighted_;
  JointNames names_;
  std::optional<Source> bind_poses_;
};

}  // namespace

std::vector<std::string> check_controllers(const Document& document) {
  std::size_t without = 0;
  for (const pugi::xml_node library : document.root().children("library_controllers"))
    for (const pugi::xml_node controller : library.children("controller")) {
      if (controller.child("morph"))
        throw InputError(
            told(controller) +
            ": is a morph, and morph targets of Collada files are not read; export the model as glTF "
            "or FBX");
      if (const pugi::xml_node skin = controller.child("skin")) without += Skin(document, skin).check();
    }
  if (without == 0) return {};
  return {std::to_string(without) +
          " vertices of skins have no weight above 0: they follow the node of their mesh, without its bind "
          "shape"};
}

}  // namespace cscd::scenes::collada
