#pragma once

#include "scenes/shape/shape.h"

namespace cscd::scenes {

// A straight tube with hemispherical ends, its skeleton a chain of bones of one length on its axis.
struct TubeParameters {
  int rings = 865;  // rings of vertices between the two poles, at least 2
  int sides = 28;   // vertices of a ring, at least 3
  int bones = 100;
  double radius = 1;
  double length = 190;             // from pole to pole, more than two radii
  Vec3 start = Vec3::Zero();       // the first pole
  Vec3 direction = Vec3::UnitZ();  // from the first pole to the last; need not be a unit vector
};

// rings * sides + 2 vertices (ring by ring, then the first pole, then the last) and 2 rings * sides
// triangles, genus 0. Rings stand at equal arc lengths of the profile. Bones reach from the centre of one cap
// to that of the other; a vertex follows at most three of them, by quadratic B-splines over the bones'
// middles, so that the skinned axis has a continuous tangent.
Shape tube(const TubeParameters& parameters);

ShapeRow tube_row();

}  // namespace cscd::scenes
