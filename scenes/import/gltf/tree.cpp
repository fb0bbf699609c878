#include "scenes/import/gltf/tree.h"

#include <cmath>

#include "scenes/import/gltf/surface.h"

namespace cscd::scenes::gltf {
namespace {

std::vector<int> parents(const tinygltf::Model& model) {
  std::vector<int> parent(model.nodes.size(), -1);
  for (std::size_t n = 0; n < model.nodes.size(); ++n)
    for (const int child : model.nodes[n].children) {
      at(model.nodes, child, "node");
      if (parent[static_cast<std::size_t>(child)] >= 0)
        throw InputError("node " + std::to_string(child) +
                         " of the glTF file is the child of two nodes; repair the file");
      parent[static_cast<std::size_t>(child)] = static_cast<int>(n);
    }
  return parent;
}

// Marks the topmost nodes that are shown: those of the default scene, or else of the first
// scene, or else all nodes.
std::vector<bool> in_scene(const tinygltf::Model& model, const std::vector<int>& parent) {
  if (model.scenes.empty()) return std::vector<bool>(model.nodes.size(), true);
  std::vector<bool> shown(model.nodes.size(), false);
  const int scene = model.defaultScene < 0 ? 0 : model.defaultScene;
  for (const int node : at(model.scenes, scene, "scene").nodes) {
    at(model.nodes, node, "node");
    if (parent[static_cast<std::size_t>(node)] >= 0)
      throw InputError("the glTF file's scene names node " + std::to_string(node) +
                       ", which is the child of another node; repair the file");
    shown[static_cast<std::size_t>(node)] = true;
  }
  return shown;
}

Node node_of(const tinygltf::Node& source, int parent) {
  Node node{source.name, parent, Transform()};
  if (!source.matrix.empty()) {
    node.local = affine(source.matrix, "node matrix");
    return node;
  }
  ScaleTurnMove written;
  if (!source.translation.empty())
    written.move = {source.translation[0], source.translation[1], source.translation[2]};
  if (!source.rotation.empty())
    written.rotation = unit({source.rotation[3], source.rotation[0], source.rotation[1], source.rotation[2]},
                            "node '" + source.name + "' of the glTF file");
  if (!source.scale.empty()) written.scale = {source.scale[0], source.scale[1], source.scale[2]};
  node.local = from_trs(written.move, written.rotation, written.scale);
  node.written = written;
  return node;
}

}  // namespace

Quaternion unit(const Quaternion& q, const std::string& where) {
  const double square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  if (!std::isfinite(square) || !(square > 0))
    throw InputError(where + ": a rotation is zero or not finite; repair it");
  return normalised(q);
}

Tree make_tree(const tinygltf::Model& model, std::size_t most_nodes) {
  if (model.nodes.empty()) throw InputError("has no nodes; export it again");
  if (model.nodes.size() >= most_nodes)
    throw InputError("has more than " + std::to_string(most_nodes) + " nodes; simplify the model");
  const std::vector<int> parent = parents(model);
  const std::vector<bool> top = in_scene(model, parent);

  Tree tree;
  tree.place.assign(model.nodes.size(), -1);
  // Walks depth first without recursion: a file may nest deeper than the stack allows.
  struct Open {
    int node, parent;
    bool shown;
  };
  std::vector<Open> open;
  for (int n = static_cast<int>(model.nodes.size()); n-- > 0;)
    if (parent[static_cast<std::size_t>(n)] < 0) open.push_back({n, -1, top[static_cast<std::size_t>(n)]});
  if (open.size() != 1) {
    tree.nodes.push_back({"root", -1, Transform()});
    tree.source.push_back(-1);
    tree.shown.push_back(false);
    for (Open& next : open) next.parent = 0;
  }
  while (!open.empty()) {
    const Open next = open.back();
    open.pop_back();
    const tinygltf::Node& source = model.nodes[static_cast<std::size_t>(next.node)];
    const int place = static_cast<int>(tree.nodes.size());
    tree.place[static_cast<std::size_t>(next.node)] = place;
    tree.nodes.push_back(node_of(source, next.parent));
    tree.source.push_back(next.node);
    tree.shown.push_back(next.shown);
    for (std::size_t c = source.children.size(); c-- > 0;)
      open.push_back({source.children[c], place, next.shown});
  }
  if (tree.nodes.size() < model.nodes.size())
    throw InputError("some nodes of the glTF file hang below themselves; repair the file");
  return tree;
}

}  // namespace cscd::scenes::gltf
