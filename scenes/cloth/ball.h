#pragma once

#include "scenes/shape/shape.h"

namespace cscd::scenes {

// A geodesic ball without bones: every face of an icosahedron is divided into parts^2 triangles.
struct BallParameters {
  int parts = 50;  // of an edge of the icosahedron, at least 1
  double radius = 1;
  Vec3 centre = Vec3::Zero();
};

// Builds the ball. It has 20 parts^2 triangles, whose edges differ in length by less than a third. Throws
// InputError for parameters out of these ranges.
Shape ball(const BallParameters& parameters);

ShapeRow ball_row();

}  // namespace cscd::scenes
