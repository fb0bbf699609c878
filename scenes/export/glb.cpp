#include "scenes/export/glb.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <vector>

#include "core/base/error.h"

// Section numbers refer to the glTF 2.0 specification.
namespace cscd::scenes {
namespace {

// Writes a number of four bytes.
std::string word(std::size_t number) {
  const auto value = static_cast<std::uint32_t>(number);
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "glTF buffers are little-endian");

// The specification's numbers for component types and for the targets of buffer views.
template <class Value>
constexpr int kComponent = 0;
template <>
constexpr int kComponent<float> = 5126;
template <>
constexpr int kComponent<std::uint16_t> = 5123;
template <>
constexpr int kComponent<std::uint32_t> = 5125;
enum class Target { none = 0, vertices = 34962, corners = 34963 };

constexpr std::size_t kSet = 4;  // influences of a vertex in one pair of JOINTS_n and WEIGHTS_n

[[noreturn]] void refuse(const std::string& what) {
  throw InputError(what + "; a .glb file cannot hold that");
}

void append(std::vector<float>& out, double x) {
  const auto value = static_cast<float>(x);
  if (!std::isfinite(value)) refuse("the number " + std::to_string(x) + " is beyond single precision");
  out.push_back(value);
}
void append(std::vector<float>& out, const Vec3& x) {
  for (int k = 0; k < 3; ++k) append(out, x[k]);
}
// Rotations are unit quaternions (3.11).
void append(std::vector<float>& out, const Quaternion& q) {
  const Quaternion unit = normalised(q);
  for (const double x : {unit.x, unit.y, unit.z, unit.w}) append(out, x);
}

// The binary chunk, with the list of its views and accessors.
class Buffer {
 public:
  // Adds values, `width` of them in each element, and returns the number of their accessor. Every accessor
  // has a view of its own, which begins at a multiple of four bytes (3.6.2.4), because the sizes of all
  // elements written are multiples of four.
  template <class Value>
  std::size_t add(const std::vector<Value>& values, std::size_t width, const char* type,
                  Target target = Target::none) {
    const std::size_t bytes = values.size() * sizeof(Value);
    Json view{{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes}};
    if (target != Target::none) view["target"] = static_cast<int>(target);
    views_.push_back(std::move(view));
    accessors_.push_back({{"bufferView", accessors_.size()},
                          {"componentType", kComponent<Value>},
                          {"count", values.size() / width},
                          {"type", type}});
    bytes_.append(reinterpret_cast<const char*>(values.data()), bytes);
    return accessors_.size() - 1;
  }

  // Adds values as add() does, with the least and the largest value of each component, which the
  // specification requires for positions and for times of keys.
  std::size_t add_bounded(const std::vector<float>& values, std::size_t width, const char* type,
                          Target target = Target::none) {
    const std::size_t accessor = add(values, width, type, target);
    std::vector<float> low(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(width)), high = low;
    for (std::size_t i = 0; i < values.size(); ++i) {
      low[i % width] = std::min(low[i % width], values[i]);
      high[i % width] = std::max(high[i % width], values[i]);
    }
    accessors_.back()["min"] = low;
    accessors_.back()["max"] = high;
    return accessor;
  }

  const std::string& bytes() const { return bytes_; }
  const Json& views() const { return views_; }
  const Json& accessors() const { return accessors_; }

