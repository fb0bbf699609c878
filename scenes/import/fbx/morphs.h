#pragma once

#include "scenes/character/character.h"
#include "scenes/import/fbx/objects.h"

namespace cscd::scenes::fbx {

// A property that drives one morph target of a part. The property holds a percentage.
struct ShapeChannel {
  const Object* owner;
  std::string property;
};

// Adds the blend shapes of a geometry to a part as morph targets, and returns their channels in the same
// order. Throws InputError for damage, for counts above the limits, and for channels with shapes in between.
std::vector<ShapeChannel> read_shapes(const Objects& objects, const Object& geometry,
                                      const CharacterLimits& limits, Part& part);

}  // namespace cscd::scenes::fbx
