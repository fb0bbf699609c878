#include "scenes/character/pose.h"

#include <algorithm>
#include <map>
#include <optional>

#include "scenes/character/dual_skin.h"
#include "scenes/character/sample.h"

namespace cscd::scenes {
namespace {

std::size_t at(int index) {
  return static_cast<std::size_t>(index);
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

ScaleTurnMove parts_at_rest(const Node& node) {
  if (node.written) return *node.written;
  const Trs rest = trs_of(node.local);
  return {rest.move, rest.rotation, Vec3(rest.rest[0].x(), rest.rest[1].y(), rest.rest[2].z())};
}

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
  const std::vector<double> shares = layer_shares(animation, seconds);
  std::map<int, Vec3> scales;  // scales of the nodes that the clip drives
  for (const Channel& channel : animation.channels) {
    const ScaleTurnMove rest = parts_at_rest(character.nodes[at(channel.node)]);
    Vec3 move = rest.move, scale = rest.scale;
    Quaternion rotation = rest.rotation;
    if (!channel.moves.empty()) move = sample(channel.moves, seconds);
    if (!channel.move_components.empty()) move = sample(channel.move_components, shares, seconds);
    if (!channel.rotations.empty()) rotation = sample(channel.rotations, seconds);
    if (!channel.angles.degrees.empty()) rotation = sample(channel.angles, shares, seconds);
    if (!channel.scales.empty()) scale = sample(channel.scales, seconds);
    if (!channel.scale_components.empty()) scale = sample(channel.scale_components, shares, seconds);
    local[at(channel.node)] = from_trs(move, rotation, scale);
    scales[channel.node] = scale;
  }
  for (std::size_t n = 0; n < local.size(); ++n) {
    const std::optional<FollowedScale>& follows = character.nodes[n].follows;
    if (!follows) continue;
    const auto driven = scales.find(follows->node);
    if (driven == scales.end()) continue;
    Vec3 scale = driven->second;
    // Below a node that is scaled to nothing, no scale can restore the size; zero keeps the map finite.
    for (int k = 0; k < 3 && follows->inverse; ++k) scale[k] = scale[k] == 0 ? 0 : 1 / scale[k];
    local[n] = from_trs(Vec3::Zero(), {}, scale);
  }
  return world_of(character, local);
}

MorphWeights rest_weights(const Character& character) {
  MorphWeights weights;
  for (const Part& part : character.parts) {
    std::vector<double>& own = weights.emplace_back();
    for (const MorphTarget& target : part.targets) own.push_back(target.weight);
  }
  return weights;
}

MorphWeights weights_at(const Character& character, const Animation& animation, double seconds) {
  MorphWeights weights = rest_weights(character);
  const std::vector<double> shares = layer_shares(animation, seconds);
  for (const MorphChannel& morph : animation.morphs)
    for (std::size_t t = 0; t < morph.weights.size(); ++t)
      if (!morph.weights[t].empty())
        weights[at(morph.part)][t] =
            weight_of(character.parts[at(morph.part)].targets[t], sample(morph.weights[t], shares, seconds));
  return weights;
}

MorphWeights blend(const MorphWeights& a, const MorphWeights& b, double s) {
  MorphWeights weights = a;
  for (std::size_t p = 0; p < a.size(); ++p)
    for (std::size_t t = 0; t < a[p].size(); ++t) weights[p][t] = (1 - s) * a[p][t] + s * b[p][t];
  return weights;
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
    // Below a node that is scaled to nothing, a node has no place of its own; any finite map will do.
    local[n] = from.finite() && to.finite() ? blend(from, to, s) : Transform();
  }
  return world_of(character, local);
}

void skin(const Character& character, const Pose& pose, const MorphWeights& weights, std::vector<Vec3>& out) {
  out.clear();
  std::vector<Transform> moved;  // [joints of the part]
  for (std::size_t p = 0; p < character.parts.size(); ++p) {
    const Part& part = character.parts[p];
    moved.clear();
    for (const Joint& joint : part.joints) moved.push_back(composed(pose[at(joint.node)], joint.offset));
    std::optional<DualSkin> dual;
    if (!part.dual_quaternion.empty()) dual.emplace(character, part, moved);
    for (std::size_t v = 0; v < part.positions.size(); ++v) {
      Vec3 x = part.positions[v];
      for (std::size_t t = 0; t < part.targets.size(); ++t)
        if (weights[p][t] != 0) x += weights[p][t] * part.targets[t].displacements[v];
      if (part.first[v] == part.first[v + 1]) {
        out.push_back(pose[at(part.node)](x));
        continue;
      }
      const double dual_share = dual ? part.dual_quaternion[v] : 0;
      if (dual_share == 1) {
        out.push_back(dual->moved(v, x));
        continue;
      }
      Vec3 sum = Vec3::Zero();
      for (std::size_t i = part.first[v]; i < part.first[v + 1]; ++i) {
        const Influence& influence = part.influences[i];
        const Vec3 where = moved[at(influence.joint)](x);
        sum += influence.weight * where;
      }
      if (dual_share > 0) sum = (1 - dual_share) * sum + dual_share * dual->moved(v, x);
      out.push_back(sum);
    }
  }
}

void skin(const Character& character, const Pose& pose, std::vector<Vec3>& out) {
  skin(character, pose, rest_weights(character), out);
}

}  // namespace cscd::scenes
