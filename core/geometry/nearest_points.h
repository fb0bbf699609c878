#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/rounding.h"
#include "core/base/vec3.h"

// Nearest points of two features at rest, and certain bounds of their distance. Vertex and face are points[0]
// and the others; edges are points[0] to points[1] and points[2] to points[3].
namespace cscd {

// The way from the nearest point of the second feature to that of the first, up to rounding, and the least
// features that hold these points, by their number among the cases of
// core/elementary/exact/closeness_cases.h. For features that are nearly degenerate or nearly parallel the
// points may be other points of the features than the nearest.
struct Nearest {
  Vec3 way;
  int number;
};

// Ericson, "Real-Time Collision Detection", 2005, 5.1.5.
inline Nearest nearest_of_vertex_face(const std::array<Vec3, 4>& points) {
  const auto& [p, a, b, c] = points;
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp),
               d6 = ac.dot(cp);
  const auto on_edge = [&](const Vec3& from_start, const Vec3& edge, double before, double after,
                           int number) {
    return Nearest{from_start - std::clamp(before / (before + after), 0.0, 1.0) * edge, number};
  };
  if (d1 <= 0 && d2 <= 0) return {ap, 4};
  if (d3 >= 0 && d4 <= d3) return {bp, 5};
  if (d6 >= 0 && d5 <= d6) return {cp, 6};
  const double to_c = d1 * d4 - d3 * d2, to_b = d5 * d2 - d1 * d6, to_a = d3 * d6 - d5 * d4;
  if (to_c <= 0 && d1 >= 0 && d3 <= 0) return on_edge(ap, ab, d1, -d3, 1);
  if (to_b <= 0 && d2 >= 0 && d6 <= 0) return on_edge(ap, ac, d2, -d6, 3);
  if (to_a <= 0 && d4 >= d3 && d5 >= d6) return on_edge(bp, c - b, d4 - d3, d5 - d6, 2);
  const double all = to_a + to_b + to_c, v = std::clamp(to_b / all, 0.0, 1.0),
               w = std::clamp(to_c / all, 0.0, 1 - v);
  return {ap - v * ab - w * ac, 0};
}

// Ericson, 5.1.9.
inline Nearest nearest_of_edges(const std::array<Vec3, 4>& points) {
  const Vec3 p = points[1] - points[0], q = points[3] - points[2], r = points[0] - points[2];
  const double a = p.squaredNorm(), e = q.squaredNorm(), b = p.dot(q), c = p.dot(r), f = q.dot(r);
  const double determinant = a * e - b * b;
  // Below this the determinant is mostly rounding. Edges that are parallel have nearest points with an end
  // among them.
  double s = determinant > 0x1p-48 * a * e ? std::clamp((b * f - c * e) / determinant, 0.0, 1.0) : 0.0;
  double t = e > 0 ? (b * s + f) / e : 0.0;
  if (t <= 0 || t >= 1 || e == 0) {
    t = std::clamp(t, 0.0, 1.0);
    s = a > 0 ? std::clamp((b * t - c) / a, 0.0, 1.0) : 0.0;
  }
  const bool s_inside = s > 0 && s<1, t_inside = t> 0 && t < 1;
  const int first = s >= 1, second = t >= 1;
  const int number = s_inside && t_inside ? 0
                     : t_inside           ? 1 + first
                     : s_inside           ? 3 + second
                                          : 5 + 2 * first + second;
  return {r + s * p - t * q, number};
}

// The distance is at least `low` and at most `high`.
struct DistanceBounds {
  double low, high;
};

// Certain bounds from nearest points. Let u be the unit roundoff and M the largest coordinate, seen from some
// point. Each coordinate of `way` is off by less than 30 u M from a difference of two points of the features,
// so its length bounds the distance from above. From below, the distance is at least the gap that the
// features leave along `way`; projections are off by less than 8 u M times its length, besides the roundings
// of coordinates. The first `split` points belong to the first feature. Where products may underflow or
// overflow, the bounds say nothing.
inline DistanceBounds distance_bounds(const std::array<Vec3, 4>& points, std::size_t split, const Vec3& way) {
  double largest = 0;
  for (const Vec3& x : points) largest = std::max(largest, x.cwiseAbs().maxCoeff());
  const double length = way.norm(), error = 128 * kUnitRoundoff * largest;
  if (!(largest > 1e-100 && largest < 1e100 && length < 1e101)) return {0, HUGE_VAL};
  DistanceBounds bounds{0, length + error};
  if (length <= error) return bounds;
  double nearest = HUGE_VAL, farthest = -HUGE_VAL;
  for (std::size_t i = 0; i < split; ++i) nearest = std::min(nearest, points[i].dot(way));
  for (std::size_t i = split; i < 4; ++i) farthest = std::max(farthest, points[i].dot(way));
  bounds.low = std::max(0.0, (nearest - farthest) / length - error);
  return bounds;
}

}  // namespace cscd
