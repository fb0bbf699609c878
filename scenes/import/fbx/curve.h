#pragma once

#include <cstddef>

#include "scenes/character/character.h"
#include "scenes/import/fbx/objects.h"

// Reads one AnimationCurve: a number over time.
namespace cscd::scenes::fbx {

// The keys of a curve in seconds, and what was noticed about them.
struct ReadCurve {
  Curve keys;
  std::size_t dropped = 0;                             // keys out of order or not finite
  bool goes_on_before = false, goes_on_after = false;  // it repeats or rises beyond its keys
};

// Reads a curve of at most `most` keys. Throws InputError where the arrays of the curve do not fit together.
ReadCurve read_curve(const Object& curve, double ticks_per_second, std::size_t most);

}  // namespace cscd::scenes::fbx
