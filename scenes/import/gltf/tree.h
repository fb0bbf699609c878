#pragma once

#include "scenes/character/character.h"
#include "scenes/import/gltf/document.h"

namespace cscd::scenes::gltf {

// The unit quaternion of the same direction. Throws InputError where there is none, which normalised() would
// take for no rotation.
Quaternion unit(const Quaternion& q, const std::string& where);

// A file's nodes as one tree, parents first. Nodes outside the scene stand in it too, because they may be
// joints.
struct Tree {
  std::vector<Node> nodes;
  std::vector<int> place;   // the character's node for each of the file's
  std::vector<int> source;  // the file's node for each of the character's; -1 for a root that was added
  std::vector<bool> shown;  // by the character's node: whether it is in the scene
};

// Throws InputError where a node has two parents or hangs below itself, and for a scene of nodes that have
// parents.
Tree make_tree(const tinygltf::Model& model, std::size_t most_nodes);

}  // namespace cscd::scenes::gltf
