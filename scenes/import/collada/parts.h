#pragma once

#include "scenes/import/collada/document.h"

// The checks of a Collada file, part by part. All throw InputError; what they let pass, assimp reads rightly.
namespace cscd::scenes::collada {

// How many numbers a transform of a node has, by the name of its element. 0 for other elements.
std::size_t numbers_of_transform(std::string_view name);

// Transforms of nodes, and the unit of the file.
void check_nodes(const Document& document);
// Positions, and the indices of faces. Returns how many positions are of no face and of no line.
std::size_t check_geometries(const Document& document);
// Weights and bind poses, and that there are no morphs. Adds what assimp needs (see checked_collada).
// Returns notes.
std::vector<std::string> check_controllers(const Document& document);
// Channels, and that what they move exists. Returns notes.
std::vector<std::string> check_animations(const Document& document);

}  // namespace cscd::scenes::collada
