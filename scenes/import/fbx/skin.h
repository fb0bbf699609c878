#pragma once

#include <map>
#include <span>

#include "scenes/character/character.h"
#include "scenes/import/fbx/objects.h"

namespace cscd::scenes::fbx {

// Counts of what was left out of skins, for notes.
struct SkinLeftOut {
  std::size_t weights = 0;  // not positive, not finite, or of a cluster without a bone
};

// What a part's skin needs to know of the character.
struct SkinPlace {
  const std::map<const Object*, int>& node_of;  // the last node of each model's chain
  const Transform& geometry;                    // from the mesh's vertices to its node
  const Transform& mesh_at_rest;                // from the mesh's node to the world
};

// The Skin that moves a Geometry, or null. Throws InputError for more than one.
const Object* skin_of(const Objects& objects, const Object& geometry);

// Fills a part's joints and influences. The vertices of the part are those of the geometry, and `part.node`
// is where they stand without a skin. Without a skin nothing moves them.
//
// The FBX SDK's recipe for a vertex v of a mesh with the map `geometry` to its node:
//   sum over clusters of weight * link now * TransformLink^-1 * Transform * geometry * v
// A file's Transform holds TransformLink^-1 * Transform already.
void read_skin(const Objects& objects, const Object* skin, const SkinPlace& place,
               const CharacterLimits& limits, Part& part, SkinLeftOut& left_out);

}  // namespace cscd::scenes::fbx
