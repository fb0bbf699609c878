#include "core/geometry/feature_distance.h"

#include <algorithm>
#include <cmath>

namespace cscd {

double squared_point_segment_distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a, ap = p - a;
  const double length = ab.squaredNorm();
  const double s = length > 0 ? std::clamp(ap.dot(ab) / length, 0.0, 1.0) : 0.0;
  return (ap - s * ab).squaredNorm();
}

// Ericson, "Real-Time Collision Detection", 2005, 5.1.9.
double squared_segment_distance(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1) {
  const Vec3 p = p1 - p0, q = q1 - q0, r = p0 - q0;
  const double a = p.squaredNorm(), e = q.squaredNorm(), b = p.dot(q), c = p.dot(r), f = q.dot(r);
  const double determinant = a * e - b * b;
  double s = determinant > 0 ? std::clamp((b * f - c * e) / determinant, 0.0, 1.0) : 0.0;
  double t = e > 0 ? (b * s + f) / e : 0.0;
  if (t < 0 || t > 1 || e == 0) {
    t = std::clamp(t, 0.0, 1.0);
    s = a > 0 ? std::clamp((b * t - c) / a, 0.0, 1.0) : 0.0;
  }
  return (r + s * p - t * q).squaredNorm();
}

// Measures to the face if the point projects into it, else to the nearest edge.
double squared_point_triangle_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a);
  const double area = n.squaredNorm();
  if (area > 0 && (b - a).cross(p - a).dot(n) >= 0 && (c - b).cross(p - b).dot(n) >= 0 &&
      (a - c).cross(p - c).dot(n) >= 0) {
    const double height = (p - a).dot(n);
    return height * (height / area);
  }
  return std::min({squared_point_segment_distance(p, a, b), squared_point_segment_distance(p, b, c),
                   squared_point_segment_distance(p, c, a)});
}

double distance_at(const MovingVertexFace& q, double t) {
  return std::sqrt(squared_point_triangle_distance(q.vertex.at(t), q.corner[0].at(t), q.corner[1].at(t),
                                                   q.corner[2].at(t)));
}
double distance_at(const MovingEdgeEdge& q, double t) {
  return std::sqrt(
      squared_segment_distance(q.first[0].at(t), q.first[1].at(t), q.second[0].at(t), q.second[1].at(t)));
}

}  // namespace cscd
