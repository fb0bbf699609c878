#pragma once

#include <optional>

#include "scenes/character/character.h"

namespace cscd::scenes::fbx {

// factor * curve + offset.
Curve scaled(Curve curve, double factor, double offset);

// Whether a curve has one value at all times.
bool is_level(const Curve& curve);

// The sum of two curves, with keys at the times of both. Returns nothing where one has steps while the other
// one changes: no kind of Between tells both at once.
std::optional<Curve> sum(const Curve& a, const Curve& b);

}  // namespace cscd::scenes::fbx
