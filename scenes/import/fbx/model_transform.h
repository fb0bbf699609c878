#pragma once

#include <array>
#include <string>
#include <vector>

#include "scenes/character/character.h"
#include "scenes/import/fbx/objects.h"

// Where a Model object stands, as the FBX SDK says:
//   parent * T * Roff * Rp * Rpre * R * Rpost^-1 * Rp^-1 * Soff * Sp * S * Sp^-1
// with T, R and S its translation, rotation and scaling, Rpre and Rpost rotations before and after R, Roff
// and Soff offsets, and Rp and Sp the points that R and S leave in place.
namespace cscd::scenes::fbx {

// How a node takes over its parent's scaling S, where r and s are its own rotation and scaling and R is its
// parent's rotation.
enum class Inherit {
  RrSs,  // the parent's scaling acts along the axes of the node
  RSrs,  // the parent's scaling acts along the axes of the parent: the usual product of maps
  Rrs    // the scaling of the parent alone, not that of nodes above it, does not act
};

struct ModelTransform {
  Vec3 move, turn, scale;             // T in the file's units, R in degrees, S
  std::array<int, 3> order{0, 1, 2};  // of R: the axes in the order in which they are turned about
  Vec3 before;                        // Roff + Rp: what is added to T
  Quaternion pre, post;               // Rpre and Rpost^-1
  Vec3 between;                       // -Rp + Soff + Sp
  Vec3 end;                           // -Sp
  Inherit inherit = Inherit::RSrs;
};

// Throws InputError for spheric rotation.
ModelTransform read_transform(const Object& model);

// The map from a mesh's vertices to its node, which the node's children do not take over.
Transform geometric_transform(const Object& model);

// Which parts of a node some clip moves.
struct Animated {
  bool move = false, turn = false, scale = false;
  bool uniform_scale = true;  // in every clip the scale is the same along all axes
};

// What of a node's scaling its children may have to undo.
struct Scaling {
  int node = -1;  // of the chain, which scales and does nothing else where `animated`
  Vec3 scale = Vec3::Ones();
  bool uniform = true, unit = true, animated = false;
};

// The nodes that one model became.
struct Chain {
  int last = 0;                             // whose frame is the model's
  int moves = -1, turns = -1, scales = -1;  // the nodes that hold T, R and S; -1 where nothing moves them
  Scaling own;
  std::vector<Scaling> above;  // scalings of ancestors that are not uniform, along the model's own axes
  bool sheared = false;        // the scaling above is not along these axes, so that it cannot be undone
};

// Adds a model below its parent's chain, as few nodes as needed. Throws InputError for inherit types that no
// chain of nodes can express there.
Chain add_model(Character& character, const std::string& name, const ModelTransform& transform,
                const Animated& animated, const Chain& parent);

}  // namespace cscd::scenes::fbx
