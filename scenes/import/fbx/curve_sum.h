#pragma once

#include <optional>

#include "scenes/character/character.h"

namespace cscd::scenes::fbx {

// Returns factor * curve + offset.
Curve scaled(Curve curve, double factor, double offset);

// Tells whether a curve has one value at all times.
bool is_level(const Curve& curve);

// Returns the sum of two curves, with keys at the times of both. Returns nullopt where one curve has steps
// while the other changes, because no kind of Between expresses both at once.
std::optional<Curve> sum(const Curve& a, const Curve& b);

}  // namespace cscd::scenes::fbx
