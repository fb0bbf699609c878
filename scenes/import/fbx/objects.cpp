#include "scenes/import/fbx/objects.h"

#include <unordered_map>

#include "core/base/error.h"

namespace cscd::scenes::fbx {
namespace {

// A property is written as `P: name, type, label, flags, values...`.
constexpr std::size_t kFirstPropertyValue = 4;

const Element* property_in(const Element* properties, std::string_view name) {
  if (properties == nullptr) return nullptr;
  // If properties have the same name, the last one is valid.
  for (std::size_t i = properties->children.size(); i-- > 0;)
    if (const Element& property = properties->children[i]; property.name == "P" && property.text(0) == name)
      return &property;
  return nullptr;
}

const Element* property_of(const Object& object, std::string_view name) {
  const Element* own = property_in(object.element->child("Properties70"), name);
  return own != nullptr ? own : property_in(object.defaults, name);
}

std::optional<double> number_in(const Element* property, std::size_t index) {
  const std::size_t i = kFirstPropertyValue + index;
  if (property == nullptr || i >= property->values.size()) return std::nullopt;
  const Value& value = property->values[i];
  if (value.kind == Value::Kind::integer || value.kind == Value::Kind::real) return value.real;
  // Switches are letters in some text files.
  if (value.kind == Value::Kind::text && value.text.size() > 1)
    throw InputError("property " + std::string(property->text(0)) + ": '" +
                     std::string(value.text.substr(0, 40)) +
                     "' is no number; repair it or export the file again");
  return std::nullopt;
}

// Text files write "Model::Hips"; binary files write "Hips", two bytes, "Model".
std::string name_of(std::string_view written, bool binary) {
  if (binary) return std::string(written.substr(0, written.find(std::string_view("\0\1", 2))));
  const std::size_t colons = written.find("::");
  return std::string(colons == written.npos ? written : written.substr(colons + 2));
}

// Returns the default properties of each type. A type with several templates (node attributes) gets none.
std::map<std::string_view, const Element*> templates_of(const Document& document) {
  std::map<std::string_view, const Element*> defaults;
  const Element* definitions = document.root.child("Definitions");
  if (definitions == nullptr) return defaults;
  for (const Element& type : definitions->children) {
    if (type.name != "ObjectType") continue;
    const Element* only = nullptr;
    int count = 0;
    for (const Element& child : type.children)
      if (child.name == "PropertyTemplate" && ++count == 1) only = child.child("Properties70");
    if (count == 1) defaults[type.text(0)] = only;
  }
  return defaults;
}

}  // namespace

Objects::Objects(const Document& document) : document_(document) {
  const auto defaults = templates_of(document);
  std::unordered_map<std::int64_t, std::size_t> by_id;
  for (const Element& section : document.root.children) {
    if (section.name != "Objects") continue;
    for (const Element& element : section.children) {
      if (element.values.empty() || element.values[0].kind != Value::Kind::integer) continue;
      Object object;
      object.id = element.integer(0);
      object.type = element.name;
      object.name = name_of(element.text(1), document.binary);
      object.subtype = element.text(2);
      object.element = &element;
      const auto found = defaults.find(object.type);
      object.defaults = found == defaults.end() ? nullptr : found->second;
      if (!by_id.try_emplace(object.id, objects_.size()).second)
        throw InputError("object " + std::to_string(object.id) + " '" + object.name +
                         "': another object has the same number; export it again");
      objects_.push_back(std::move(object));
    }
  }
  for (const Element& section : document.root.children) {
    if (section.name != "Connections") continue;
    for (const Element& element : section.children) {
      const std::string_view kind = element.text(0);
      if (element.name != "C" || (kind != "OO" && kind != "OP")) continue;
      const auto source = by_id.find(element.integer(1, -1));
      const std::int64_t target = element.integer(2, -1);
      const auto destination = by_id.find(target);
      if (source == by_id.end() || (destination == by_id.end() && target != 0)) continue;
      connections_.push_back({&objects_[source->second],
                              destination == by_id.end() ? nullptr : &objects_[destination->second],
                              kind == "OP" ? element.text(3) : std::string_view()});
    }
  }
  for (std::size_t c = 0; c < connections_.size(); ++c) {
    into_[connections_[c].destination].push_back(c);
    out_of_[connections_[c].source].push_back(c);
  }
}

std::vector<const Object*> Objects::all(std::string_view type) const {
  std::vector<const Object*> found;
  for (const Object& object : objects_)
    if (object.type == type) found.push_back(&object);
  return found;
}

std::vector<Connection> Objects::into(const Object& destination) const {
  std::vector<Connection> found;
  if (const auto list = into_.find(&destination); list != into_.end())
    for (const std::size_t c : list->second) found.push_back(connections_[c]);
  return found;
}

std::vector<const Object*> Objects::sources(const Object& destination, std::string_view type) const {
  std::vector<const Object*> found;
  for (const Connection& connection : into(destination))
    if (connection.property.empty() && connection.source->type == type) found.push_back(connection.source);
  return found;
}

std::vector<Connection> Objects::out_of(const Object& source) const {
  std::vector<Connection> found;
  if (const auto list = out_of_.find(&source); list != out_of_.end())
    for (const std::size_t c : list->second) found.push_back(connections_[c]);
  return found;
}

std::optional<double> Objects::setting(std::string_view name) const {
  const Element* settings = document_.root.child("GlobalSettings");
  return settings == nullptr ? std::nullopt
                             : number_in(property_in(settings->child("Properties70"), name), 0);
}

bool Objects::made_by(std::string_view program) const {
  const Element* creator = document_.root.child("Creator");
  return creator != nullptr && creator->text(0).find(program) != std::string_view::npos;
}

double Objects::ticks_per_second() const {
  // Newer files may state by TCDefinition that they count time in other ticks; 127 stands for the old ticks.
  constexpr double kOld = 46186158000.0, kNew = 141120000.0;
  constexpr std::int64_t kOldDefinition = 127, kFirstHeader = 1004;
  const Element* header = document_.root.child("FBXHeaderExtension");
  const Element* version = header == nullptr ? nullptr : header->child("FBXHeaderVersion");
  const Element* flags = header == nullptr ? nullptr : header->child("OtherFlags");
  const Element* definition = flags == nullptr ? nullptr : flags->child("TCDefinition");
  if (version == nullptr || version->integer(0) < kFirstHeader || definition == nullptr)
    return document_.version < 8000 ? kOld : kNew;
  return definition->integer(0, kOldDefinition) == kOldDefinition ? kOld : kNew;
}

bool has_property(const Object& object, std::string_view name) {
  return property_of(object, name) != nullptr;
}

std::optional<double> number(const Object& object, std::string_view name) {
  return number_in(property_of(object, name), 0);
}

double number(const Object& object, std::string_view name, double otherwise) {
  return number(object, name).value_or(otherwise);
}

std::int64_t integer(const Object& object, std::string_view name, std::int64_t otherwise) {
  const Element* property = property_of(object, name);
  if (!number_in(property, 0)) return otherwise;
  const Value& value = property->values[kFirstPropertyValue];
  if (value.kind == Value::Kind::integer) return value.integer;
  return std::abs(value.real) < 1e15 ? static_cast<std::int64_t>(value.real) : otherwise;
}

Vec3 vector(const Object& object, std::string_view name, const Vec3& otherwise) {
  const Element* property = property_of(object, name);
  Vec3 value = otherwise;
  if (property != nullptr && property->values.size() > kFirstPropertyValue + 3)
    throw InputError(
        object.name + ": its property " + std::string(name) +
        " has more than three numbers, as where points are written as commas; export the file again");
  for (std::size_t k = 0; k < 3; ++k)
    if (const auto part = number_in(property, k)) value[static_cast<int>(k)] = *part;
  return value;
}

std::string told(const char* kind, const Object& object) {
  return std::string(kind) + " '" + object.name + "'";
}

}  // namespace cscd::scenes::fbx
