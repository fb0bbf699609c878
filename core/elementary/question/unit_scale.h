#pragma once

#include <algorithm>
#include <cmath>

#include "core/geometry/feature_motion.h"

// Scales a query to the size of 1 by powers of two, for coordinates whose products underflow or overflow.
//
// The scaling is exact, except for coordinates that become subnormal: those may be off by 2^-1074. That error
// is covered by the bounds of bernstein.h and sides.h, because it lies far below the roundings of any numbers
// that kTinyProduct and kLeastSize admit.
namespace cscd {

// Calls take(point) for each of the four moving points of the query; `take` may change the point.
template <class Take>
void for_each_point(MovingVertexFace& query, const Take& take) {
  take(query.vertex);
  for (MovingPoint& p : query.corner) take(p);
}
template <class Take>
void for_each_point(MovingEdgeEdge& query, const Take& take) {
  for (MovingPoint& p : query.first) take(p);
  for (MovingPoint& p : query.second) take(p);
}

namespace unit_scale {

// The power of two that takes |x| to [1/2, 1) when x is divided by it; 0 for zero.
inline int exponent_of(double x) {
  int exponent = 0;
  std::frexp(x, &exponent);
  return exponent;
}
template <class Query>
Vec3 largest_coordinates(Query query) {
  Vec3 largest = Vec3::Zero();
  for_each_point(query, [&](const MovingPoint& p) {
    largest = largest.cwiseMax(p.start.cwiseAbs()).cwiseMax(p.end.cwiseAbs());
  });
  return largest;
}
// Divides the coordinates along axis k by 2^exponent[k].
template <class Query>
Query scaled(Query query, const int (&exponent)[3]) {
  for_each_point(query, [&](MovingPoint& p) {
    for (int k = 0; k < 3; ++k) {
      p.start[k] = std::ldexp(p.start[k], -exponent[k]);
      p.end[k] = std::ldexp(p.end[k], -exponent[k]);
    }
  });
  return query;
}

}  // namespace unit_scale

// Scales all axes by one power of two, so that the largest coordinate lies in [1/2, 1). The shape stays.
template <class Query>
Query scaled_to_unit(const Query& query) {
  const int e = unit_scale::exponent_of(unit_scale::largest_coordinates(query).maxCoeff());
  return unit_scale::scaled(query, {e, e, e});
}

// Scales each axis by its own power of two, so that its largest coordinate lies in [1/2, 1). Contacts and
// their times stay; lengths and angles change.
template <class Query>
Query axes_scaled_to_unit(const Query& query) {
  const Vec3 largest = unit_scale::largest_coordinates(query);
  return unit_scale::scaled(query, {unit_scale::exponent_of(largest[0]), unit_scale::exponent_of(largest[1]),
                                    unit_scale::exponent_of(largest[2])});
}

}  // namespace cscd
