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
// order. Throws InputError for damage and for counts above the limits.
//
// Each shape of a channel has a full weight, the percentage at which the channel shows this shape alone.
// Between two full weights, and between a full weight and 0, at which there is no shape, the channel blends
// in a straight line; the first and the last of these lines go on. Throws InputError where two full weights
// are equal or one is 0, because the shape to show there is not determined.
std::vector<ShapeChannel> read_shapes(const Objects& objects, const Object& geometry,
                                      const CharacterLimits& limits, Part& part);

}  // namespace cscd::scenes::fbx
