#include "scenes/character/character.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/sort_unique.h"

namespace cscd::scenes {
namespace {

// Larger coordinates are refused: they leave too few bits of a double for the shape of a surface, and their
// squares overflow.
constexpr double kFarthest = 1e15;

[[noreturn]] void refuse(const std::string& what) {
  throw InputError(what);
}

void require_count(const char* what, std::size_t count, std::size_t limit) {
  if (count > limit)
    refuse("has " + std::to_string(count) + " " + what + ", more than the " + std::to_string(limit) +
           " that are supported; simplify the model");
}

bool usable(const Vec3& x) {
  return x.allFinite() && x.cwiseAbs().maxCoeff() <= kFarthest;
}
bool usable(const Transform& map) {
  return usable(map.column[0]) && usable(map.column[1]) && usable(map.column[2]) && usable(map.origin);
}
bool usable(double x) {
  return std::isfinite(x);
}
bool usable(const Quaternion& q) {
  return std::isfinite(q.w) && std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z);
}

void require_node(const Character& character, int node, const std::string& where) {
  if (node < 0 || static_cast<std::size_t>(node) >= character.nodes.size())
    refuse(where + ": names node " + std::to_string(node) + " of " + std::to_string(character.nodes.size()) +
           "; repair the file");
}

void check_response(const MorphTarget& target, const std::string& where) {
  const auto& knots = target.response;
  bool fits = knots.size() != 1;
  for (std::size_t k = 0; k < knots.size(); ++k)
    fits = fits && usable(knots[k].driven) && usable(knots[k].weight) &&
           (k == 0 || knots[k - 1].driven < knots[k].driven);
  if (!fits) refuse(where + ": its weights do not ascend, or are not finite; repair it");
}

void check_part(const Character& character, const Part& part) {
  const std::string where = "mesh '" + part.name + "'";
  const std::size_t vertices = part.positions.size();
  require_node(character, part.node, where);
  for (std::size_t v = 0; v < vertices; ++v)
    if (!usable(part.positions[v]))
      refuse(where + ", vertex " + std::to_string(v) + ": position is not finite, or beyond 1e15; repair it");
  for (std::size_t t = 0; t < part.triangles.size(); ++t)
    for (const std::int32_t corner : part.triangles[t])
      if (corner < 0 || static_cast<std::size_t>(corner) >= vertices)
        refuse(where + ", triangle " + std::to_string(t) + ": corner " + std::to_string(corner) +
               " is outside [0, " + std::to_string(vertices) + "); repair it");
  for (const Joint& joint : part.joints) {
    require_node(character, joint.node, where);
    if (!usable(joint.offset))
      refuse(where + ", joint '" + character.nodes[static_cast<std::size_t>(joint.node)].name +
             "': its bind matrix is not finite; repair it");
  }
  for (const MorphTarget& target : part.targets) {
    const std::string target_where = where + ", morph target '" + target.name + "'";
    if (target.displacements.size() != vertices)
      refuse(target_where + ": has " + std::to_string(target.displacements.size()) + " displacements for " +
             std::to_string(vertices) + " vertices; repair it");
    if (!std::isfinite(target.weight)) refuse(target_where + ": its weight is not finite; repair it");
    check_response(target, target_where);
    for (std::size_t v = 0; v < vertices; ++v)
      if (!usable(target.displacements[v]))
        refuse(target_where + ", vertex " + std::to_string(v) + ": is not finite, or beyond 1e15; repair it");
  }
  const auto is_share = [](double share) { return share >= 0 && share <= 1; };
  if (!part.dual_quaternion.empty() &&
      (part.dual_quaternion.size() != vertices ||
       !std::all_of(part.dual_quaternion.begin(), part.dual_quaternion.end(), is_share)))
    refuse(where + ": its shares of dual quaternions are not one in [0, 1] a vertex; repair it");
  if (part.first.size() != vertices + 1 || part.first.front() != 0 ||
      part.first.back() != part.influences.size() || !std::is_sorted(part.first.begin(), part.first.end()))
    refuse(where + ": its influences are not one list a vertex; repair it");
  for (std::size_t v = 0; v < vertices; ++v) {
    double sum = 0;
    for (std::size_t i = part.first[v]; i < part.first[v + 1]; ++i) {
      const Influence& influence = part.influences[i];
      if (influence.joint < 0 || static_cast<std::size_t>(influence.joint) >= part.joints.size() ||
          !(influence.weight > 0))
        refuse(where + ", vertex " + std::to_string(v) + ": an influence without joint or weight; repair it");
      sum += influence.weight;
    }
    if (part.first[v] < part.first[v + 1] && !(std::abs(sum - 1) < 1e-6))
      refuse(where + ", vertex " + std::to_string(v) + ": its weights do not sum to 1; repair it");
  }
}

template <class Value>
void check_keys(const std::vector<Key<Value>>& keys, const std::string& where) {
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const bool tangents = keys[i].next != Between::cubic || usable(keys[i].leaving);
    const bool arrives = i == 0 || keys[i - 1].next != Between::cubic || usable(keys[i].arriving);
    if (!std::isfinite(keys[i].time) || !usable(keys[i].value) || !tangents || !arrives)
      refuse(where + ", key " + std::to_string(i) + ": is not finite; repair the animation");
    if (i > 0 && !(keys[i].time > keys[i - 1].time))
      refuse(where + ", key " + std::to_string(i) + ": does not come later than the one before; repair it");
  }
}

