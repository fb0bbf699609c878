#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/base/vec3.h"
#include "scenes/import/fbx/document.h"

// The objects of an FBX file and how they are connected. Objects are identified by their numbers; names are
// for people and need not be unique.
namespace cscd::scenes::fbx {

// One object of the file. Texts point into the document.
struct Object {
  std::int64_t id = 0;
  std::string_view type;     // "Model", "Geometry", "Deformer", ...
  std::string_view subtype;  // "Mesh", "LimbNode", "Skin", ...
  std::string name;
  const Element* element = nullptr;
  const Element* defaults = nullptr;  // the properties that all objects of the type share, or null
};

// States that the source belongs to the destination or to one of the destination's properties.
struct Connection {
  const Object* source;
  const Object* destination;  // null for the scene itself
  std::string_view property;  // empty for the whole object
};

// All objects of a document and their connections.
class Objects {
 public:
  // The document must outlive the objects. Throws InputError where two objects have one number.
  explicit Objects(const Document& document);

  // Returns all objects of a type, in the order of the file.
  std::vector<const Object*> all(std::string_view type) const;

  // Returns the connections that end at an object, in the order of the file.
  std::vector<Connection> into(const Object& destination) const;
  // Returns the objects of a type that belong to an object as a whole.
  std::vector<const Object*> sources(const Object& destination, std::string_view type) const;
  // Returns the connections that start at an object, in the order of the file.
  std::vector<Connection> out_of(const Object& source) const;

  // Returns the first number of a property of the scene's settings, or nullopt.
  std::optional<double> setting(std::string_view name) const;
  // Tells whether the file says that a program of this name wrote it.
  bool made_by(std::string_view program) const;
  // Returns the number of the file's units of time in a second.
  double ticks_per_second() const;

 private:
  const Document& document_;
  std::vector<Object> objects_;
  std::vector<Connection> connections_;
  std::map<const Object*, std::vector<std::size_t>> into_, out_of_;
};

// Read a property of an object. An object's own value takes precedence over its type's default; `otherwise`
// is returned where there is neither.
bool has_property(const Object& object, std::string_view name);
std::optional<double> number(const Object& object, std::string_view name);
double number(const Object& object, std::string_view name, double otherwise);
std::int64_t integer(const Object& object, std::string_view name, std::int64_t otherwise);
Vec3 vector(const Object& object, std::string_view name, const Vec3& otherwise);

// Returns "node 'Hips'" and the like, for errors.
std::string told(const char* kind, const Object& object);

}  // namespace cscd::scenes::fbx
