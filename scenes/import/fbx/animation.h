#pragma once

#include <map>
#include <string>
#include <vector>

#include "scenes/character/character.h"
#include "scenes/import/fbx/objects.h"

// AnimationStacks: layers of curves on properties of objects.
namespace cscd::scenes::fbx {

// What one clip does to one Model. A part without keys stays as it is.
struct Motion {
  Components moves, turns, scales;
};

struct Clip {
  std::string name;
  double start = 0, seconds = 0;
  std::map<const Object*, Motion> models;
  // Percentages of blend shapes, by the object and its property.
  std::map<std::pair<const Object*, std::string>, Curve> shapes;
};

// Counts of what was left out, for notes.
struct LeftOut {
  std::size_t keys = 0, layers = 0;
};

std::vector<Clip> read_clips(const Objects& objects, const CharacterLimits& limits, LeftOut& left_out);

}  // namespace cscd::scenes::fbx
