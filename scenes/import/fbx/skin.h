#pragma once

#include <map>
#include <span>

#include "scenes/character/character.h"
#include "scenes/import/fbx/objects.h"

namespace cscd::scenes::fbx {

// Counts of what was left out of skins, for notes.
struct SkinLeftOut {
  std::size_t weights = 0;  // weights not positive, not finite, or of a cluster without a bone
};

// The facts about the character that a part's skin depends on.
struct SkinPlace {
  const std::map<const Object*, int>& node_of;  // the last node of each model's chain
  const Transform& geometry;                    // from the mesh's vertices to its node
  const Transform& mesh_at_rest;                // from the mesh's node to the world
};

// Returns the Skin that moves a Geometry, or null. Throws InputError if there are several.
const Object* skin_of(const Objects& objects, const Object& geometry);

// Fills a part's joints and influences. The part's vertices are those of the geometry, and `part.node` is the
// node that they follow without a skin. If `skin` is null, no joint moves the vertices. Throws InputError for
// damage, for counts above the limits, and for additive clusters.
//
// The FBX SDK moves a vertex v, whose mesh has the map `geometry` to its node, to
//   sum over clusters of weight * link * TransformLink^-1 * Transform * geometry * v,
// where `link` is the current map of the cluster's bone. A file's Transform already holds the product
// TransformLink^-1 * Transform. Skins of the kinds "DualQuaternion" and "Blend" blend the same maps otherwise
// (Part::dual_quaternion).
void read_skin(const Objects& objects, const Object* skin, const SkinPlace& place,
               const CharacterLimits& limits, Part& part, SkinLeftOut& left_out);

}  // namespace cscd::scenes::fbx
