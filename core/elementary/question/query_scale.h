#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "core/geometry/feature_motion.h"

// The place and size of a query, and how a query is brought to another size by powers of two, for coordinates
// whose products would underflow or overflow. Scaling by a power of two is exact, except that a coordinate
// which becomes subnormal moves by at most 2^-1074. That is so far below the roundings of anything that
// kTinyProduct and kLeastSize admit that the error bounds of bernstein.h and sides.h pay for it.
namespace cscd {

// Visits the four moving points of a query, whether or not they may be changed.
template <class Query, class Visit>
void for_each_point(Query& query, const Visit& visit) {
  if constexpr (std::is_same_v<std::remove_const_t<Query>, MovingVertexFace>) {
    visit(query.vertex);
    for (auto& p : query.corner) visit(p);
  } else {
    for (auto& p : query.first) visit(p);
    for (auto& p : query.second) visit(p);
  }
}

// The largest absolute coordinate along each axis, over both ends.
template <class Query>
Vec3 largest_coordinates(const Query& query) {
  Vec3 largest = Vec3::Zero();
  for_each_point(query, [&](const MovingPoint& p) {
    largest = largest.cwiseMax(p.start.cwiseAbs()).cwiseMax(p.end.cwiseAbs());
  });
  return largest;
}

// The query as seen from the first corner of its triangle, or from the first end of its first edge, which
// moves. Whether and when the features touch does not change, nor how far apart they are. Every coordinate is
// one rounded difference.
template <class Query>
Query relative(const Query& query) {
  MovingPoint from;
  if constexpr (std::is_same_v<Query, MovingVertexFace>)
    from = query.corner[0];
  else
    from = query.first[0];
  Query seen = query;
  for_each_point(seen, [&](MovingPoint& p) { p = {p.start - from.start, p.end - from.end}; });
  return seen;
}

// The longest side of the box of all points at both ends. For a relative query this is the length that
// tolerances are shares of.
template <class Query>
double extent(const Query& query) {
  Vec3 low, high;
  bool first = true;
  for_each_point(query, [&](const MovingPoint& p) {
    const Vec3 least = p.start.cwiseMin(p.end), most = p.start.cwiseMax(p.end);
    low = first ? least : Vec3(low.cwiseMin(least));
    high = first ? most : Vec3(high.cwiseMax(most));
    first = false;
  });
  return (high - low).maxCoeff();
}

// Multiplies each axis by its own power of two.
template <class Query>
Query scaled(Query query, const std::array<int, 3>& exponent) {
  for_each_point(query, [&](MovingPoint& p) {
    for (int k = 0; k < 3; ++k) {
      p.start[k] = std::ldexp(p.start[k], exponent[static_cast<std::size_t>(k)]);
      p.end[k] = std::ldexp(p.end[k], exponent[static_cast<std::size_t>(k)]);
    }
  });
  return query;
}

// The exponent of the power of two that takes x to [1/2, 1).
inline int exponent_to_unit(double x) {
  int exponent = 0;
  std::frexp(x, &exponent);
  return -exponent;
}

// Multiplies all axes by one power of two, so that the largest coordinate lies in [1/2, 1). The shape stays.
template <class Query>
Query scaled_to_unit(const Query& query) {
  const int e = exponent_to_unit(largest_coordinates(query).maxCoeff());
  return scaled(query, {e, e, e});
}

// Multiplies each axis by its own power of two, so that its largest coordinate lies in [1/2, 1). Contact and
// its time stay, lengths and angles do not.
template <class Query>
Query axes_scaled_to_unit(const Query& query) {
  const Vec3 largest = largest_coordinates(query);
  return scaled(query,
                {exponent_to_unit(largest[0]), exponent_to_unit(largest[1]), exponent_to_unit(largest[2])});
}

// The exponent of the power of two by which in_range scales: 0 unless the largest coordinate is very small or
// very large.
template <class Query>
int range_exponent(const Query& query) {
  constexpr double small = 0x1p-64, large = 0x1p64;
  const double largest = largest_coordinates(query).maxCoeff();
  return (largest >= small && largest <= large) || largest == 0 ? 0 : exponent_to_unit(largest);
}

// Scales to unit a query whose largest coordinate is very small or very large, and leaves others as they are.
template <class Query>
Query in_range(const Query& query) {
  const int e = range_exponent(query);
  return e == 0 ? query : scaled(query, {e, e, e});
}

}  // namespace cscd
