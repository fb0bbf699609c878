#include "scenes/import/gltf/json.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "core/base/error.h"
#include "scenes/import/gltf/extensions.h"

namespace cscd::scenes::gltf {
namespace {

using nlohmann::json;

constexpr std::size_t kDeepest = 64;

// The form that a member of a given name must have, wherever it stands in the sections that are read.
enum class Kind { whole, wholes, wholes_by_name, by_name_list, numbers, text, flag, object, objects };
struct Rule {
  Kind kind;
  std::size_t length = 0;  // of a list of numbers; 0: any length
};
std::map<std::string_view, Rule> make_rules() {
  std::map<std::string_view, Rule> rules{{"matrix", {Kind::numbers, 16}},
                                         {"rotation", {Kind::numbers, 4}},
                                         {"scale", {Kind::numbers, 3}},
                                         {"translation", {Kind::numbers, 3}}};
  const auto add = [&](Kind kind, std::initializer_list<std::string_view> names) {
    for (const std::string_view name : names) rules[name] = {kind};
  };
  add(Kind::whole,
      {"scene", "mesh", "skin", "node", "bufferView", "buffer", "byteOffset", "byteLength", "byteStride",
       "componentType", "count", "input", "output", "sampler", "mode", "indices", "inverseBindMatrices"});
  add(Kind::wholes, {"children", "joints", "nodes"});
  add(Kind::wholes_by_name, {"attributes"});
  add(Kind::numbers, {"weights"});
  add(Kind::by_name_list, {"targets"});
  add(Kind::text, {"uri", "type", "path", "interpolation", "name", "filter"});
  add(Kind::flag, {"normalized", "fallback"});
  add(Kind::object, {"sparse", "values", "target", "extensions", kMeshopt, kDraco});
  add(Kind::objects, {"primitives", "channels", "samplers"});
  return rules;
}
const std::map<std::string_view, Rule> kRules = make_rules();
// Members that this reader ignores and that tinygltf would only copy.
constexpr std::array kUnread = {"extras", "min", "max", "camera", "skeleton", "material"};

constexpr std::array kSections = {"accessors", "animations", "buffers", "bufferViews",
                                  "meshes",    "nodes",      "scenes",  "skins"};

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
  throw InputError("the glTF file's " + where + " " + what + "; repair the file");
}

void check_whole(json& value, const std::string& where) {
  constexpr auto kMost = std::numeric_limits<int>::max();
  // JSON numbers such as 3.0 are whole numbers too.
  if (value.is_number_float()) {
    const double number = value.get<double>();
    if (number == std::floor(number) && std::abs(number) <= kMost) value = static_cast<std::int64_t>(number);
  }
  const bool unsigned_number = value.is_number_unsigned() && value.get<std::uint64_t>() <= kMost;
  const bool signed_number = value.is_number_integer() && !value.is_number_unsigned() &&
                             value.get<std::int64_t>() >= 0 && value.get<std::int64_t>() <= kMost;
  if (!unsigned_number && !signed_number)
    refuse(where, "is not a whole number from 0 to " + std::to_string(kMost));
  // tinygltf also requires the unsigned type.
  if (signed_number) value = static_cast<std::uint64_t>(value.get<std::int64_t>());
}

class Checker {
 public:
  explicit Checker(CheckedJson& out) : out_(out) {}

  void check_section(json& section, const std::string& name) {
    if (!section.is_array()) refuse("'" + name + "'", "is not a list");
    for (std::size_t i = 0; i < section.size(); ++i)
      check_object(section[i], name + "[" + std::to_string(i) + "]");
  }

  void check_object(json& object, const std::string& where) {
    if (!object.is_object()) refuse(where, "is not an object");
    for (const char* name : kUnread) object.erase(name);
    for (auto& [name, value] : object.items()) {
      const auto rule = kRules.find(name);
      if (rule != kRules.end()) check(rule->second, name, value, where + "." + name);
    }
  }

 private:
  // Returns the kind that a member must have where it stands: some names mean different
  // things in different places.
  static Kind kind_of(Kind usual, const std::string& name, const json& value, const std::string& where) {
    if (name == "mode" && where.find(kMeshopt) != std::string::npos) return Kind::text;
    if (name == "indices") return value.is_object() ? Kind::object : Kind::whole;
    if (name == "target" && !value.is_object() && where.starts_with("bufferViews")) return Kind::whole;
    return usual;
  }

  void check(const Rule& rule, const std::string& name, json& value, const std::string& where) {
    switch (kind_of(rule.kind, name, value, where)) {
      case Kind::whole:
        return check_whole(value, where);
      case Kind::wholes:
        if (!value.is_array()) refuse(where, "is not a list");
        for (std::size_t i = 0; i < value.size(); ++i) check_whole(value[i], where);
        return;
      case Kind::wholes_by_name:
        if (!value.is_object()) refuse(where, "is not an object");
        for (auto& [key, index] : value.items()) check_whole(index, where + "." + key);
        return;
      case Kind::by_name_list:
        if (!value.is_array()) refuse(where, "is not a list");
        for (json& item : value) check({Kind::wholes_by_name}, name, item, where);
        return;
      case Kind::numbers:
        if (!value.is_array() || (rule.length > 0 && value.size() != rule.length))
          refuse(where, rule.length > 0 ? "is not a list of " + std::to_string(rule.length) + " numbers"
                                        : "is not a list");
        for (const json& number : value)
          if (!number.is_number()) refuse(where, "holds something else than numbers");
        return;
      case Kind::text:
        if (!value.is_string()) refuse(where, "is not a text");
        return;
      case Kind::flag:
        if (!value.is_boolean()) refuse(where, "is neither true nor false");
        return;
      case Kind::object:
        if (name == "extensions") keep_known(value, where);
        return check_object(value, where);
      case Kind::objects:
        return check_section(value, where);
    }
  }

