#pragma once

#include <map>
#include <string>
#include <vector>

#include "scenes/character/character.h"
#include "scenes/import/fbx/objects.h"

// Reads the clips of an FBX file (its AnimationStacks): layers of curves on properties of objects.
namespace cscd::scenes::fbx {

// The curves by which one clip moves one Model. A part without keys keeps its value at rest.
struct Motion {
  Layered<3> moves, turns, scales;
};

// One AnimationStack, with its layers combined.
struct Clip {
  std::string name;
  // Seconds: the clip's first moment, and its length.
  double start = 0, seconds = 0;
  std::map<const Object*, Motion> models;
  // Percentages of blend shapes, by the object that holds a percentage and its property.
  std::map<std::pair<const Object*, std::string>, Layered<1>> shapes;
  std::vector<Curve> layer_weights;  // as in Animation
};

// Counts of what was left out, for notes.
struct LeftOut {
  std::size_t keys = 0, layers = 0, ends = 0;
};

// Reads all clips of a file, and adds to `left_out` what it leaves out. Throws InputError for
// damage, for more clips or keys than the limits allow, and for animations that this reader cannot
// show as the FBX SDK does.
std::vector<Clip> read_clips(const Objects& objects, const CharacterLimits& limits, LeftOut& left_out);

}  // namespace cscd::scenes::fbx
