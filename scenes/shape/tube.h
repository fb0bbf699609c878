#pragma once

#include <vector>

#include "scenes/shape/shape.h"
#include "scenes/shape/surface_details.h"

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
  Vec3 direction = Vec3::UnitZ();  // of the axis at the first pole; need not be a unit vector
  double arc_turns = 0;            // turns of the axis in its middle: 0 for straight, 0.5 for a hairpin
  double arc_radius = 0;           // radius of that arc; larger than the tube's radius if there is an arc
  Vec3 arc_side =
      Vec3::UnitX();  // the side to which the axis turns; need not be a unit vector or perpendicular
  std::vector<SurfaceDetail> details;  // raised and dented places of the finished surface
};

// Builds the tube. It has rings * sides + 2 vertices (ring by ring, then the first pole, then the last
// pole), 2 * rings * sides triangles, and genus 0. The rings stand at equal arc lengths of the profile. The
// joints stand at equal arc lengths of the axis, from the centre of one cap to the centre of the other. A
// vertex follows at most three bones, by quadratic B-splines over the middles of the bones, so that the
// skinned axis has a continuous tangent. Throws InputError for parameters out of these ranges.
Shape tube(const TubeParameters& parameters);

ShapeRow tube_row();

}  // namespace cscd::scenes
