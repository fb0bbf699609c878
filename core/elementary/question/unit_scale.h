#pragma once

#include <algorithm>
#include <cmath>

#include "core/geometry/feature_motion.h"

// Queries brought to the size of 1 by powers of two, for coordinates whose products underflow or overflow.
// That is exact but for coordinates that become subnormal: those may be off by 2^-1074, so far below the
// roundings of anything that kTinyProduct and kLeastSize admit that the bounds of bernstein.h and sides.h pay
// for it.
namespace cscd {

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

// All axes by one power of two: the same shape.
template <class Query>
Query scaled_to_unit(const Query& query) {
  const int e = unit_scale::exponent_of(unit_scale::largest_coordinates(query).maxCoeff());
  return unit_scale::scaled(query, {e, e, e});
}

// Each axis by its own: contact and its time stay, lengths and angles do not.
template <class Query>
Query axes_scaled_to_unit(const Query& query) {
  const Vec3 largest = unit_scale::largest_coordinates(query);
  return unit_scale::scaled(query, {unit_scale::exponent_of(largest[0]), unit_scale::exponent_of(largest[1]),
                                    unit_scale::exponent_of(largest[2])});
}

}  // namespace cscd
