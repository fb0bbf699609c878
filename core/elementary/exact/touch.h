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
// Vertex and the triangle's three corners, or the first edge's two ends and the second edge's two.
using FourPoints = std::array<Point, 4>;

// The points' coordinates times one common power of two.
FourPoints linear_points(const std::array<MovingPoint, 4>& points);
FourPoints constant_points(const std::array<Vec3, 4>& points);

// Zero exactly when the four points lie in one plane. Of degree 3 for moving points.
Polynomial coplanarity(const FourPoints& points);

// Do the closed features touch at `time`, at which their points are coplanar?
bool vertex_touches_triangle(const FourPoints& points, AlgebraicNumber& time);
bool edges_touch(const FourPoints& points, AlgebraicNumber& time);

// All the polynomials whose signs the functions above may look at: between two neighbouring roots of these
// the answer does not change as long as the points stay coplanar.
std::vector<Polynomial> vertex_triangle_events(const FourPoints& points);
std::vector<Polynomial> edge_edge_events(const FourPoints& points);

}  // namespace cscd::exact
