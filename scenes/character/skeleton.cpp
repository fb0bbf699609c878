#include "scenes/character/skeleton.h"

#include <algorithm>

namespace cscd::scenes {
namespace {

// The vertices that a node moves, summed up: their weights and their weighted positions.
struct Load {
  double weight = 0;
  Vec3 sum = Vec3::Zero();
};

std::vector<Load> loads(const Character& character, std::span<const Vec3> positions,
                        const std::vector<bool>& used) {
  std::vector<Load> load(character.nodes.size());
  std::size_t vertex = 0;
  for (const Part& part : character.parts)
    for (std::size_t v = 0; v < part.positions.size(); ++v, ++vertex) {
      if (!used[vertex]) continue;
      const auto add = [&](int node, double weight) {
        Load& l = load[static_cast<std::size_t>(node)];
        l.weight += weight;
        l.sum += weight * positions[vertex];
      };
      if (part.first[v] == part.first[v + 1]) add(part.node, 1);
      for (std::size_t i = part.first[v]; i < part.first[v + 1]; ++i)
        add(part.joints[static_cast<std::size_t>(part.influences[i].joint)].node, part.influences[i].weight);
    }
  return load;
}

}  // namespace

Skeleton make_skeleton(const Character& character, const Pose& bound, std::span<const Vec3> positions,
                       const std::vector<bool>& used) {
  const std::vector<Load> load = loads(character, positions, used);
  Skeleton skeleton;
  std::vector<int> bone_of(character.nodes.size(), -1);  // each node's own bone, or the next bone above it
  for (std::size_t n = 0; n < bone_of.size(); ++n) {
    const int above = character.nodes[n].parent;
    bone_of[n] = above < 0 ? -1 : bone_of[static_cast<std::size_t>(above)];
    if (!(load[n].weight > 0)) continue;
    skeleton.parent.push_back(BoneId{bone_of[n]});
    bone_of[n] = static_cast<int>(skeleton.node.size());
    skeleton.node.push_back(static_cast<int>(n));
  }

  std::vector<Load> children(skeleton.node.size());
  for (std::size_t b = 0; b < skeleton.node.size(); ++b) {
    if (skeleton.parent[b] == BoneId{-1}) continue;
    children[+skeleton.parent[b]].weight += 1;
    children[+skeleton.parent[b]].sum += bound[static_cast<std::size_t>(skeleton.node[b])].origin;
  }
  for (std::size_t b = 0; b < skeleton.node.size(); ++b) {
    const auto node = static_cast<std::size_t>(skeleton.node[b]);
    const Vec3 head = bound[node].origin;
    Vec3 tail = children[b].sum / children[b].weight;
    if (!(children[b].weight > 0) || tail == head) tail = load[node].sum / load[node].weight;
    const Vec3 inside = inverse(bound[node])(tail);
    skeleton.tail_in_node.push_back(inside.allFinite() ? inside : Vec3::Zero());
  }
  return skeleton;
}

void bones_at(const Skeleton& skeleton, const Pose& pose, std::vector<Bone>& out) {
  out.clear();
  for (std::size_t b = 0; b < skeleton.node.size(); ++b) {
    const Transform& map = pose[static_cast<std::size_t>(skeleton.node[b])];
    out.push_back({map.origin, map(skeleton.tail_in_node[b])});
  }
}

}  // namespace cscd::scenes
