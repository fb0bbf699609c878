#pragma once

#include "scenes/shape/shape.h"

namespace cscd::scenes {

// A skirt without a seam: a cone of equilateral triangles that hangs down along z and is open above and
// below. A cone that unrolls into `points` sixths of a disc is tiled by such triangles without a gap: row n,
// counted from the apex, is a ring of points * n vertices. Unrolled, a ring has a corner where two sixths
// meet, so the skirt's hem has so many points. The first point is in front, on the side of -y.
struct SkirtParameters {
  int points = 3;             // 1 to 5; the more, the wider the cone
  double aspect = 1;          // extent of the cone along y, as a share of its extent along x
  double edge = 1;            // length of an edge
  int first_row = 30;         // the row at the waist, at least 2
  int last_row = 60;          // the row at the hem
  int band_rows = 2;          // rows at the waist that the body's bones carry
  Vec3 apex = Vec3(0, 0, 0);  // of the cone
};

// Adds a skirt of points * (last_row^2 - first_row^2) triangles, which faces outward, to a body. A vertex of
// the band has the weights of the body's vertex that is nearest to it, and the other vertices have no bones.
// `where` begins error texts. Throws InputError for parameters out of these ranges.
void add_skirt(const SkirtParameters& parameters, Shape& body, const std::string& where);

// A limbed sphere (limbed_sphere.h) that wears skirts.
ShapeRow skirted_limbed_sphere_row();

}  // namespace cscd::scenes
