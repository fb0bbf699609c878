#include "scenes/character/pose.h"

#include <algorithm>
#include <cmath>

namespace cscd::scenes {
namespace {

std::size_t at(int index) {
  return static_cast<std::size_t>(index);
}

Vec3 between(const Vec3& a, const Vec3& b, double s) {
  return (1 - s) * a + s * b;
}
Quaternion between(const Quaternion& a, const Quaternion& b, double s) {
  return slerp(a, b, s);
}

template <class Value>
Value sample(const std::vector<Key<Value>>& keys, double seconds) {
  const auto next = std::upper_bound(keys.begin(), keys.end(), seconds,
                                     [](double time, const Key<Value>& key) { return time < key.time; });
  if (next == keys.begin()) return keys.front().value;
  if (next == keys.end()) return keys.back().value;
  const Key<Value>& before = *(next - 1);
  return between(before.value, next->value, (seconds - before.time) / (next->time - before.time));
}

Pose world_of(const Character& character, const std::vector<Transform>& local) {
  Pose pose(character.nodes.size());
  for (std::size_t n = 0; n < pose.size(); ++n) {
    const int parent = character.nodes[n].parent;
    pose[n] = parent < 0 ? local[n] : composed(pose[at(parent)], local[n]);
  }
  return pose;
}

}  // namespace

Pose rest_pose(const Character& character) {
  std::vector<Transform> local;
  for (const Node& node : character.nodes) local.push_back(node.local);
  return world_of(character, local);
}

Pose bind_pose(const Character& character) {
  const Pose rest = rest_pose(character);
  std::vector<bool> known(rest.size(), false);
  Pose bound(rest.size());
  for (const Part& part : character.parts) {
    if (part.joints.empty()) continue;
    const auto topmost = std::min_element(part.joints.begin(), part.joints.end(),
                                          [](const Joint& a, const Joint& b) { return a.node < b.node; });
    const Transform part_to_world = composed(rest[at(topmost->node)], topmost->offset);
    for (const Joint& joint : part.joints) {
      if (known[at(joint.node)]) continue;
      const Transform map = composed(part_to_world, inverse(joint.offset));
      if (!map.finite()) continue;
      bound[at(joint.node)] = map;
      known[at(joint.node)] = true;
    }
  }
  for (std::size_t n = 0; n < bound.size(); ++n) {
    if (known[n]) continue;
    const Node& node = character.nodes[n];
    bound[n] = node.parent < 0 ? node.local : composed(bound[at(node.parent)], node.local);
  }
  return bound;
}

Pose pose_at(const Character& character, const Animation& animation, double seconds) {
  std::vector<Transform> local;
  for (const Node& node : character.nodes) local.push_back(node.local);
  for (const Channel& channel : animation.channels) {
    const Parts rest = parts_of(character.nodes[at(channel.node)].local);
    const Vec3 scale(rest.rest[0].x(), rest.rest[1].y(), rest.rest[2].z());
    local[at(channel.node)] =
        from_parts(channel.moves.empty() ? rest.move : sample(channel.moves, seconds),
                   channel.rotations.empty() ? rest.rotation : sample(channel.rotations, seconds),
                   channel.scales.empty() ? scale : sample(channel.scales, seconds));
  }
  return world_of(character, local);
}

Pose blend(const Character& character, const Pose& a, const Pose& b, double s) {
  if (s <= 0) return a;
  if (s >= 1) return b;
  std::vector<Transform> local(a.size());
  for (std::size_t n = 0; n < a.size(); ++n) {
    const int parent = character.nodes[n].parent;
    if (parent < 0) {
      local[n] = blend(a[n], b[n], s);
      continue;
    }
    const Transform from = composed(inverse(a[at(parent)]), a[n]),
                    to = composed(inverse(b[at(parent)]), b[n]);
    // Below a node of no extent nothing has a place of its own.
    local[n] = from.finite() && to.finite() ? blend(from, to, s) : Transform();
  }
  return world_of(character, local);
}

void skin(const Character& character, const Pose& pose, std::vector<Vec3>& out) {
  out.clear();
  std::vector<Transform> moved;  // by joint of the part
  for (const Part& part : character.parts) {
    moved.clear();
    for (const Joint& joint : part.joints) moved.push_back(composed(pose[at(joint.node)], joint.offset));
    for (std::size_t v = 0; v < part.positions.size(); ++v) {
      const Vec3& x = part.positions[v];
      if (part.first[v] == part.first[v + 1]) {
        out.push_back(pose[at(part.node)](x));
        continue;
      }
      Vec3 sum = Vec3::Zero();
      for (std::size_t i = part.first[v]; i < part.first[v + 1]; ++i) {
        const Influence& influence = part.influences[i];
        const Vec3 where = moved[at(influence.joint)](x);
        sum += influence.weight * where;
      }
      out.push_back(sum);
    }
  }
}

}  // namespace cscd::scenes
