#pragma once

#include <cstddef>

#include "scenes/character/character.h"
#include "scenes/import/fbx/objects.h"

// One AnimationCurve: a number over time.
namespace cscd::scenes::fbx {

struct ReadCurve {
  Curve keys;
  std::size_t dropped = 0;                             // keys out of order or not finite
  bool goes_on_before = false, goes_on_after = false;  // beyond its keys it repeats or rises
};

// Throws InputError where the arrays of the curve do not fit together. `most` bounds the number of keys.
ReadCurve read_curve(const Object& curve, double ticks_per_second, std::size_t most);

}  // namespace cscd::scenes::fbx
