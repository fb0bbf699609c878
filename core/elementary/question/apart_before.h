#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

#include "core/base/rounding.h"
#include "core/geometry/nearest_points.h"
#include "core/mesh/motion.h"

namespace cscd {

// Four moving points of two features, of which the first `split` belong to the first feature.
struct PointsOfFeatures {
  std::array<Vec3, 4> start, end;  // seen from the last point
  std::size_t split;
  double largest = 0;  // coordinate
};

template <class Query>
PointsOfFeatures points_of_features(const Query& query) {
  std::array<MovingPoint, 4> points;
  PointsOfFeatures out{};
  if constexpr (requires { query.vertex; }) {
    points = {query.vertex, query.corner[0], query.corner[1], query.corner[2]};
    out.split = 1;
  } else {
    points = {query.first[0], query.first[1], query.second[0], query.second[1]};
    out.split = 2;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    out.start[i] = points[i].start - points[3].start;
    out.end[i] = points[i].end - points[3].end;
    out.largest =
        std::max({out.largest, out.start[i].cwiseAbs().maxCoeff(), out.end[i].cwiseAbs().maxCoeff()});
  }
  return out;
}

// Returns a time before which the features certainly stay farther than `distance` apart, judged along one
// direction: at least 1 if they do so throughout, and 0 if nothing is known. The gap of two points along a
// direction is linear in time. With u the unit roundoff, M the largest coordinate and L the length of the
// direction, a gap is off by less than 22 u M L: twice by u M L sqrt(3) for coordinates, and by three times
// that for a projection, and by 4 u M L for the difference. Along an axis it is off by less than 6 u M.
// `roundings` u (M + distance) L pays for that and for the roundings of the bound.
inline double apart_before_along(const PointsOfFeatures& points, const Vec3& direction, double roundings,
                                 double distance) {
  const double length = direction.norm();
  const double least = length * (distance + roundings * kUnitRoundoff * (points.largest + distance));
  double from[4], to[4];
  for (std::size_t i = 0; i < 4; ++i)
    from[i] = points.start[i].dot(direction), to[i] = points.end[i].dot(direction);
  double over = 2, under = 2;
  for (std::size_t i = 0; i < points.split; ++i)
    for (std::size_t j = points.split; j < 4; ++j) {
      const auto zero = [&](double first, double last) {
        if (!(first > 0)) return 0.0;
        return last > 0 ? 2.0 : (1 - 8 * kUnitRoundoff) * (first / (first - last));
      };
      const double first = from[i] - from[j], last = to[i] - to[j];
      over = std::min(over, zero(first - least, last - least));
      under = std::min(under, zero(-first - least, -last - least));
    }
  return std::max(over, under);
}

// Returns such a time, judged along a few directions, of which others are not tried once it is `enough`.
template <class Query>
double apart_before(const Query& query, double distance, double enough) {
  constexpr double kAlongAxis = 12, kAlongAny = 32;
  const PointsOfFeatures points = points_of_features(query);
  // Beyond, products might underflow or overflow.
  if (!(points.largest > 1e-100 && points.largest < 1e100 && distance < 1e100)) return 0;
  double time = 0;
  for (int k = 0; k < 3 && !(time >= enough); ++k)
    time = std::max(time, apart_before_along(points, Vec3::Unit(k), kAlongAxis, distance));
  if (time >= enough) return time;
  const Vec3 way =
      (points.split == 1 ? nearest_of_vertex_face(points.start) : nearest_of_edges(points.start)).way;
  if (!(way.norm() > 1e-50 * points.largest)) return time;
  return std::max(time, apart_before_along(points, way, kAlongAny, distance));
}

}  // namespace cscd