void check_curve(const Curve& curve, const std::string& where) {
  check_keys(curve.keys, where);
  const Extrapolation& beyond = curve.beyond;
  if (!(beyond.repeats_before >= 0 && beyond.repeats_after >= 0 && std::isfinite(beyond.first) &&
        std::isfinite(beyond.last) && std::isfinite(beyond.tick)))
    refuse(where + ": how it repeats its keys is not finite; repair the animation");
}

template <std::size_t Width>
void check_components(const Components<Width>& components, const std::string& where) {
  for (const Curve& curve : components.axis) check_curve(curve, where);
  for (const double rest : components.rest)
    if (!std::isfinite(rest)) refuse(where + ": is not finite at rest; repair the animation");
}

template <std::size_t Width>
void check_layers(const Layered<Width>& layered, std::size_t weights, const std::string& where) {
  check_components(layered.base, where);
  for (const Layer<Width>& layer : layered.above) {
    check_components(layer.values, where);
    if (layer.weight < -1 || layer.weight >= static_cast<int>(weights))
      refuse(where + ": a layer has no weight; repair the animation");
  }
}

template <std::size_t Width>
std::size_t keys_of(const Layered<Width>& layered) {
  std::size_t keys = 0;
  for_each_curve(layered, [&](const Curve& curve) { keys += curve.keys.size(); });
  return keys;
}

std::size_t keys_of(const Animation& animation) {
  std::size_t keys = 0;
  for (const Channel& channel : animation.channels)
    keys += channel.moves.size() + channel.rotations.size() + channel.scales.size() +
            keys_of(channel.move_components) + keys_of(channel.scale_components) +
            keys_of(channel.angles.degrees);
  for (const MorphChannel& morph : animation.morphs)
    for (const Layered<1>& driven : morph.weights) keys += keys_of(driven);
  for (const Curve& weight : animation.layer_weights) keys += weight.keys.size();
  return keys;
}

void check_order_of_layers(const Layered<3>& degrees, const std::string& where) {
  bool as_maps = false;
  for (const Layer<3>& layer : degrees.above) {
    if (as_maps && !layer.as_maps)
      refuse(where + ": a layer adds angles to a layer of rotations; repair the animation");
    as_maps |= layer.as_maps;
  }
}

