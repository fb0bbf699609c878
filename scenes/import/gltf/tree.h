#pragma once

#include "scenes/character/character.h"
#include "scenes/import/gltf/document.h"

namespace cscd::scenes::gltf {

// Returns the unit quaternion in the direction of q. Throws InputError if q is zero or not finite, where
// normalised() would return the identity.
Quaternion unit(const Quaternion& q, const std::string& where);

// A file's nodes as one tree, parents first. Nodes outside the scene are part of the tree too,
// because they may be joints.
struct Tree {
  std::vector<Node> nodes;
  std::vector<int> place;   // [nodes of the file]; the character's node
  std::vector<int> source;  // [nodes of the character]; the file's node, -1 for a root that was added
  std::vector<bool> shown;  // [nodes of the character]; whether the node is in the scene
};

// Makes the tree of a file's nodes, with a root of its own where several nodes have no parent. Throws
// InputError for a file without nodes or with `most_nodes` or more, for a node that has two parents or
// hangs below itself, and for a scene of nodes that have parents.
Tree make_tree(const tinygltf::Model& model, std::size_t most_nodes);

}  // namespace cscd::scenes::gltf
