#include "core/geometry/nearest_points.h"

#include <gtest/gtest.h>
#include <random>

namespace cscd {
namespace {

double to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double length = (b - a).squaredNorm();
  const double share = length > 0 ? std::clamp((p - a).dot(b - a) / length, 0.0, 1.0) : 0;
  return (p - a - share * (b - a)).norm();
}

// By another way than Ericson's: the distance to the plane where the foot lies in the face, else to the
// nearest side.
double to_face(const std::array<Vec3, 4>& x) {
  const Vec3 &p = x[0], &a = x[1], &b = x[2], &c = x[3];
  const Vec3 normal = (b - a).cross(c - a);
  const auto is_inside = [&](const Vec3& from, const Vec3& to) {
    return normal.cross(to - from).dot(p - from) >= 0;
  };
  if (normal.norm() > 0 && is_inside(a, b) && is_inside(b, c) && is_inside(c, a))
    return std::abs(normal.normalized().dot(p - a));
  return std::min({to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
}

// Between the lines, where the feet of their common normal lie on both edges, else from an end.
double between_edges(const std::array<Vec3, 4>& x) {
  const auto& [a, b, c, d] = x;
  double least =
      std::min({to_segment(a, c, d), to_segment(b, c, d), to_segment(c, a, b), to_segment(d, a, b)});
  const Vec3 normal = (b - a).cross(d - c);
  if (!(normal.norm() > 0)) return least;
  const double s = (c - a).cross(d - c).dot(normal) / normal.squaredNorm(),
               t = (c - a).cross(b - a).dot(normal) / normal.squaredNorm();
  if (s >= 0 && s <= 1 && t >= 0 && t <= 1) least = std::min(least, std::abs(normal.normalized().dot(c - a)));
  return least;
}

// Points anywhere, and on a small lattice, where many are on borders of the cases. Mutations: any condition
// of a case of a vertex and a face becomes one that holds more often.
TEST(NearestPoints, AreAsFarApartAsTheFeatures) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  std::uniform_int_distribution<int> whole(-3, 3);
  for (int n = 0; n < 20000; ++n) {
    std::array<Vec3, 4> points;
    for (Vec3& p : points)
      for (int k = 0; k < 3; ++k) p[k] = n % 2 == 0 ? any(random) : whole(random);
    SCOPED_TRACE(n);
    const auto& [a, b, c, d] = points;
    const auto check = [&](const Nearest& nearest, std::size_t split, double true_distance) {
      EXPECT_NEAR(nearest.way.norm(), true_distance, 1e-9);
      const DistanceBounds bounds = distance_bounds(points, split, nearest.way);
      EXPECT_LE(bounds.low, true_distance + 1e-12);
      EXPECT_GE(bounds.high, true_distance - 1e-12);
    };
    if ((c - b).cross(d - b).norm() > 1e-3)  // not nearly degenerate, and so below
      check(nearest_of_vertex_face(points), 1, to_face(points));
    const Vec3 p = b - a, q = d - c;
    if (p.cross(q).norm() > 1e-3 * p.norm() * q.norm() && p.norm() > 0 && q.norm() > 0)
      check(nearest_of_edges(points), 2, between_edges(points));
  }
}

}  // namespace
}  // namespace cscd