 private:
  std::string bytes_;
  Json views_ = Json::array(), accessors_ = Json::array();
};

void add_influences(const Part& part, Buffer& buffer, Json& attributes) {
  std::size_t most = 0;
  for (std::size_t v = 0; v < part.positions.size(); ++v) {
    const std::size_t own = part.first[v + 1] - part.first[v];
    if (own == 0)
      refuse("mesh '" + part.name + "', vertex " + std::to_string(v) + ": follows no joint of the skin");
    most = std::max(most, own);
  }
  for (std::size_t begin = 0; begin < most; begin += kSet) {
    std::vector<std::uint16_t> joints(kSet * part.positions.size(), 0);
    std::vector<float> weights(joints.size(), 0);
    for (std::size_t v = 0; v < part.positions.size(); ++v)
      for (std::size_t k = 0; k < kSet && part.first[v] + begin + k < part.first[v + 1]; ++k) {
        const Influence& influence = part.influences[part.first[v] + begin + k];
        const auto weight = static_cast<float>(influence.weight);
        if (weight == 0) continue;  // 3.7.3.3: the joint of a weight of 0 is 0
        joints[kSet * v + k] = static_cast<std::uint16_t>(influence.joint);
        weights[kSet * v + k] = weight;
      }
    const std::string set = std::to_string(begin / kSet);
    attributes["JOINTS_" + set] = buffer.add(joints, kSet, "VEC4", Target::vertices);
    attributes["WEIGHTS_" + set] = buffer.add(weights, kSet, "VEC4", Target::vertices);
  }
}

Json mesh_of(const Part& part, Buffer& buffer) {
  if (part.triangles.empty()) refuse("mesh '" + part.name + "': has no triangles");
  if (!part.targets.empty()) refuse("mesh '" + part.name + "': has morph targets, which are not written");
  if (!part.dual_quaternion.empty())
    refuse("mesh '" + part.name + "': follows its joints by dual quaternions, which glTF does not have");
  std::vector<float> positions;
  for (const Vec3& x : part.positions) append(positions, x);
  std::vector<std::uint32_t> corners;
  for (const auto& t : part.triangles)
    for (const std::int32_t corner : t) corners.push_back(static_cast<std::uint32_t>(corner));
  Json attributes{{"POSITION", buffer.add_bounded(positions, 3, "VEC3", Target::vertices)}};
  if (!part.joints.empty()) add_influences(part, buffer, attributes);
  const std::size_t indices = buffer.add(corners, 1, "SCALAR", Target::corners);
  return {{"name", part.name},
          {"primitives", Json::array({{{"attributes", attributes}, {"indices", indices}}})}};
}

Json skin_of(const Part& part, Buffer& buffer) {
  std::vector<float> offsets;
  Json joints = Json::array();
  std::set<int> nodes;
  for (const Joint& joint : part.joints) {
    if (!nodes.insert(joint.node).second) refuse("mesh '" + part.name + "': two of its joints are one node");
    joints.push_back(joint.node);
    for (const Vec3& column : joint.offset.column) append(offsets, column), append(offsets, 0.0);
    append(offsets, joint.offset.origin), append(offsets, 1.0);
  }
  return {{"joints", joints}, {"inverseBindMatrices", buffer.add(offsets, 16, "MAT4")}};
}

Json node_of(const Node& node) {
  const Trs parts = trs_of(node.local);
  ScaleTurnMove local{parts.move, parts.rotation,
                      Vec3(parts.rest[0].x(), parts.rest[1].y(), parts.rest[2].z())};
  if (node.written) {
    local = *node.written;
  } else {
    const double shear =
        std::max({std::abs(parts.rest[1].x()), std::abs(parts.rest[2].x()), std::abs(parts.rest[2].y())});
    if (shear > 1e-6 * local.scale.cwiseAbs().maxCoeff()) refuse("node '" + node.name + "': is sheared");
  }
  std::vector<float> move, rotation, scale;
  append(move, local.move);
  append(rotation, local.rotation);
  append(scale, local.scale);
  Json out{{"name", node.name}};
  if (move != std::vector<float>(3, 0)) out["translation"] = move;
  if (rotation != std::vector<float>{0, 0, 0, 1}) out["rotation"] = rotation;
  if (scale != std::vector<float>(3, 1)) out["scale"] = scale;
  return out;
}

// A quaternion and its negative are the same rotation. This chooses the sign that is nearer to the key
// before, so that readers that do not look for the shorter way go the shorter way too.
std::vector<Key<Quaternion>> nearest_signs(std::vector<Key<Quaternion>> keys) {
  for (std::size_t i = 1; i < keys.size(); ++i) {
    const Quaternion& p = keys[i - 1].value;
    Quaternion& q = keys[i].value;
    if (p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z < 0) q = {-q.w, -q.x, -q.y, -q.z};
  }
  return keys;
}

// Writes the keys of one clip. Keys at the same times share the accessor of their times.
class ClipWriter {
 public:
  ClipWriter(const Animation& animation, Buffer& buffer)
      : where_("clip '" + animation.name + "'"), buffer_(buffer) {
    if (!animation.morphs.empty()) refuse(where_ + ": drives morph targets, which are not written");
    for (const Channel& channel : animation.channels) {
      if (!channel.move_components.empty() || !channel.scale_components.empty() ||
          !channel.angles.degrees.empty())
        refuse(where_ + ": has keys for single components");
      add(channel.node, "translation", channel.moves, 3, "VEC3");
      add(channel.node, "rotation", nearest_signs(channel.rotations), 4, "VEC4");
      add(channel.node, "scale", channel.scales, 3, "VEC3");
    }
    if (channels_.empty()) refuse(where_ + ": moves nothing");
    result = {{"samplers", samplers_}, {"channels", channels_}};
    if (!animation.name.empty()) result["name"] = animation.name;
  }

