// Decides whether two coplanar features touch, by signs of polynomials of degree 2. The features are
// projected along a coordinate axis along which their plane keeps an area, and orientations in that
// projection decide. If there is no such axis (the triangle is a segment or a point, or the edges are
// parallel or points), the test is whether points lie on segments. These two cases cover all features, and
// nothing is rounded.
#include "core/elementary/exact/touch.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace cscd::exact {
namespace {

// The double mantissa * 2^exponent. The mantissa is odd, or zero.
struct Scaled {
  std::int64_t mantissa = 0;
  int exponent = 0;
};

Scaled scaled(double x) {
  if (x == 0) return {};
  Scaled result;
  result.mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &result.exponent), 53));
  result.exponent -= 53;
  while (result.mantissa % 2 == 0) {
    result.mantissa /= 2;
    ++result.exponent;
  }
  return result;
}

// Multiplies all values by one power of two that makes them integers.
template <std::size_t count>
std::array<Integer, count> to_integers(const std::array<double, count>& values) {
  std::array<Scaled, count> parts;
  int smallest = 0;
  bool found = false;
  for (std::size_t i = 0; i < count; ++i) {
    parts[i] = scaled(values[i]);
    if (parts[i].mantissa == 0) continue;
    smallest = found ? std::min(smallest, parts[i].exponent) : parts[i].exponent;
    found = true;
  }
  std::array<Integer, count> integers;
  for (std::size_t i = 0; i < count; ++i) {
    integers[i] = parts[i].mantissa;
    if (parts[i].mantissa != 0) integers[i] <<= static_cast<unsigned long>(parts[i].exponent - smallest);
  }
  return integers;
}

Point operator-(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

// Component k of the cross product u x w.
Polynomial cross(const Point& u, const Point& w, std::size_t k) {
  const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
  Polynomial result;
  result.add_product(u[i], w[j]);
  result.subtract_product(u[j], w[i]);
  return result;
}

Polynomial dot(const Point& u, const Point& w) {
  Polynomial result;
  for (std::size_t k = 0; k < 3; ++k) result.add_product(u[k], w[k]);
  return result;
}

// Twice the signed area of the triangle a, b, c seen along axis k.
Polynomial orientation(const Point& a, const Point& b, const Point& c, std::size_t k) {
  return cross(b - a, c - a, k);
}

// Whether a point lies on a segment, which may itself be a point.
bool point_on_segment(const Point& p, const Point& a, const Point& b, AlgebraicNumber& time) {
  for (std::size_t k = 0; k < 3; ++k)
    if (time.sign_of(orientation(a, b, p, k)) != 0) return false;
  return time.sign_of(dot(p - a, p - b)) <= 0;
}

void add_segment_events(std::vector<Polynomial>& events, const Point& p, const Point& a, const Point& b) {
  for (std::size_t k = 0; k < 3; ++k) events.push_back(orientation(a, b, p, k));
  events.push_back(dot(p - a, p - b));
}

}  // namespace

FourPoints linear_points(const std::array<MovingPoint, 4>& points) {
  return linear_points(points, 0).points;
}

PointsAndLength linear_points(const std::array<MovingPoint, 4>& points, double length) {
  std::array<double, 25> values;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      values[6 * i + k] = points[i].start[static_cast<Eigen::Index>(k)];
      values[6 * i + 3 + k] = points[i].end[static_cast<Eigen::Index>(k)];
    }
  values[24] = length;
  const std::array<Integer, 25> integers = to_integers(values);
  PointsAndLength result;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const Integer &start = integers[6 * i + k], &end = integers[6 * i + 3 + k];
      result.points[i][k] = Polynomial(start, end - start);
    }
  result.length = integers[24];
  return result;
}

FourPoints constant_points(const std::array<Vec3, 4>& points) {
  std::array<double, 12> values;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 3; ++k) values[3 * i + k] = points[i][static_cast<Eigen::Index>(k)];
  const std::array<Integer, 12> integers = to_integers(values);
  FourPoints result;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 3; ++k) result[i][k] = Polynomial(integers[3 * i + k]);
  return result;
}

Polynomial coplanarity(const FourPoints& points) {
  const Point u = points[1] - points[0], w = points[2] - points[0], x = points[3] - points[0];
  Polynomial result;
  for (std::size_t k = 0; k < 3; ++k) result.add_product(cross(u, w, k), x[k]);
  return result;
}

bool vertex_touches_triangle(const FourPoints& points, AlgebraicNumber& time) {
  const auto& [v, a, b, c] = points;
  for (std::size_t k = 0; k < 3; ++k) {
    const int normal = time.sign_of(orientation(a, b, c, k));
    if (normal == 0) continue;
    return normal * time.sign_of(orientation(a, b, v, k)) >= 0 &&
           normal * time.sign_of(orientation(b, c, v, k)) >= 0 &&
           normal * time.sign_of(orientation(c, a, v, k)) >= 0;
  }
  // Any two edges of a triangle without area cover it.
  return point_on_segment(v, a, b, time) || point_on_segment(v, b, c, time);
}

bool edges_touch(const FourPoints& points, AlgebraicNumber& time) {
  const auto& [a, b, c, d] = points;
  const Point first = b - a, second = d - c;
  for (std::size_t k = 0; k < 3; ++k) {
    if (time.sign_of(cross(first, second, k)) == 0) continue;
    return time.sign_of(orientation(a, b, c, k)) * time.sign_of(orientation(a, b, d, k)) <= 0 &&
           time.sign_of(orientation(c, d, a, k)) * time.sign_of(orientation(c, d, b, k)) <= 0;
  }
  // Parallel segments that touch either meet in an end of the first segment, or the second segment lies
  // inside the first with both ends.
  return point_on_segment(a, c, d, time) || point_on_segment(b, c, d, time) ||
         point_on_segment(c, a, b, time);
}

std::vector<Polynomial> vertex_triangle_events(const FourPoints& points) {
  const auto& [v, a, b, c] = points;
  std::vector<Polynomial> events;
  for (std::size_t k = 0; k < 3; ++k) events.push_back(orientation(a, b, c, k));
  add_segment_events(events, v, a, b);
  add_segment_events(events, v, b, c);
  add_segment_events(events, v, c, a);
  return events;
}

std::vector<Polynomial> edge_edge_events(const FourPoints& points) {
  const auto& [a, b, c, d] = points;
  std::vector<Polynomial> events;
  for (std::size_t k = 0; k < 3; ++k) events.push_back(cross(b - a, d - c, k));
  add_segment_events(events, a, c, d);
  add_segment_events(events, b, c, d);
  add_segment_events(events, c, a, b);
  add_segment_events(events, d, a, b);
  return events;
}

}  // namespace cscd::exact
