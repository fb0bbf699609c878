#pragma once

#include "scenes/shape/shape.h"

namespace cscd::scenes {

// A tube with hemispherical ends and a chain of bones on its axis. The axis is straight, or straight with a
// circular arc in its middle: a hairpin.
struct TubeParameters {
  int rings = 865;  // rings of vertices between the two poles, at least 2
  int sides = 28;   // vertices of a ring, at least 3
  int bones = 100;
  double radius = 1;
  double length = 190;             // from pole to pole, more than two radii
  Vec3 start = Vec3::Zero();       // the first pole
  Vec3 direction = Vec3::UnitZ();  // in which the axis leaves it; need not be a unit vector
  double arc_turns = 0;            // how far the axis turns in its middle: 0 for straight, 0.5 for a hairpin
  double arc_radius = 0;           // of that arc; above the tube's radius where there is one
  Vec3 arc_side =
      Vec3::UnitX();  // to which the axis turns; need not be a unit vector, nor across the direction
};

// rings * sides + 2 vertices (ring by ring, then the first pole, then the last) and 2 rings * sides
// triangles, genus 0. Rings stand at equal arc lengths of the profile. Joints at equal arc lengths of the
// axis reach from the centre of one cap to that of the other; a vertex follows at most three of them, by
// quadratic B-splines over the bones' middles, so that the skinned axis has a continuous tangent.
Shape tube(const TubeParameters& parameters);

ShapeRow tube_row();

}  // namespace cscd::scenes
