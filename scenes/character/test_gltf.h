#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "scenes/character/character.h"

namespace cscd::scenes {

inline std::string base64(const std::string& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k > bytes.size() ? '=' : kDigits[(word >> (18 - 6 * k)) & 63];
  }
  return out;
}

// Writes a character as a glTF 2 text with its data inside, so that a test of the import needs no model file
// beside it. Every part becomes a mesh of one primitive; vertices have as many sets of four influences as the
// part needs. The format rounds numbers to float, and reduces nodes to a move, a rotation and a scale.
class GltfText {
 public:
  explicit GltfText(const Character& character) : character_(character) {
    for (const Part& part : character.parts) add(part);
    for (const Animation& animation : character.animations) add(animation);
    for (std::size_t n = 0; n < character.nodes.size(); ++n) add_node(n);
  }

  std::string text() const {
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + nodes_ + "]" +
           list("meshes", meshes_) + list("skins", skins_) + list("animations", animations_) +
           list("accessors", accessors_) + list("bufferViews", views_) + R"(,"buffers":[{"byteLength":)" +
           std::to_string(bytes_.size()) + R"(,"uri":"data:application/octet-stream;base64,)" +
           base64(bytes_) + "\"}]}";
  }

 private:
  static std::string list(const char* name, const std::string& items) {
    return items.empty() ? std::string() : std::string(",\"") + name + "\":[" + items + "]";
  }
  static void append(std::string& items, const std::string& item) {
    items += (items.empty() ? "" : ",") + item;
  }
  static std::string number(double value) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.9g", static_cast<double>(static_cast<float>(value)));
    return digits;
  }

  // Adds an accessor of these values, with a buffer view of its own, and returns its number.
  template <class Value>
  int accessor(const std::vector<Value>& values, std::size_t width, const char* type, int component,
               const std::string& bounds = {}) {
    const std::size_t start = bytes_.size(), size = values.size() * sizeof(Value);
    bytes_.resize(start + (size + 3) / 4 * 4);
    if (size > 0) std::memcpy(bytes_.data() + start, values.data(), size);
    append(views_, R"({"buffer":0,"byteOffset":)" + std::to_string(start) + R"(,"byteLength":)" +
                       std::to_string(size) + "}");
    append(accessors_, R"({"bufferView":)" + std::to_string(count_) + R"(,"componentType":)" +
                           std::to_string(component) + R"(,"count":)" +
                           std::to_string(values.size() / width) + R"(,"type":")" + type + "\"" + bounds +
                           "}");
    return count_++;
  }
  int floats(const std::vector<double>& values, std::size_t width, const char* type,
             const std::string& bounds = {}) {
    return accessor(std::vector<float>(values.begin(), values.end()), width, type, 5126, bounds);
  }

  void add(const Part& part) {
    std::vector<double> positions;
    for (const Vec3& x : part.positions) positions.insert(positions.end(), {x.x(), x.y(), x.z()});
    std::string attributes = R"("POSITION":)" + std::to_string(floats(positions, 3, "VEC3"));
    std::size_t most = 0;
    for (std::size_t v = 0; v < part.positions.size(); ++v)
      most = std::max(most, part.first[v + 1] - part.first[v]);
    for (std::size_t set = 0; 4 * set < most; ++set) {
      std::vector<std::uint16_t> joints(4 * part.positions.size(), 0);
      std::vector<double> weights(joints.size(), 0);
      for (std::size_t v = 0; v < part.positions.size(); ++v)
        for (std::size_t k = 0; k < 4 && part.first[v] + 4 * set + k < part.first[v + 1]; ++k) {
          const Influence& influence = part.influences[part.first[v] + 4 * set + k];
          joints[4 * v + k] = static_cast<std::uint16_t>(influence.joint);
          weights[4 * v + k] = influence.weight;
        }
      attributes += ",\"JOINTS_" + std::to_string(set) +
                    "\":" + std::to_string(accessor(joints, 4, "VEC4", 5123)) + ",\"WEIGHTS_" +
                    std::to_string(set) + "\":" + std::to_string(floats(weights, 4, "VEC4"));
    }
    std::vector<std::uint32_t> corners;
    for (const auto& t : part.triangles)
      for (const std::int32_t corner : t) corners.push_back(static_cast<std::uint32_t>(corner));
    append(meshes_, R"({"name":")" + part.name + R"(","primitives":[{"attributes":{)" + attributes +
                        R"(},"indices":)" + std::to_string(accessor(corners, 1, "SCALAR", 5125)) + "}]}");
    if (part.joints.empty()) return;
    std::string nodes;
    std::vector<double> offsets;
    for (const Joint& joint : part.joints) {
      append(nodes, std::to_string(joint.node));
      for (const Vec3& column : joint.offset.column)
        offsets.insert(offsets.end(), {column.x(), column.y(), column.z(), 0});
      const Vec3& origin = joint.offset.origin;
      offsets.insert(offsets.end(), {origin.x(), origin.y(), origin.z(), 1});
    }
    append(skins_, R"({"joints":[)" + nodes + R"(],"inverseBindMatrices":)" +
                       std::to_string(floats(offsets, 16, "MAT4")) + "}");
  }

  template <class Value, class Convert>
  void add_keys(const std::vector<Key<Value>>& keys, int node, const char* path, const char* type,
                std::size_t width, const Convert& convert, std::string& samplers, std::string& channels,
                int& sampler) {
    if (keys.empty()) return;
    std::vector<double> times, values;
    for (const Key<Value>& key : keys) {
      times.push_back(key.time);
      convert(key.value, values);
    }
    const int input =
        floats(times, 1, "SCALAR",
               R"(,"min":[)" + number(times.front()) + R"(],"max":[)" + number(times.back()) + "]");
    const int output = floats(values, width, type);
    append(samplers, R"({"input":)" + std::to_string(input) + R"(,"output":)" + std::to_string(output) + "}");
    append(channels, R"({"sampler":)" + std::to_string(sampler++) + R"(,"target":{"node":)" +
                         std::to_string(node) + R"(,"path":")" + path + "\"}}");
  }

  void add(const Animation& animation) {
    std::string samplers, channels;
    int sampler = 0;
    const auto vector = [](const Vec3& v, std::vector<double>& out) {
      out.insert(out.end(), {v.x(), v.y(), v.z()});
    };
    const auto turn = [](const Quaternion& q, std::vector<double>& out) {
      out.insert(out.end(), {q.x, q.y, q.z, q.w});
    };
    for (const Channel& c : animation.channels) {
      add_keys(c.moves, c.node, "translation", "VEC3", 3, vector, samplers, channels, sampler);
      add_keys(c.rotations, c.node, "rotation", "VEC4", 4, turn, samplers, channels, sampler);
      add_keys(c.scales, c.node, "scale", "VEC3", 3, vector, samplers, channels, sampler);
    }
    const std::string name = animation.name.empty() ? "" : R"("name":")" + animation.name + "\",";
    append(animations_, "{" + name + R"("samplers":[)" + samplers + R"(],"channels":[)" + channels + "]}");
  }

  void add_node(std::size_t n) {
    const Node& node = character_.nodes[n];
    const Trs parts = trs_of(node.local);
    std::string children;
    for (std::size_t c = n + 1; c < character_.nodes.size(); ++c)
      if (character_.nodes[c].parent == static_cast<int>(n)) append(children, std::to_string(c));
    std::string text = R"({"name":")" + node.name + R"(","translation":[)" + number(parts.move.x()) + "," +
                       number(parts.move.y()) + "," + number(parts.move.z()) + R"(],"rotation":[)" +
                       number(parts.rotation.x) + "," + number(parts.rotation.y) + "," +
                       number(parts.rotation.z) + "," + number(parts.rotation.w) + R"(],"scale":[)" +
                       number(parts.rest[0].x()) + "," + number(parts.rest[1].y()) + "," +
                       number(parts.rest[2].z()) + "]";
    int skin = 0;
    for (std::size_t p = 0; p < character_.parts.size(); ++p) {
      const Part& part = character_.parts[p];
      if (part.node == static_cast<int>(n)) {
        text += R"(,"mesh":)" + std::to_string(p);
        if (!part.joints.empty()) text += R"(,"skin":)" + std::to_string(skin);
      }
      skin += !part.joints.empty();
    }
    append(nodes_, text + list("children", children) + "}");
  }

  const Character& character_;
  std::string bytes_, accessors_, views_, meshes_, skins_, animations_, nodes_;
  int count_ = 0;
};

inline std::string to_gltf(const Character& character) {
  return GltfText(character).text();
}

}  // namespace cscd::scenes