  // Keeps the extensions that are read and records the names of all. Recording them here covers files that
  // forget to list an extension that they use.
  void keep_known(json& extensions, const std::string& where) {
    if (!extensions.is_object()) refuse(where, "is not an object");
    json known = json::object();
    for (auto& [name, value] : extensions.items()) {
      out_.used.insert(name);
      if (name == kMeshopt || name == kDraco || name == kPointer) known[name] = std::move(value);
    }
    extensions = std::move(known);
  }

  CheckedJson& out_;
};

std::set<std::string> names(const json& root, const char* member) {
  std::set<std::string> names;
  const auto found = root.find(member);
  if (found == root.end()) return names;
  if (!found->is_array()) refuse(member, "is not a list");
  for (const json& name : *found) {
    if (!name.is_string()) refuse(member, "holds something else than names");
    names.insert(name.get<std::string>());
  }
  return names;
}

void check_version(const json& root) {
  const auto asset = root.find("asset");
  const auto text = [&](const char* member) -> std::string {
    if (asset == root.end() || !asset->is_object()) return {};
    const auto found = asset->find(member);
    return found != asset->end() && found->is_string() ? found->get<std::string>() : std::string();
  };
  const std::string version = text("version"), least = text("minVersion");
  if (version.empty()) refuse("'asset'", "names no version");
  if (version != "2" && !version.starts_with("2."))
    throw InputError("is a file of glTF " + version + "; only glTF 2 is read, so convert it to glTF 2");
  if (!least.empty() && least != "2.0")
    throw InputError("needs a reader of glTF " + least + "; export it as glTF 2.0");
}

// Returns the names of a mesh's morph targets. The specification leaves names to extras; the larger
// exporters agree on this place.
std::vector<std::string> target_names(const json& mesh) {
  std::vector<std::string> names;
  if (!mesh.is_object()) return names;
  const auto extras = mesh.find("extras");
  if (extras == mesh.end() || !extras->is_object()) return names;
  const auto listed = extras->find("targetNames");
  if (listed == extras->end() || !listed->is_array()) return names;
  for (const json& name : *listed) names.push_back(name.is_string() ? name.get<std::string>() : "");
  return names;
}

// Returns how deep brackets nest outside of strings. The JSON library could tell this too, but at a cost
// that grows with the square of a list's length.
std::size_t deepest(std::string_view text) {
  std::size_t depth = 0, most = 0;
  bool within_text = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (within_text && c == '\\') ++i;
    if (c == '"') within_text = !within_text;
    if (within_text) continue;
    if (c == '{' || c == '[') most = std::max(most, ++depth);
    if ((c == '}' || c == ']') && depth > 0) --depth;
  }
  return most;
}

json parsed(std::string_view text) {
  if (deepest(text) > kDeepest)
    throw InputError("the glTF file's JSON nests deeper than " + std::to_string(kDeepest) +
                     " levels; repair the file");
  try {
    return json::parse(text.begin(), text.end());
  } catch (const json::exception& error) {
    const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
    if (first != std::string_view::npos && text[first] != '{')
      throw InputError(
          "is no glTF file, whatever its name says: it does not begin as one; give it the extension of its "
          "own format");
    throw InputError(std::string("the glTF file's JSON is damaged (") + error.what() + "); export it again");
  }
}

// Removes the channels that move no node and notes them. tinygltf drops such channels without saying which.
void take_out_channels(json& animation, std::vector<std::string>& notes) {
  constexpr std::size_t kMostNamed = 20;
  const auto channels = animation.find("channels");
  if (channels == animation.end()) return;
  json kept = json::array();
  std::size_t pointers = 0, lost = 0;
  const json::json_pointer pointer("/extensions/" + std::string(kPointer) + "/pointer");
  for (json& channel : *channels) {
    const json target = channel.value("target", json::object());
    if (target.contains("node") && target.value("path", "") != "pointer") {
      kept.push_back(std::move(channel));
    } else if (!target.contains(pointer) || !target[pointer].is_string()) {
      ++lost;
    } else if (++pointers <= kMostNamed) {
      notes.push_back("the animation channel of " + std::string(kPointer) + " to '" +
                      target[pointer].get<std::string>() + "' is ignored");
    }
  }
  if (pointers > kMostNamed)
    notes.push_back(std::to_string(pointers - kMostNamed) + " more channels of " + kPointer + " are ignored");
  if (lost > 0) notes.push_back(std::to_string(lost) + " animation channels name no node and are ignored");
  *channels = std::move(kept);
}

}  // namespace

CheckedJson checked_json(std::string_view text) {
  CheckedJson out;
  json root = parsed(text);
  if (!root.is_object()) throw InputError("is no glTF file: its JSON is no object; export it again");
  check_version(root);
  out.used = names(root, "extensionsUsed");
  out.required = names(root, "extensionsRequired");
  require_known(out.required);
  if (root.contains("meshes"))
    for (const json& mesh : root["meshes"]) out.target_names.push_back(target_names(mesh));

  out.root["asset"]["version"] = "2.0";
  Checker checker(out);
  for (const char* name : kSections)
    if (root.contains(name)) {
      checker.check_section(root[name], name);
      out.root[name] = std::move(root[name]);
    }
  if (root.contains("scene")) {
    check_whole(root["scene"], "scene");
    out.root["scene"] = root["scene"];
  }
  if (out.root.contains("animations"))
    for (json& animation : out.root["animations"]) take_out_channels(animation, out.notes);
  for (std::string& note : notes_on(out.used)) out.notes.push_back(std::move(note));
  return out;
}

}  // namespace cscd::scenes::gltf
