#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "core/base/test_refusal.h"
#include "scenes/base/test_says.h"
#include "scenes/character/pose.h"
#include "scenes/import/fbx/read_fbx.h"

// FBX text files that tests write in code.
namespace cscd::scenes {

inline std::string listed(const std::vector<double>& numbers) {
  std::string text;
  char buffer[40];
  for (const double number : numbers) {
    std::snprintf(buffer, sizeof buffer, "%s%.17g", text.empty() ? "" : ",", number);
    text += buffer;
  }
  return text;
}

inline std::string array(const std::string& name, const std::vector<double>& numbers) {
  return name + ": *" + std::to_string(numbers.size()) + " {\n a: " + listed(numbers) + "\n}\n";
}

inline std::string property(const std::string& name, const std::vector<double>& numbers) {
  return "P: \"" + name + "\", \"\", \"\", \"A\"," + listed(numbers) + "\n";
}

// Converts a time in seconds to ticks.
inline double ticks(double seconds) {
  return std::nearbyint(seconds * 46186158000.0);
}

struct FbxText {
  std::string objects, connections, version = "7400", settings;

  void add(const std::string& type, int id, const std::string& name, const std::string& subtype,
           const std::string& properties, const std::string& body = {}) {
    objects += type + ": " + std::to_string(id) + ", \"" + type + "::" + name + "\", \"" + subtype +
               "\" {\nProperties70:  {\n" + properties + "}\n" + body + "}\n";
  }
  void connect(int source, int destination, const std::string& property = {}) {
    connections += "C: \"" + std::string(property.empty() ? "OO" : "OP") + "\"," + std::to_string(source) +
                   "," + std::to_string(destination) + (property.empty() ? "" : ", \"" + property + "\"") +
                   "\n";
  }
  void model(int id, const std::string& name, int parent, const std::string& properties,
             const std::string& subtype = "LimbNode") {
    add("Model", id, name, subtype, properties);
    connect(id, parent);
  }
  // Adds a mesh of these points and polygons. The last corner of a polygon is written as -1 - vertex.
  void mesh(int id, const std::vector<int>& models, const std::vector<double>& points,
            const std::vector<double>& polygons, const std::string& body = {}) {
    add("Geometry", id, "mesh", "Mesh", "",
        array("Vertices", points) + array("PolygonVertexIndex", polygons) + body);
    for (const int model : models) connect(id, model);
  }
  // Adds a mesh of kPoints.
  void triangle(int id, int model) { mesh(id, {model}, {1, 0, 0, 0, 1, 0, 0.5, 0.25, 1}, {0, 1, -3}); }
  void skin(int id, int geometry) {
    add("Deformer", id, "skin", "Skin", "");
    connect(id, geometry);
  }
  void cluster(int id, int skin, int bone, const std::vector<double>& vertices,
               const std::vector<double>& weights, const std::vector<double>& transform,
               const std::vector<double>& link, const std::string& body = {}) {
    add("Deformer", id, "cluster", "Cluster", "",
        body + array("Indexes", vertices) + array("Weights", weights) + array("Transform", transform) +
            array("TransformLink", link));
    connect(id, skin);
    connect(bone, id);
  }
  // Adds the stack 50 with its first layer 51.
  void clip(double start, double stop) {
    add("AnimationStack", 50, "clip", "",
        property("LocalStart", {ticks(start)}) + property("LocalStop", {ticks(stop)}));
    layer(51, "");
  }
  void layer(int id, const std::string& properties) {
    add("AnimationLayer", id, "layer" + std::to_string(id), "", properties);
    connect(id, 50);
  }
  void curve_node(int id, int layer, int target, const std::string& property, const std::string& defaults) {
    add("AnimationCurveNode", id, "node", "", defaults);
    connect(id, layer);
    connect(id, target, property);
  }
  // Adds a curve. `flags` are those of all keys; `data` holds four numbers a key and may be left out.
  void curve(int id, int node, const std::string& channel, const std::vector<double>& seconds,
             const std::vector<double>& values, const std::vector<double>& flags = {},
             const std::vector<double>& data = {}) {
    std::vector<double> times;
    for (const double time : seconds) times.push_back(ticks(time));
    std::string body = array("KeyTime", times) + array("KeyValueFloat", values);
    if (!flags.empty())
      body += array("KeyAttrFlags", flags) +
              array("KeyAttrDataFloat", data.empty() ? std::vector<double>(4 * flags.size(), 0) : data) +
              array("KeyAttrRefCount", std::vector<double>(flags.size(), 1));
    add("AnimationCurve", id, "", "", "", body);
    connect(id, node, channel);
  }

