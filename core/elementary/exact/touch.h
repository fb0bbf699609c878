#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/elementary/exact/algebraic.h"
#include "core/elementary/exact/polynomial.h"
#include "core/geometry/feature_motion.h"

namespace cscd::exact {

// A point whose coordinates are polynomials in t with integer coefficients.
using Point = std::array<Polynomial, 3>;
// The vertex and the three corners of the triangle, or the two ends of the first edge and the two ends of the
// second edge.
using FourPoints = std::array<Point, 4>;

// The coordinates of the points times one common power of two that makes all of them integers.
FourPoints linear_points(const std::array<MovingPoint, 4>& points);
// The same with a length that takes part in the scaling and comes back scaled.
struct PointsAndLength {
  FourPoints points;
  Integer length;
};
PointsAndLength linear_points(const std::array<MovingPoint, 4>& points, double length);
FourPoints constant_points(const std::array<Vec3, 4>& points);

// The coplanarity polynomial, which is zero exactly when the four points lie in one plane. Its degree is at
// most 3 for moving points and at most 0 for points at rest.
Polynomial coplanarity(const FourPoints& points);

// True if the closed features touch at `time`. Their points must be coplanar at that time.
bool vertex_touches_triangle(const FourPoints& points, AlgebraicNumber& time);
bool edges_touch(const FourPoints& points, AlgebraicNumber& time);

// All polynomials whose signs the two functions above may ask for. Between two neighbouring roots of these
// polynomials the answer does not change, as long as the points stay coplanar.
std::vector<Polynomial> vertex_triangle_events(const FourPoints& points);
std::vector<Polynomial> edge_edge_events(const FourPoints& points);

}  // namespace cscd::exact
