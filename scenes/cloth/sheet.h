#pragma once

#include "scenes/shape/shape.h"

namespace cscd::scenes {

// A flat rectangular sheet without bones, made of rows of equilateral triangles. Its long sides are straight:
// every second row begins and ends with half a triangle.
struct SheetParameters {
  int cells = 147;             // edges along a side of u; at least 1
  int strips = 170;            // strips of triangles along v; even, at least 2
  double edge = 0.01;          // length of an edge
  Vec3 centre = Vec3::Zero();  // of the sheet
  Vec3 u = Vec3::UnitX();      // direction of the rows; need not be a unit vector
  Vec3 v = Vec3::UnitY();      // side to which the rows follow each other; need not be perpendicular to u
};

// Builds the sheet. It has strips * (2 * cells + 1) triangles, and it faces the side of u x v. Throws
// InputError for parameters out of these ranges.
Shape sheet(const SheetParameters& parameters);

ShapeRow sheet_row();

}  // namespace cscd::scenes
