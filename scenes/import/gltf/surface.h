#pragma once

#include "scenes/character/character.h"
#include "scenes/import/gltf/accessor.h"

namespace cscd::scenes::gltf {

// Converts a 4 x 4 matrix in glTF's order, column by column. Throws InputError where the
// matrix is no affine map.
Transform affine(std::span<const double> matrix, const std::string& what);

class Attributes;

// Makes parts from a file's primitives, and counts what it leaves out.
class Surfaces {
 public:
  Surfaces(const Document& document, Accessors& accessors, const CharacterLimits& limits)
      : document_(document), accessors_(accessors), limits_(limits) {}

  // Returns the parts of one node: one for each primitive of its mesh that has triangles. `own_place` is
  // the node's index in the character, and `place` [nodes of the file] the character's index for each of
  // the file's nodes. Joints and weights are read if the node has a skin. Throws InputError for damaged
  // data and for counts above the limits.
  std::vector<Part> read(const tinygltf::Node& node, int own_place, const std::vector<int>& place);

  // Returns messages about what was left out of all parts read so far.
  std::vector<std::string> notes() const;

 private:
  Part read_primitive(const tinygltf::Node& node, int primitive, const std::vector<int>& place);
  void read_skin(const tinygltf::Skin& skin, const std::vector<int>& place, Part& part);
  void read_influences(Attributes& attributes, Part& part, const std::string& where);
  void read_targets(const tinygltf::Mesh& mesh, const tinygltf::Node& node,
                    const tinygltf::Primitive& primitive, Part& part, const std::string& where);

  const Document& document_;
  Accessors& accessors_;
  const CharacterLimits& limits_;
  // Counts over all parts read so far.
  std::size_t parts_ = 0, vertices_ = 0, triangles_ = 0, influences_ = 0, joints_ = 0, displacements_ = 0;
  std::size_t no_triangles_ = 0, no_positions_ = 0, odd_corners_ = 0, negative_ = 0, weightless_ = 0;
};

}  // namespace cscd::scenes::gltf
