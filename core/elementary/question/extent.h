#pragma once

#include <algorithm>
#include <cmath>

#include "core/geometry/feature_motion.h"

// Size and place of a query, and the whole range of doubles brought to where products of coordinates neither
// underflow nor overflow.
namespace cscd {

template <class Visit>
void for_each_point(const MovingVertexFace& q, const Visit& visit) {
  visit(q.vertex);
  for (const MovingPoint& p : q.corner) visit(p);
}
template <class Visit>
void for_each_point(const MovingEdgeEdge& q, const Visit& visit) {
  for (const MovingPoint& p : q.first) visit(p);
  for (const MovingPoint& p : q.second) visit(p);
}

// Largest absolute coordinate along each axis.
template <class Query>
Vec3 largest_coordinates(const Query& query) {
  Vec3 largest = Vec3::Zero();
  for_each_point(query, [&](const MovingPoint& p) {
    largest = largest.cwiseMax(p.start.cwiseAbs()).cwiseMax(p.end.cwiseAbs());
  });
  return largest;
}

// Seen from its first corner, or its first edge's first end, in motion: whether and when features touch does
// not change, nor how far apart they are. Every coordinate is one rounded difference.
inline MovingPoint seen_from(const MovingPoint& from, const MovingPoint& p) {
  return {p.start - from.start, p.end - from.end};
}
inline MovingVertexFace relative(const MovingVertexFace& q) {
  const auto part = [&](const MovingPoint& p) { return seen_from(q.corner[0], p); };
  return {part(q.vertex), {part(q.corner[0]), part(q.corner[1]), part(q.corner[2])}};
}
inline MovingEdgeEdge relative(const MovingEdgeEdge& q) {
  const auto part = [&](const MovingPoint& p) { return seen_from(q.first[0], p); };
  return {{part(q.first[0]), part(q.first[1])}, {part(q.second[0]), part(q.second[1])}};
}

// The longest side of the box of all points at both ends. Of a relative query: the length that tolerances are
// shares of.
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

inline MovingPoint scaled(const MovingPoint& p, int exponent) {
  const auto scale = [exponent](const Vec3& x) {
    return Vec3(std::ldexp(x.x(), exponent), std::ldexp(x.y(), exponent), std::ldexp(x.z(), exponent));
  };
  return {scale(p.start), scale(p.end)};
}
inline MovingVertexFace scaled(const MovingVertexFace& q, int exponent) {
  const auto part = [exponent](const MovingPoint& p) { return scaled(p, exponent); };
  return {part(q.vertex), {part(q.corner[0]), part(q.corner[1]), part(q.corner[2])}};
}
inline MovingEdgeEdge scaled(const MovingEdgeEdge& q, int exponent) {
  const auto part = [exponent](const MovingPoint& p) { return scaled(p, exponent); };
  return {{part(q.first[0]), part(q.first[1])}, {part(q.second[0]), part(q.second[1])}};
}

// Times the power of two that takes the largest coordinate to [1/2, 1), if it is very small or very large.
// Exact, but for coordinates that become subnormal: those move by at most 2^-1075.
template <class Query>
Query in_range(const Query& query) {
  constexpr double small = 0x1p-64, large = 0x1p64;
  const double largest = largest_coordinates(query).maxCoeff();
  if ((largest >= small && largest <= large) || largest == 0) return query;
  return scaled(query, -std::ilogb(largest) - 1);
}

}  // namespace cscd
