#pragma once

#include <Eigen/Geometry>
#include <algorithm>

#include "core/base/vec3.h"

namespace cscd::radial {

// Returns the point of the segment that is nearest to p. A segment of length zero is its one point.
inline Vec3 nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 way = b - a;
  const double squared = way.squaredNorm();
  if (!(squared > 0)) return a;
  return a + std::clamp((p - a).dot(way) / squared, 0.0, 1.0) * way;
}

// Returns the point of the triangle that is nearest to p: the foot of the perpendicular if it falls inside,
// else a point of an edge. The edges are looked at either way, because the foot on a sliver is not to be
// trusted.
inline Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  Vec3 nearest = nearest_on_segment(p, a, b);
  double least = (p - nearest).squaredNorm();
  const auto offer = [&](const Vec3& candidate) {
    const double squared = (p - candidate).squaredNorm();
    if (!(squared < least)) return;
    least = squared;
    nearest = candidate;
  };
  offer(nearest_on_segment(p, b, c));
  offer(nearest_on_segment(p, c, a));

  const Vec3 ab = b - a, ac = c - a, ap = p - a, normal = ab.cross(ac);
  const double area = normal.squaredNorm();  // v and w are barycentric weights times this
  const double v = ap.cross(ac).dot(normal), w = ab.cross(ap).dot(normal);
  if (v > 0 && w > 0 && v + w < area) offer(a + v / area * ab + w / area * ac);
  return nearest;
}

}  // namespace cscd::radial
