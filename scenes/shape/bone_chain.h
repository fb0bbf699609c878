#pragma once

#include "scenes/shape/shape.h"

namespace cscd::scenes {

// Quadratic B-spline weights over a chain of bones at `place`, measured in bones from the head of the first:
// the skinned axis has a continuous tangent. At most three bones. What the spline gives to bones beyond the
// ends goes to the end bones.
JointWeights spline_weights(double place, int bones);

// Adds a chain of bones through the joints, "bone_0" onwards, to a shape that has none.
void append_chain(std::span<const Vec3> joints, Shape& shape);

}  // namespace cscd::scenes
