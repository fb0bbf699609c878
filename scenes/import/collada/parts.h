#pragma once

#include "scenes/import/collada/document.h"

// The checks of a Collada file, part by part. All throw InputError; what they let pass, assimp reads rightly.
namespace cscd::scenes::collada {

// Transforms of nodes, and the unit of the file.
void check_nodes(const Document& document);
// Positions, and the indices of faces.
void check_geometries(const Document& document);
// Weights and bind poses, and that there are no morphs. Adds what assimp needs (see checked_collada).
void check_controllers(const Document& document);
// Channels that move nodes. Returns notes.
std::vector<std::string> check_animations(const Document& document);

}  // namespace cscd::scenes::collada
