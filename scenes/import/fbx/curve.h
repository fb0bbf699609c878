#pragma once

#include <cstddef>

#include "scenes/character/character.h"
#include "scenes/import/fbx/objects.h"

// Reads one AnimationCurve: a number over time.
namespace cscd::scenes::fbx {

// A curve, and what was noticed about it.
struct ReadCurve {
  Curve curve;
  std::size_t dropped = 0;    // keys that repeat the key before
  bool unknown_ends = false;  // goes on beyond its keys in a way that is not known; its values hold instead
};

// Reads a curve of at most `most` keys. Throws InputError where the arrays of the curve do not fit together.
ReadCurve read_curve(const Object& curve, double ticks_per_second, std::size_t most);

// Returns factor * curve + offset.
Curve scaled(Curve curve, double factor, double offset);

// Tells whether a curve has one value at all times.
bool is_level(const Curve& curve);

}  // namespace cscd::scenes::fbx
