#pragma once

// For tests only: the orientation of triangles in exact arithmetic. Every double is taken as the exact
// rational number that it is.

#include <algorithm>
#include <array>
#include <gmpxx.h>
#include <optional>

#include "core/elementary/exact/touch.h"
#include "core/radial/orientation.h"

namespace cscd::test {

using Exact3 = std::array<mpq_class, 3>;

inline Exact3 exact(const Vec3& v) {
  return {mpq_class(v.x()), mpq_class(v.y()), mpq_class(v.z())};
}
inline Exact3 mix(const Exact3& a, const Exact3& b, const mpq_class& t) {
  Exact3 out;
  for (std::size_t i = 0; i < 3; ++i) out[i] = a[i] + t * (b[i] - a[i]);
  return out;
}
inline Exact3 at(const MovingPoint& p, const mpq_class& t) {
  return mix(exact(p.start), exact(p.end), t);
}
inline Exact3 operator-(const Exact3& a, const Exact3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline mpq_class dot(const Exact3& a, const Exact3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Exact3 cross(const Exact3& a, const Exact3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// A triangle and an observer at time t.
struct ExactView {
  Exact3 corner[3], normal, head, tail;
  bool is_segment;

  ExactView(const MovingPoint (&moving)[3], const radial::Observer& observer, const mpq_class& t)
      : head(at(observer.head, t)), tail(at(observer.tail, t)), is_segment(observer.is_segment) {
    for (std::size_t i = 0; i < 3; ++i) corner[i] = at(moving[i], t);
    normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
  }
  // Returns the point of the triangle in which the second corner has weight v and the third has weight w.
  Exact3 point(const mpq_class& v, const mpq_class& w) const {
    Exact3 out;
    for (std::size_t i = 0; i < 3; ++i)
      out[i] = corner[0][i] + v * (corner[1][i] - corner[0][i]) + w * (corner[2][i] - corner[0][i]);
    return out;
  }
  // Returns the sign of the dot product of the normal with the ray from the observer through a point of the
  // triangle.
  int sign(const Exact3& point) const {
    Exact3 from = head;
    const Exact3 way = tail - head;
    const mpq_class length = dot(way, way);
    if (is_segment && sgn(length) > 0) {
      const mpq_class u = dot(point - head, way) / length;
      from = mix(head, tail, std::clamp(u, mpq_class(0), mpq_class(1)));
    }
    return sgn(dot(normal, point - from));
  }
};

inline radial::Orientation from_sign(int sign) {
  return sign > 0   ? radial::Orientation::positive
         : sign < 0 ? radial::Orientation::negative
                    : radial::Orientation::uncertain;
}

// Returns the true class towards a point observer over all of [0, 1], found by isolating the roots of the
// exact cubic.
inline radial::Orientation exact_class(const MovingPoint (&corner)[3], const MovingPoint& q) {
  const cscd::exact::Polynomial f =
      cscd::exact::coplanarity(cscd::exact::linear_points({q, corner[0], corner[1], corner[2]}));
  if (f.is_zero() || !cscd::exact::roots_in_unit_interval(f).empty()) return radial::Orientation::uncertain;
  const ExactView start(corner, radial::Observer::point(q), 0);
  return from_sign(start.sign(start.corner[0]));
}

// Returns the sign that all sampled points of the triangle share at all sampled times, or nothing if the
// signs differ. Samples `times` + 1 instants, and all points whose barycentric weights are multiples of 1 /
// `parts`.
inline std::optional<int> sampled_sign(const MovingPoint (&corner)[3], const radial::Observer& observer,
                                       int times, int parts) {
  std::optional<int> common;
  for (int k = 0; k <= times; ++k) {
    const ExactView view(corner, observer, mpq_class(k, times));
    for (int i = 0; i <= parts; ++i)
      for (int j = 0; i + j <= parts; ++j) {
        const int sign = view.sign(view.point(mpq_class(i, parts), mpq_class(j, parts)));
        if (common && *common != sign) return std::nullopt;
        common = sign;
      }
  }
  return common;
}

}  // namespace cscd::test
