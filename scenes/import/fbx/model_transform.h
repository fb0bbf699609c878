#pragma once

#include <array>
#include <string>
#include <vector>

#include "scenes/character/character.h"
#include "scenes/import/fbx/objects.h"

// Places a Model object as the FBX SDK does:
//   parent * T * Roff * Rp * Rpre * R * Rpost^-1 * Rp^-1 * Soff * Sp * S * Sp^-1
// T, R and S are the model's translation, rotation and scaling. Rpre and Rpost are rotations before and
// after R, Roff and Soff are offsets, and Rp and Sp are the points that R and S leave in place.
namespace cscd::scenes::fbx {

// How a node takes over its parent's scaling S. Here r and s are the node's own rotation and scaling, and R
// is its parent's rotation.
enum class Inherit {
  RrSs,  // the parent's scaling acts along the axes of the node
  RSrs,  // the parent's scaling acts along the axes of the parent: the plain product of maps
  Rrs    // the parent's scaling does not act; scalings of nodes above the parent do
};

// The parts of a model's transform, at rest. Names refer to the formula above.
struct ModelTransform {
  Vec3 move, turn, scale;             // T in the file's units, R in degrees, S
  std::array<int, 3> order{0, 1, 2};  // of R: the axes in the order of turning
  Vec3 before;                        // Roff + Rp, which is added to T
  Quaternion pre, post;               // Rpre and Rpost^-1
  Vec3 between;                       // -Rp + Soff + Sp
  Vec3 end;                           // -Sp
  Inherit inherit = Inherit::RSrs;
};

// Reads a model's transform. Throws InputError for spheric rotation and for numbers that are not finite.
ModelTransform read_transform(const Object& model);

// Returns the map from a mesh's vertices to its node. The node's children do not take over this map.
Transform geometric_transform(const Object& model);

// Which parts of a node's transform any clip moves.
struct Animated {
  bool move = false, turn = false, scale = false;
  bool uniform_scale = true;  // in every clip the scale is the same along all axes
};

// The scaling of a node, as far as its children may have to undo it.
struct Scaling {
  int node = -1;  // node of the chain that scales; it does nothing else where `animated`
  Vec3 scale = Vec3::Ones();
  bool uniform = true, unit = true, animated = false;
};

// The character's nodes that represent one model: one or several nodes, each the parent of the next.
struct Chain {
  int last = 0;                             // the node whose frame is the model's
  int moves = -1, turns = -1, scales = -1;  // the nodes that hold T, R and S; -1 where no clip moves them
  Scaling own;
  std::vector<Scaling> above;  // ancestors' scalings that are not uniform, along the model's own axes
  bool sheared = false;        // the scaling above is along other axes, so that it cannot be undone
};

// Adds a model below its parent's chain, with as few nodes as possible. Throws InputError for inherit types
// that no chain of nodes can express there.
Chain add_model(Character& character, const std::string& name, const ModelTransform& transform,
                const Animated& animated, const Chain& parent);

}  // namespace cscd::scenes::fbx
