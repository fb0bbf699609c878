#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/base/vec3.h"
#include "scenes/shape/shape.h"

namespace cscd::scenes {

// A place on the surface at rest that is raised or dented along the surface's normals, such as a nose, the
// folds of a sleeve, or the flap of a pocket. The displacement of a vertex with normal n is
//   height profile(d) (n + lean), times the cosine of 2 pi x / wave_length if there are folds,
// where d is the distance from `at` in shares of `reach`, and x is the distance from `at` along `across`. The
// profile is (1 - d^2)^2, or with a rim it is 1 up to d = 1 - rim and falls smoothly from there. It ends at
// d = 1. A raised place that leans far enough overhangs: the lean shears the place, so a flat surface stays
// free of crossings however far it leans.
struct SurfaceDetail {
  Vec3 at;
  Vec3 reach;              // half axes of the ellipsoid in which the detail lies, along x, y and z; positive
  double height = 0;       // negative for a dent
  double wave_length = 0;  // distance from one fold to the next; 0 for none
  Vec3 across;             // the direction from fold to fold, of length 1; used only if there are folds
  Vec3 lean = Vec3::Zero();  // in shares of `height`
  double rim = 0;            // 0 for the rounded profile
};

// Displaces the positions by the sum of all details. Normals are those of the surface without details.
void add_details(std::span<const SurfaceDetail> details, Shape& shape);

// The parameters of each object of a shape's parameter `details`.
std::span<const ParameterRow> detail_rows();

// Reads the objects of a shape's parameter `details`. A mirrored detail gives two: the second has x negated.
std::vector<SurfaceDetail> read_details(std::span<const Parameters> objects);

}  // namespace cscd::scenes
