#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/base/vec3.h"
#include "scenes/shape/shape.h"

namespace cscd::scenes {

// A place on the surface at rest that is raised or dented along the surface's normals, such as a nose, or the
// folds of a sleeve. The displacement is
//   height (1 - d^2)^2, times the cosine of 2 pi x / wave_length if there are folds,
// where d is the distance from `at` in shares of `reach`, and x is the distance from `at` along `across`. The
// displacement ends at d = 1.
struct SurfaceDetail {
  Vec3 at;
  Vec3 reach;              // half axes of the ellipsoid in which the detail lies, along x, y and z; positive
  double height = 0;       // negative for a dent
  double wave_length = 0;  // distance from one fold to the next; 0 for none
  Vec3 across;             // the direction from fold to fold, of length 1; used only if there are folds
};

// Displaces the positions by the sum of all details. Normals are those of the surface without details.
void add_details(std::span<const SurfaceDetail> details, Shape& shape);

// The parameters of each object of a shape's parameter `details`.
std::span<const ParameterRow> detail_rows();

// Reads the objects of a shape's parameter `details`. A mirrored detail gives two: the second has x negated.
std::vector<SurfaceDetail> read_details(std::span<const Parameters> objects);

}  // namespace cscd::scenes
