#pragma once

#include "scenes/shape/shape.h"

namespace cscd::scenes {

// Returns quadratic B-spline weights over a chain of bones. `place` is measured in bones from the head of
// the first bone. At most three bones have weight, and the skinned axis has a continuous tangent. The
// weight of bones beyond the ends goes to the end bones.
JointWeights spline_weights(double place, int bones);

// Adds a chain of bones through the joints [bones + 1] to a shape without bones. The bones are named
// "bone_0" and so on.
void append_chain(std::span<const Vec3> joints, Shape& shape);

}  // namespace cscd::scenes