  Json result;

 private:
  template <class Value>
  void add(int node, const char* path, const std::vector<Key<Value>>& keys, std::size_t width,
           const char* type) {
    if (keys.empty()) return;
    std::vector<float> times, values;
    for (const Key<Value>& key : keys) {
      if (key.next != Between::line) refuse(where_ + ": has keys that are not joined by straight lines");
      append(times, key.time);
      append(values, key.value);
      const std::size_t n = times.size();
      if (times[n - 1] < 0 || (n > 1 && times[n - 1] <= times[n - 2]))
        refuse(where_ + ", key " + std::to_string(n - 1) +
               ": its time is negative, or that of the key before when rounded to single precision");
    }
    const auto [known, is_new] = inputs_.try_emplace(times, 0);
    if (is_new) known->second = buffer_.add_bounded(times, 1, "SCALAR");
    channels_.push_back({{"sampler", samplers_.size()}, {"target", {{"node", node}, {"path", path}}}});
    samplers_.push_back({{"input", known->second}, {"output", buffer_.add(values, width, type)}});
  }

  std::string where_;
  Buffer& buffer_;
  Json samplers_ = Json::array(), channels_ = Json::array();
  std::map<std::vector<float>, std::size_t> inputs_;
};

std::vector<float> rounded(std::span<const Vec3> positions, std::span<const Vec3> base) {
  std::vector<float> out;
  out.reserve(3 * positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v)
    for (int axis = 0; axis < 3; ++axis)
      out.push_back(static_cast<float>(positions[v][axis] - (base.empty() ? 0 : base[v][axis])));
  return out;
}

// The file of a scene whose only root is node 0.
std::string file_of(Json nodes, Json meshes, Json skins, Json clips, const Buffer& buffer) {
  Json file{{"asset", {{"version", "2.0"}, {"generator", "cscd"}}},
            {"scene", 0},
            {"scenes", Json::array({{{"nodes", Json::array({0})}}})},
            {"nodes", std::move(nodes)},
            {"meshes", std::move(meshes)}};
  if (!skins.empty()) file["skins"] = std::move(skins);
  if (!clips.empty()) file["animations"] = std::move(clips);
  file["accessors"] = buffer.accessors();
  file["bufferViews"] = buffer.views();
  file["buffers"] = Json::array({{{"byteLength", buffer.bytes().size()}}});
  return glb_container(file.dump(-1, ' ', false, Json::error_handler_t::replace), buffer.bytes());
}

}  // namespace

Quaternion turn_to_y(std::string_view up) {
  const double half = std::sqrt(0.5);
  if (up == "x") return {half, 0, 0, half};
  if (up == "-x") return {half, 0, 0, -half};
  if (up == "-y") return {0, 1, 0, 0};
  if (up == "z") return {half, -half, 0, 0};
  if (up == "-z") return {half, half, 0, 0};
  return {};
}

std::string glb_container(const std::string& json, const std::string& binary) {
  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  const std::size_t padding = (4 - json.size() % 4) % 4;
  const std::size_t length = kHeader + 2 * kChunkHeader + json.size() + padding + binary.size();
  if (length > UINT32_MAX)
    throw InputError("the file would have " + std::to_string(length) +
                     " bytes; a .glb file cannot hold that");
  std::string out = "glTF" + word(2) + word(length) + word(json.size() + padding) + "JSON" + json;
  out.append(padding, ' ');
  out += word(binary.size()) + std::string("BIN\0", 4);
  return out += binary;
}

std::string to_glb(const Character& character) {
  validate(character, {});
  if (character.parts.empty()) refuse("the character has no mesh");
  Buffer buffer;
  Json nodes = Json::array(), meshes = Json::array(), skins = Json::array(), clips = Json::array();
  for (const Node& node : character.nodes) {
    if (node.parent >= 0) nodes[static_cast<std::size_t>(node.parent)]["children"].push_back(nodes.size());
    nodes.push_back(node_of(node));
  }
  for (const Part& part : character.parts) {
    auto node = static_cast<std::size_t>(part.node);
    if (nodes[node].contains("mesh")) {  // a node has one mesh; another hangs on a node below
      nodes[node]["children"].push_back(nodes.size());
      node = nodes.size();
      nodes.push_back({{"name", part.name}});
    }
    nodes[node]["mesh"] = meshes.size();
    meshes.push_back(mesh_of(part, buffer));
    if (part.joints.empty()) continue;
    nodes[node]["skin"] = skins.size();
    skins.push_back(skin_of(part, buffer));
  }
  for (const Animation& animation : character.animations)
    clips.push_back(ClipWriter(animation, buffer).result);

  return file_of(std::move(nodes), std::move(meshes), std::move(skins), std::move(clips), buffer);
}

std::string baked_glb(ClipSource& clip, const std::string& name, double fps, double first_frame,
                      const std::string& up, double metres_per_unit) {
  const std::size_t frames = clip.frame_count(), targets = frames - 1;
  if (12 * clip.header().vertex_count * frames > UINT32_MAX)
    throw InputError("the frames are more than the 4 GiB of a .glb file; export them as .pc2 or .h5");
  Buffer buffer;
  std::vector<std::uint32_t> corners;
  for (const Triangle& triangle : clip.header().triangles)
    for (const VertexId v : triangle) corners.push_back(static_cast<std::uint32_t>(v));
  Json primitive;
  const std::span<const Vec3> first = clip.load_frame(0).positions;
  const std::vector<Vec3> base(first.begin(), first.end());
  primitive["attributes"]["POSITION"] = buffer.add_bounded(rounded(base, {}), 3, "VEC3", Target::vertices);
  primitive["indices"] = buffer.add(corners, 1, "SCALAR", Target::corners);
  for (std::size_t f = 1; f < frames; ++f)
    primitive["targets"].push_back(
        {{"POSITION",
          buffer.add_bounded(rounded(clip.load_frame(f).positions, base), 3, "VEC3", Target::vertices)}});
  std::vector<float> times, weights(frames * targets, 0.0F);
  for (std::size_t f = 0; f < frames; ++f) {
    times.push_back(static_cast<float>((first_frame + static_cast<double>(f)) / fps));
    if (f > 0) weights[f * targets + f - 1] = 1;
  }
  const std::size_t input = buffer.add_bounded(times, 1, "SCALAR"), output = buffer.add(weights, 1, "SCALAR");

  const Quaternion turn = turn_to_y(up);
  Json nodes = Json::array({{{"name", name},
                             {"mesh", 0},
                             {"rotation", {turn.x, turn.y, turn.z, turn.w}},
                             {"scale", std::vector<double>(3, metres_per_unit)}}});
  Json meshes = Json::array({{{"name", name},
                              {"primitives", Json::array({std::move(primitive)})},
                              {"weights", std::vector<int>(targets, 0)}}});
  Json clips = Json::array(
      {{{"name", "frames"},
        {"samplers", Json::array({{{"input", input}, {"output", output}, {"interpolation", "LINEAR"}}})},
        {"channels", Json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}})}}});
  return file_of(std::move(nodes), std::move(meshes), Json::array(), std::move(clips), buffer);
}

}  // namespace cscd::scenes