  std::string text() const {
    return "; FBX\nFBXHeaderExtension:  {\n FBXVersion: " + version +
           "\n}\nGlobalSettings:  {\n Properties70:  {\n" + settings + " }\n}\nObjects:  {\n" + objects +
           "}\nConnections:  {\n" + connections + "}\n";
  }
};

inline const Vec3 kPoints[3] = {{1, 0, 0}, {0, 1, 0}, {0.5, 0.25, 1}};

// The model 20 with the triangle 10.
inline FbxText triangle_file(const std::string& properties = {}) {
  FbxText file;
  file.model(20, "node", 0, properties, "Mesh");
  file.triangle(10, 20);
  return file;
}

inline Character read(const FbxText& file) {
  const std::string text = file.text();
  Character character = read_fbx(text, {});
  validate(character, {});
  return character;
}

inline std::string refusal_of(const std::string& bytes, const CharacterLimits& limits = {}) {
  return test::refusal([&] {
    const Character character = read_fbx(bytes, limits);
    validate(character, limits);
  });
}

inline std::string refusal_of(const FbxText& file, const CharacterLimits& limits = {}) {
  return refusal_of(file.text(), limits);
}

inline std::vector<Vec3> vertices_at(const Character& character, double seconds) {
  std::vector<Vec3> out;
  if (character.animations.empty())
    skin(character, rest_pose(character), out);
  else
    skin(character, pose_at(character, character.animations[0], seconds),
         weights_at(character, character.animations[0], seconds), out);
  return out;
}

inline void expect_at(const Vec3& was, const Vec3& expected, const std::string& what = {}) {
  EXPECT_LT((was - expected).norm(), 1e-9)
      << what << ": " << was.transpose() << " instead of " << expected.transpose();
}

// The maps of the transform's formula, written out a second time so that tests do not depend on the reader.
inline Transform moved(const Vec3& by) {
  Transform map;
  map.origin = by;
  return map;
}
inline Transform scaled_by(const Vec3& by) {
  Transform map;
  for (int k = 0; k < 3; ++k) map.column[static_cast<std::size_t>(k)] *= by[k];
  return map;
}
// A rotation about one axis by the right-hand rule.
inline Transform turned(int axis, double degrees) {
  const double angle = degrees * 3.14159265358979323846 / 180, c = std::cos(angle), s = std::sin(angle);
  const auto next = static_cast<std::size_t>((axis + 1) % 3),
             after = static_cast<std::size_t>((axis + 2) % 3);
  Transform map;
  map.column[next][static_cast<int>(next)] = map.column[after][static_cast<int>(after)] = c;
  map.column[next][static_cast<int>(after)] = s;
  map.column[after][static_cast<int>(next)] = -s;
  return map;
}
// Rotations about all axes; `axes` lists the axes in the order of turning.
inline Transform turned(const Vec3& degrees, const std::array<int, 3>& axes = {0, 1, 2}) {
  Transform map;
  for (const int axis : axes) map = composed(turned(axis, degrees[axis]), map);
  return map;
}
inline Transform product(std::initializer_list<Transform> factors) {
  Transform map;
  for (const Transform& factor : factors) map = composed(map, factor);
  return map;
}
inline std::vector<double> matrix(const Transform& map) {
  std::vector<double> m;
  for (const Vec3& column : map.column) m.insert(m.end(), {column.x(), column.y(), column.z(), 0});
  m.insert(m.end(), {map.origin.x(), map.origin.y(), map.origin.z(), 1});
  return m;
}

}  // namespace cscd::scenes
