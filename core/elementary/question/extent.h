#pragma once

#include <algorithm>
#include <cmath>

#include "core/geometry/feature_motion.h"

// The size and the place of a query, and a scaling that brings any doubles to a range in which products of
// coordinates neither underflow nor overflow.
//
// A *relative query* is a query seen from one of its own moving points (`relative`). The *extent* of a query
// is the longest side of the box of all its points at both ends (`extent`).
namespace cscd {

// Calls visit(point) for each of the four moving points of the query.
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

// The largest absolute coordinate along each axis, over all points at both ends.
template <class Query>
Vec3 largest_coordinates(const Query& query) {
  Vec3 largest = Vec3::Zero();
  for_each_point(query, [&](const MovingPoint& p) {
    largest = largest.cwiseMax(p.start.cwiseAbs()).cwiseMax(p.end.cwiseAbs());
  });
  return largest;
}

// `relative` gives the query as seen from one of its moving points: the first corner of the face, or the
// first end of the first edge. The distance of the features at any t stays the same, and so do their
// contacts. Every coordinate is one rounded difference.
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

// The longest side of the axis-aligned box of all points at both ends. Tolerances are given as shares of the
// extent of the relative query.
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

// `scaled` multiplies all coordinates by 2^exponent.
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

// Scales a query whose largest coordinate is very small or very large by the power of two that takes this
// coordinate to [1/2, 1), and returns any other query as it is. The scaling is exact, except for coordinates
// that become subnormal: those move by at most 2^-1075.
template <class Query>
Query in_range(const Query& query) {
  constexpr double small = 0x1p-64, large = 0x1p64;
  const double largest = largest_coordinates(query).maxCoeff();
  if ((largest >= small && largest <= large) || largest == 0) return query;
  return scaled(query, -std::ilogb(largest) - 1);
}

}  // namespace cscd
