#include "scenes/character/character.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace cscd::scenes {
namespace {

// Larger coordinates leave too little of a double for a surface, and make squares overflow.
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
bool usable(const Quaternion& q) {
  return std::isfinite(q.w) && std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z);
}

void require_node(const Character& character, int node, const std::string& where) {
  if (node < 0 || static_cast<std::size_t>(node) >= character.nodes.size())
    refuse(where + ": names node " + std::to_string(node) + " of " + std::to_string(character.nodes.size()) +
           "; repair the file");
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
    if (!std::isfinite(keys[i].time) || !usable(keys[i].value))
      refuse(where + ", key " + std::to_string(i) + ": is not finite; repair the animation");
    if (i > 0 && !(keys[i].time > keys[i - 1].time))
      refuse(where + ", key " + std::to_string(i) + ": does not come later than the one before; repair it");
  }
}

}  // namespace

void validate(const Character& character, const CharacterLimits& limits) {
  std::size_t vertices = 0, triangles = 0, influences = 0, keys = 0;
  require_count("nodes", character.nodes.size(), limits.nodes);
  require_count("meshes", character.parts.size(), limits.parts);
  require_count("clips", character.animations.size(), limits.animations);
  for (const Part& part : character.parts) {
    vertices += part.positions.size();
    triangles += part.triangles.size();
    influences += part.influences.size();
  }
  require_count("vertices", vertices, limits.vertices);
  require_count("triangles", triangles, limits.triangles);
  require_count("weights", influences, limits.influences);

  for (std::size_t n = 0; n < character.nodes.size(); ++n) {
    const Node& node = character.nodes[n];
    if (node.parent < -1 || node.parent >= static_cast<int>(n) || (node.parent == -1) != (n == 0))
      refuse("node '" + node.name + "': has no parent before it; nodes must form one tree");
    if (!usable(node.local))
      refuse("node '" + node.name + "': its transform is not finite, or beyond 1e15; repair it");
  }
  for (const Part& part : character.parts) check_part(character, part);
  std::vector<int> joints;
  for (const Part& part : character.parts)
    for (const Joint& joint : part.joints) joints.push_back(joint.node);
  std::sort(joints.begin(), joints.end());
  joints.erase(std::unique(joints.begin(), joints.end()), joints.end());
  require_count("bones", joints.size(), limits.joints);

  for (const Animation& animation : character.animations) {
    const std::string where = "clip '" + animation.name + "'";
    if (!std::isfinite(animation.start + animation.seconds) || animation.seconds < 0)
      refuse(where + ": its length is not a number of seconds; repair it");
    for (const Channel& channel : animation.channels) {
      require_node(character, channel.node, where);
      keys += channel.moves.size() + channel.rotations.size() + channel.scales.size();
      require_count("animation keys", keys, limits.keys);
      const std::string node =
          where + ", node '" + character.nodes[static_cast<std::size_t>(channel.node)].name + "'";
      check_keys(channel.moves, node);
      check_keys(channel.rotations, node);
      check_keys(channel.scales, node);
    }
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
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

}  // namespace cscd::scenes