void check_animation(const Character& character, const Animation& animation) {
  const std::string where = "clip '" + animation.name + "'";
  if (!std::isfinite(animation.start + animation.seconds) || animation.seconds < 0)
    refuse(where + ": its length is not a number of seconds; repair it");
  const std::size_t layers = animation.layer_weights.size();
  for (const Curve& weight : animation.layer_weights) check_curve(weight, where + ", weight of a layer");
  for (const Channel& channel : animation.channels) {
    require_node(character, channel.node, where);
    const std::string node =
        where + ", node '" + character.nodes[static_cast<std::size_t>(channel.node)].name + "'";
    check_keys(channel.moves, node);
    check_keys(channel.rotations, node);
    check_keys(channel.scales, node);
    check_layers(channel.move_components, layers, node);
    check_layers(channel.scale_components, layers, node);
    check_layers(channel.angles.degrees, layers, node);
    check_order_of_layers(channel.angles.degrees, node);
    std::array<int, 3> axes = channel.angles.order;
    std::sort(axes.begin(), axes.end());
    if (axes != std::array{0, 1, 2}) refuse(node + ": its order of rotation is unknown; repair it");
  }
  for (const MorphChannel& morph : animation.morphs) {
    const auto part = static_cast<std::size_t>(morph.part);
    if (morph.part < 0 || part >= character.parts.size() ||
        morph.weights.size() != character.parts[part].targets.size())
      refuse(where + ": its weights fit no mesh's morph targets; repair it");
    for (const Layered<1>& driven : morph.weights)
      check_layers(driven, layers, where + ", weights of mesh '" + character.parts[part].name + "'");
  }
}

}  // namespace

void validate(const Character& character, const CharacterLimits& limits) {
  std::size_t vertices = 0, triangles = 0, influences = 0, displacements = 0, keys = 0;
  require_count("nodes", character.nodes.size(), limits.nodes);
  require_count("meshes", character.parts.size(), limits.parts);
  require_count("clips", character.animations.size(), limits.animations);
  for (const Part& part : character.parts) {
    vertices += part.positions.size();
    triangles += part.triangles.size();
    influences += part.influences.size();
    displacements += part.targets.size() * part.positions.size();
  }
  require_count("vertices", vertices, limits.vertices);
  require_count("triangles", triangles, limits.triangles);
  require_count("weights", influences, limits.influences);
  require_count("displacements of morph targets", displacements, limits.displacements);

  for (std::size_t n = 0; n < character.nodes.size(); ++n) {
    const Node& node = character.nodes[n];
    if (node.parent < -1 || node.parent >= static_cast<int>(n) || (node.parent == -1) != (n == 0))
      refuse("node '" + node.name + "': has no parent before it; nodes must form one tree");
    if (!usable(node.local))
      refuse("node '" + node.name + "': its transform is not finite, or beyond 1e15; repair it");
    if (node.written &&
        !(usable(node.written->move) && usable(node.written->rotation) && usable(node.written->scale)))
      refuse("node '" + node.name + "': its transform is not finite, or beyond 1e15; repair it");
    if (node.follows && (node.follows->node < 0 || node.follows->node >= static_cast<int>(n)))
      refuse("node '" + node.name + "': follows the scale of no node above it; repair it");
  }
  for (const Part& part : character.parts) check_part(character, part);
  std::vector<int> joints;
  for (const Part& part : character.parts)
    for (const Joint& joint : part.joints) joints.push_back(joint.node);
  sort_unique(joints);
  require_count("bones", joints.size(), limits.joints);

  for (const Animation& animation : character.animations) {
    keys += keys_of(animation);
    require_count("animation keys", keys, limits.keys);
    check_animation(character, animation);
  }
}

std::vector<int> moving_nodes(const Character& character) {
  std::vector<int> nodes;
  for (const Part& part : character.parts) {
    std::vector<bool> used(part.joints.size(), false);
    for (const Influence& influence : part.influences) used[static_cast<std::size_t>(influence.joint)] = true;
    for (std::size_t j = 0; j < used.size(); ++j)
      if (used[j]) nodes.push_back(part.joints[j].node);
    for (std::size_t v = 0; v < part.positions.size(); ++v)
      if (part.first[v] == part.first[v + 1]) {
        nodes.push_back(part.node);
        break;
      }
  }
  sort_unique(nodes);
  return nodes;
}

}  // namespace cscd::scenes
