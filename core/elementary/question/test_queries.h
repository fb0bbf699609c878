#pragma once

// For tests only: random moving features, from features in general position to features that are degenerate
// in every way.

#include <array>
#include <cstdint>
#include <random>
#include <sstream>
#include <string>
#include <utility>

#include "core/geometry/feature_motion.h"

namespace cscd::test {

using FourMovingPoints = std::array<MovingPoint, 4>;

// The query of four points: a vertex and the three corners of a face, or the ends of the first edge and then
// the ends of the second edge.
template <class Query>
Query query_of(const FourMovingPoints& p);
template <>
inline MovingVertexFace query_of(const FourMovingPoints& p) {
  return {p[0], {p[1], p[2], p[3]}};
}
template <>
inline MovingEdgeEdge query_of(const FourMovingPoints& p) {
  return {{p[0], p[1]}, {p[2], p[3]}};
}

// The points with map() applied to where they start and where they end.
template <class Map>
FourMovingPoints mapped(FourMovingPoints points, const Map& map) {
  for (MovingPoint& p : points) p = {map(p.start), map(p.end)};
  return points;
}
inline FourMovingPoints scaled(const FourMovingPoints& points, double factor) {
  return mapped(points, [&](const Vec3& p) -> Vec3 { return factor * p; });
}
inline FourMovingPoints moved(FourMovingPoints points, const Vec3& start, const Vec3& end) {
  for (MovingPoint& p : points) p = {p.start + start, p.end + end};
  return points;
}
inline FourMovingPoints reversed(FourMovingPoints points) {
  for (MovingPoint& p : points) std::swap(p.start, p.end);
  return points;
}

// The points to the last bit, and what else belongs to the query.
template <class... More>
std::string text(const FourMovingPoints& points, const More&... more) {
  std::ostringstream out;
  out.precision(17);
  for (const MovingPoint& p : points) out << p.start.transpose() << " -> " << p.end.transpose() << "\n";
  ((out << more), ...);
  return out.str();
}

inline MovingPoint still(const Vec3& p) {
  return {p, p};
}
inline MovingPoint still(double x, double y, double z) {
  return still(Vec3(x, y, z));
}

// A vertex that moves, and a face that does not.
inline MovingVertexFace against_triangle(const Vec3& from, const Vec3& to) {
  return {{from, to}, {still(0, 0, 0), still(4, 0, 0), still(0, 4, 0)}};
}

class QueryMaker {
 public:
  explicit QueryMaker(unsigned seed) : random_(seed) {}

  double uniform(double low = -1, double high = 1) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  Vec3 vector() { return {uniform(), uniform(), uniform()}; }

  // Points in general position, with coordinates in [-1, 1].
  FourMovingPoints any() {
    FourMovingPoints p;
    for (MovingPoint& x : p) x = {vector(), vector()};
    return p;
  }

  // Integer coordinates in [-n, n]. Most of these queries are degenerate: coplanar, parallel, collapsed, or
  // touching at corners.
  FourMovingPoints lattice(int n) {
    FourMovingPoints p;
    for (MovingPoint& x : p) x = {lattice_point(n), lattice_point(n)};
    const int kind = below(10);
    if (kind == 0)
      for (MovingPoint& x : p) x.end = x.start;  // at rest
    if (kind == 1 || kind == 2) {                // in one plane all the time
      const int axis = below(3);
      for (MovingPoint& x : p) x.start[axis] = x.end[axis] = 0;
    }
    if (kind == 3) {  // on one line all the time
      const int axis = below(3);
      for (MovingPoint& x : p)
        for (int k = 0; k < 3; ++k)
          if (k != axis) x.start[k] = x.end[k] = 1;
    }
    if (kind == 4) p[3] = p[2];                                              // collapsed
    if (kind == 5) p[3].start = p[2].start + (p[1].start - p[0].start);      // parallel edges at the start
    if (kind == 5 && below(2)) p[3].end = p[2].end + (p[1].end - p[0].end);  // and all the time
    if (kind == 6)
      for (MovingPoint& x : p) x.end = -x.start;  // everything passes the origin at once, turned inside out
    if (kind == 7) {                              // one plane that turns
      for (MovingPoint& x : p) {
        x.start.z() = 0;
        x.end = {x.start.x() + 0.0, x.end.y(), x.start.x()};
      }
    }
    return p;
  }

 private:
  Vec3 lattice_point(int n) { return Vec3(below(2 * n + 1) - n, below(2 * n + 1) - n, below(2 * n + 1) - n); }
  std::mt19937_64 random_;
};

// Features that touch at time t, up to rounding. `u` and `v` are the parameters of the touching point: its
// barycentric coordinates in the face, or its positions along the two edges. `speed` is the length of the
// relative velocity along the normal of the features; smaller random velocities are added.
inline FourMovingPoints vertex_meets_face(QueryMaker& make, double t, double u, double v, double speed = 1) {
  const Vec3 a = make.vector(), b = make.vector(), c = make.vector();
  const Vec3 x = a + u * (b - a) + v * (c - a);
  const Vec3 corner_speed[3] = {0.2 * make.vector(), 0.2 * make.vector(), 0.2 * make.vector()};
  const Vec3 n = (b - a).cross(c - a).normalized();
  const Vec3 vertex_speed = speed * ((make.below(2) ? 1.0 : -1.0) * n + 0.2 * make.vector());
  const auto path = [t](const Vec3& at_t, const Vec3& velocity) {
    return MovingPoint{at_t - t * velocity, at_t + (1 - t) * velocity};
  };
  return {path(x, vertex_speed), path(a, corner_speed[0]), path(b, corner_speed[1]),
          path(c, corner_speed[2])};
}
inline FourMovingPoints edge_meets_edge(QueryMaker& make, double t, double u, double v, double speed = 1) {
  const Vec3 x = make.vector(), d = make.vector(), e = make.vector();
  const Vec3 n = d.cross(e).normalized();
  const auto path = [t](const Vec3& at_t, const Vec3& velocity) {
    return MovingPoint{at_t - t * velocity, at_t + (1 - t) * velocity};
  };
  const Vec3 away = speed * (make.below(2) ? 1.0 : -1.0) * n;
  return {path(x - u * d, 0.2 * make.vector()), path(x + (1 - u) * d, 0.2 * make.vector()),
          path(x - v * e, away + 0.2 * make.vector()), path(x + (1 - v) * e, away + 0.2 * make.vector())};
}

}  // namespace cscd::test
