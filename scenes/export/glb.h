#pragma once

#include <string>

#include "scenes/character/character.h"

namespace cscd::scenes {

// Returns the bytes of a binary glTF 2.0 file of a character. The file has a node for each node, with a
// mesh of one primitive for each part, as many sets of four joints and weights as the part's vertices need,
// a skin for each part with joints, and an animation with linear keys for each clip. Numbers are rounded to
// single precision.
//
// Throws InputError for characters that validate() refuses and for what this writer cannot express: numbers
// beyond single precision, keys whose times become equal by rounding, keys that are not joined by straight
// lines, morph targets, vertices without a joint in a part with joints, sheared nodes, parts without
// triangles, clips that move nothing, and files of 4 GiB or more.
std::string to_glb(const Character& character);

}  // namespace cscd::scenes
