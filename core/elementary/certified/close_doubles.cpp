// Two steps take turns from a time `low` on, up to which the features are certainly apart.
//
// Advance: the features stay farther than r apart at least as long as their gap along one fixed direction
// exceeds r. The direction is that of their nearest points at `low`. The gap between two points along it is
// linear in time, so the first time at which some two points leave no more than r is found without iteration.
//
// Close in: once that gains little, the case of nearest features at `low` is followed
// (exact/closeness_cases.h). Where the nearest points certainly stay inside the same features from `low` to
// `high` and the squared distance certainly falls there, the features become close exactly when the case's
// polynomial falls to zero, if it does. Newton's method finds that time, and one value in pairs of doubles
// makes the largest double not above it certain, as in contact_time.h.
//
// Where several pairs of features are nearest together, or the distance begins at r up to rounding, gaps and
// distances of points tell neighbouring times apart in pairs of doubles (fall_along).
//
// All numbers know how far they are off (approximate.h), and what they leave open is `unclear`.
#include "core/elementary/certified/close_doubles.h"

#include <algorithm>
#include <cmath>

#include "core/elementary/certified/approximate.h"
#include "core/elementary/exact/closeness_cases.h"
#include "core/elementary/question/query_scale.h"
#include "core/geometry/nearest_points.h"

namespace cscd {
namespace {

using exact::CloseCase;
using exact::dot;
using exact::operator-;
using exact::PointOf;
using Doubles = Approximate<double>;
using Pairs = Approximate<Pair>;
using Moving = WithSlope<Doubles>;

template <class Query>
struct Kind;
template <>
struct Kind<MovingVertexFace> {
  static constexpr std::size_t split = 1;  // so many of the points belong to the first feature
  static constexpr int cases = exact::kVertexFaceCases;
  static std::array<MovingPoint, 4> points(const MovingVertexFace& q) {
    return {q.vertex, q.corner[0], q.corner[1], q.corner[2]};
  }
  static Nearest nearest(const std::array<Vec3, 4>& points) { return nearest_of_vertex_face(points); }
  template <class Number>
  static CloseCase<Number> close_case(int number, const std::array<PointOf<Number>, 4>& points,
                                      const Number& rr) {
    return exact::vertex_face_case(number, points, rr);
  }
};
template <>
struct Kind<MovingEdgeEdge> {
  static constexpr std::size_t split = 2;
  static constexpr int cases = exact::kEdgeEdgeCases;
  static std::array<MovingPoint, 4> points(const MovingEdgeEdge& q) {
    return {q.first[0], q.first[1], q.second[0], q.second[1]};
  }
  static Nearest nearest(const std::array<Vec3, 4>& points) { return nearest_of_edges(points); }
  template <class Number>
  static CloseCase<Number> close_case(int number, const std::array<PointOf<Number>, 4>& points,
                                      const Number& rr) {
    return exact::edge_edge_case(number, points, rr);
  }
};

// The vertex and the ends of the edge of a case other than the first. For two vertices, both ends are one.
struct VertexAndEdge {
  std::size_t vertex, from, to;
};
template <class Query>
VertexAndEdge vertex_and_edge(int number) {
  const auto n = static_cast<std::size_t>(number);
  if constexpr (std::is_same_v<Query, MovingVertexFace>) {
    return n < 4 ? VertexAndEdge{0, n, 1 + n % 3} : VertexAndEdge{0, n - 3, n - 3};
  } else {
    if (n < 3) return {n - 1, 2, 3};
    if (n < 5) return {n - 1, 0, 1};
    return {(n - 5) / 2, 2 + (n - 5) % 2, 2 + (n - 5) % 2};
  }
}

template <class Query>
class Closeness {
 public:
  Closeness(const Query& query, double r) : points_(Kind<Query>::points(query)), r_(r) {
    for (std::size_t i = 0; i < 4; ++i) {
      start_[i] = points_[i].start - points_[3].start;
      end_[i] = points_[i].end - points_[3].end;
      largest_ = std::max({largest_, start_[i].cwiseAbs().maxCoeff(), end_[i].cwiseAbs().maxCoeff()});
    }
  }

  CloseResult decide(bool apart_at_start) {
    double low = 0, tried = 0x1p-3;
    for (int step = 0; step < kMostSteps; ++step) {
      const std::array<Vec3, 4> now = at(low);
      const Nearest nearest = Kind<Query>::nearest(now);
      if (low == 0 && !apart_at_start) {
        const DistanceBounds distance = distance_bounds(now, Kind<Query>::split, nearest.way);
        if (distance.high <= r_) return {CloseResult::close, 0};
        if (distance.low <= r_) return {CloseResult::unclear_start, 0, nearest.number};
      }
      if (!in_range()) return {CloseResult::unclear, 0, nearest.number};
      double gain = advance(now, nearest.way) * (1 - low);
      if (low + gain >= 1) return {CloseResult::apart};
      if (gain < tried) {
        const CloseResult closed_in = close_in(low, nearest);
        if (closed_in.kind != CloseResult::unclear) return closed_in;
        if (gain < 0x1p-40) {
          const CloseResult fallen = fall_along(low, nearest);
          if (fallen.kind != CloseResult::unclear || !(fallen.time - low > 0x1p-40)) return fallen;
          gain = fallen.time - low;
        }
        tried = gain / 4;
      }
      low += gain;
    }
    return {CloseResult::unclear, low};
  }

  // If the distance at t = 1 is exactly r, no two points are less than r apart along the exact direction of
  // the nearest points then. Where all are farther apart along it at t = 0, the gaps, which are linear in
  // time, exceed r until t = 1.
  //
  // The computed way is that of some two points of the features, up to 64 u M, where M is the largest
  // coordinate. Along the exact direction such two points are at least r apart, so the cosine of the angle
  // between the two is at least r / (r + e), where e is what the way is longer than r and 64 u M. The angle
  // is below sqrt(2 e / r), and moves the gap of two points by less than that times 4 M.
  EndOfMotion end_of_motion() const {
    const Nearest nearest = Kind<Query>::nearest(end_);
    if (!in_range()) return {nearest.number, false};
    const double length = nearest.way.norm();
    const double excess = std::max(0.0, length - r_) + 128 * kUnitRoundoff * (largest_ + r_);
    const double least = length * (r_ + 4 * largest_ * std::sqrt(2.1 * excess / r_) + excess);
    bool from_afar = length > 0;
    for (std::size_t i = 0; i < Kind<Query>::split; ++i)
      for (std::size_t j = Kind<Query>::split; j < 4; ++j)
        from_afar = from_afar && (start_[i] - start_[j]).dot(nearest.way) > least;
    return {nearest.number, from_afar};
  }

  unsigned possible_cases(double from) const {
    unsigned possible = (1U << Kind<Query>::cases) - 1;
    if (!in_range()) return possible;
    for (int i = 0; i < Kind<Query>::cases; ++i) {
      const CloseCase<Moving> which = case_at(i, 0.5 * (1 + from), 0.5 * (1 - from) + 0x1p-52);
      bool excluded = which.beyond.value.sign() > 0;
      for (std::size_t k = 0; k < which.insides; ++k) excluded |= which.inside[k].value.sign() < 0;
      if (excluded) possible &= ~(1U << i);
    }
    return possible;
  }

 private:
  static constexpr int kMostSteps = 200;

  // In this range no product underflows or overflows so far that it matters.
  bool in_range() const { return largest_ > 0x1p-64 && largest_ < 0x1p64 && r_ > 0x1p-128 && r_ < 0x1p64; }

  std::array<Vec3, 4> at(double t) const {
    std::array<Vec3, 4> now;
    for (std::size_t i = 0; i < 4; ++i) now[i] = (1 - t) * start_[i] + t * end_[i];
    return now;
  }

  // The share of the rest of the interval in which the features are certainly farther than r apart, at least
  // 1 if they are in all of it. A projection is off by less than 32 u M times the length of `way`, where M is
  // the largest coordinate: 4 u M from the point at this time and from the seen corner, and 4 u M from the
  // product. Twice that is the error of a gap, and the share, whose quotient is rounded, moves a gap by 16 u
  // M more.
  double advance(const std::array<Vec3, 4>& now, const Vec3& way) const {
    const double length = way.norm();
    const double least = length * (r_ + 512 * kUnitRoundoff * (largest_ + r_));
    double from[4], to[4];
    for (std::size_t i = 0; i < 4; ++i) from[i] = now[i].dot(way), to[i] = end_[i].dot(way);
    double share = 1;
    for (std::size_t i = 0; i < Kind<Query>::split; ++i)
      for (std::size_t j = Kind<Query>::split; j < 4; ++j) {
        const double gap = from[i] - from[j], last = to[i] - to[j];
        if (last > least && gap > least) continue;
        share = gap > least ? std::min(share, (gap - least) / (gap - last)) : 0;
      }
    return share >= 0 ? share : 0;
  }

  // The case at the times within `error` of t.
  CloseCase<Moving> case_at(int number, double t, double error) const {
    const Doubles time{t, error};
    std::array<PointOf<Moving>, 4> points;
    for (std::size_t i = 0; i < 4; ++i)
      for (Eigen::Index k = 0; k < 3; ++k) {
        const double from = start_[i][k], to = end_[i][k];
        const Doubles start{from, kUnitRoundoff * std::abs(from)}, end{to, kUnitRoundoff * std::abs(to)};
        const Doubles change = end - start;
        points[i][static_cast<std::size_t>(k)] = {start + change * time, change};
      }
    const Doubles r{r_, 0};
    return Kind<Query>::close_case(number, points, Moving{r * r, {}});
  }
  std::array<PointOf<Pairs>, 4> pairs_at(double t) const {
    std::array<PointOf<Pairs>, 4> points;
    for (std::size_t i = 0; i < 4; ++i)
      for (Eigen::Index k = 0; k < 3; ++k) {
        const Pairs start{exact_sum(points_[i].start[k], -points_[3].start[k]), 0},
            end{exact_sum(points_[i].end[k], -points_[3].end[k]), 0};
        points[i][static_cast<std::size_t>(k)] = start + (end - start) * Pairs{{t, 0}, 0};
      }
    return points;
  }
  // The polynomial of the case at time t.
  Pairs beyond_at(int number, double t) const {
    const Pairs r{{r_, 0}, 0};
    return Kind<Query>::close_case(number, pairs_at(t), r * r).beyond;
  }

  // True if the nearest points are certainly those of the case, and the distance certainly falls.
  static bool falls(const CloseCase<Moving>& which) {
    if (which.beyond.slope.sign() >= 0 || (which.insides > 0 && which.whole.value.sign() <= 0)) return false;
    for (std::size_t i = 0; i < which.insides; ++i)
      if (which.inside[i].value.sign() <= 0) return false;
    for (std::size_t i = 0; i < which.elsewheres; ++i)
      if (which.elsewhere[i].value.sign() >= 0) return false;
    return true;
  }

  CloseResult close_in(double low, const Nearest& nearest) const {
    const double first = step_to_root(nearest.number, low);
    if (!(first > 0)) return {CloseResult::unclear};
    // The distance itself, and not its square, is nearly linear in time.
    const double distance = nearest.way.norm(), guess = first * 2 * distance / (distance + r_);
    const double high = std::min(1.0, low + 1.5 * std::max(guess, 0x1p-45)),
                 middle = low + 0.5 * (high - low);
    if (!falls(case_at(nearest.number, middle, 0.5 * (high - low) + 0x1p-52))) return {CloseResult::unclear};

    double t = std::min(low + guess, high);
    for (int i = 0; i < 6; ++i) {
      const double step = step_to_root(nearest.number, t);
      t = std::clamp(t + step, low, high);
      if (std::abs(step) < 0x1p-44) return time_near(nearest.number, t, low, high);
      if (t == high && high == 1 && case_at(nearest.number, 1, 0).beyond.value.sign() > 0)
        return {CloseResult::apart};
    }
    return {CloseResult::unclear};
  }

  // Newton's step for the polynomial of the case, without a promise.
  double step_to_root(int number, double t) const {
    std::array<PointOf<WithSlope<double>>, 4> points;
    for (std::size_t i = 0; i < 4; ++i)
      for (Eigen::Index k = 0; k < 3; ++k) {
        const double change = end_[i][k] - start_[i][k];
        points[i][static_cast<std::size_t>(k)] = {start_[i][k] + change * t, change};
      }
    const auto beyond = Kind<Query>::close_case(number, points, WithSlope<double>{r_ * r_, 0}).beyond;
    return -beyond.value / beyond.slope;
  }

  // The time at which the polynomial falls to zero, from its value at t and its slope nearby.
  CloseResult time_near(int number, double t, double low, double high) const {
    const Doubles slope = case_at(number, t, 0x1p-40).beyond.slope;
    const Pairs value = beyond_at(number, t);
    if (slope.sign() >= 0) return {CloseResult::unclear};
    const double least_slope = std::abs(slope.value) - slope.error;
    const double step = -value.value.high / slope.value;
    // The step leaves out the low part of the value, and its quotient is rounded.
    const double error =
        1.01 * ((std::abs(step) * slope.error + std::abs(value.value.low) + value.error) / least_slope +
                2 * kUnitRoundoff * std::abs(step));
    const Pair root = exact_sum(t, step);
    if (!(std::abs(step) + error < 0x1p-42 && root.high > low && std::abs(root.low) > error))
      return {CloseResult::unclear};
    const double time = root.low < 0 ? next_below_positive(root.high) : root.high;
    if (!(error < 0x1p-4 * (root.high - next_below_positive(root.high)))) return {CloseResult::unclear};
    if (time >= 1 && high == 1) return {CloseResult::apart};
    return time >= low && time < high ? CloseResult{CloseResult::close, time}
                                      : CloseResult{CloseResult::unclear};
  }

  // The case in which several pairs of features are nearest together, as in edges that stay parallel, or in
  // which the distance begins at r up to rounding. From `low` on, at which the features are nearly close, the
  // gap along the direction of their nearest points proves them apart, and the distance of two of their
  // points proves them close. Both differ from the distance by the square of what the direction and the
  // points are off, so pairs of doubles tell neighbouring times apart. An unclear result has the time up to
  // which the features are apart.
  CloseResult fall_along(double low, const Nearest& nearest) const {
    const PointOf<Pairs> direction = direction_at(low, nearest);
    const Vec3 way(direction[0].value.high, direction[1].value.high, direction[2].value.high);
    // The length of the direction, and r times that: one step of Newton's method from the rounded root.
    const Pair square = dot(direction, direction).value;
    const double root = std::sqrt(square.high);
    const Pair length = exact_sum(root, (square - exact_product(root, root)).high / (2 * root));
    const Pairs least = Pairs{length, 0x1p-95 * root} * Pairs{{r_, 0}, 0};

    // The least excess over r of the gaps between two points, and the first time at which it is zero.
    double first = 2;
    const auto apart_at = [&](double t) {
      const std::array<PointOf<Pairs>, 4> now = pairs_at(t);
      bool certain = true;
      for (std::size_t i = 0; i < Kind<Query>::split; ++i)
        for (std::size_t j = Kind<Query>::split; j < 4; ++j) {
          const Pairs excess = dot(now[i] - now[j], direction) - least;
          certain &= excess.sign() > 0;
          const Vec3 change = (end_[i] - start_[i]) - (end_[j] - start_[j]);
          const double fall = -change.dot(way);
          if (!(fall > 0)) continue;
          const Pair zero = exact_sum(t, excess.value.high / fall);
          first = std::min(first, zero.low < 0 ? next_below_positive(zero.high) : zero.high);
        }
      return certain;
    };
    if (!apart_at(low)) return {CloseResult::unclear, low};
    const double time = std::min(first, 1.0);
    if (!(time > low)) return {CloseResult::unclear, low};
    if (!apart_at(time)) {
      const double before = low + (1 - 0x1p-30) * (time - low);
      return {CloseResult::unclear, apart_at(before) ? before : low};
    }
    if (time == 1) return {CloseResult::apart};
    const PointOf<Pairs> last = way_at(std::nextafter(time, 2), nearest.number);
    const Pairs r{{r_, 0}, 0};
    const bool certain = (dot(last, last) - r * r).sign() < 0;
    return {certain ? CloseResult::close : CloseResult::unclear, time};
  }

  // A direction that leads to the first feature and is that of the nearest points in pairs of doubles. It
  // counts as exact, as any direction would be right.
  PointOf<Pairs> direction_at(double t, const Nearest& nearest) const {
    const std::array<PointOf<Pairs>, 4> now = pairs_at(t);
    PointOf<Pairs> direction;
    bool to_first = true;
    if (nearest.number == 0) {
      direction = exact::cross(now[1] - now[Kind<Query>::split == 1 ? 3 : 0], now[3] - now[2]);
      double along = 0;
      for (std::size_t k = 0; k < 3; ++k)
        along += direction[k].value.high * nearest.way[static_cast<Eigen::Index>(k)];
      to_first = along > 0;
    } else {
      direction = way_at(t, nearest.number);
      const auto [p, a, b] = vertex_and_edge<Query>(nearest.number);
      to_first = p < Kind<Query>::split;
      if (a != b) {  // at a right angle to the edge in pairs of doubles, too
        const PointOf<Pairs> edge = now[b] - now[a];
        const double off = dot(direction, edge).value.high / dot(edge, edge).value.high;
        for (std::size_t k = 0; k < 3; ++k) direction[k] = direction[k] - Pairs{{off, 0}, 0} * edge[k];
      }
    }
    for (Pairs& x : direction) x = {to_first ? x.value : -x.value, 0};
    return direction;
  }

  // The way between a point of one feature and a point of the other, up to its sign. They are the nearest
  // points of the case up to rounding.
  PointOf<Pairs> way_at(double t, int number) const {
    const std::array<PointOf<Pairs>, 4> now = pairs_at(t);
    const std::array<Vec3, 4> rounded = at(t);
    const auto moved = [&](PointOf<Pairs> x, double share, std::size_t from, std::size_t to) {
      for (std::size_t k = 0; k < 3; ++k) x[k] = x[k] + Pairs{{share, 0}, 0} * (now[to][k] - now[from][k]);
      return x;
    };
    if (number == 0) {
      const bool vertex = Kind<Query>::split == 1;
      const Vec3 u = rounded[1] - rounded[vertex ? 3 : 0], w = rounded[3] - rounded[2], n = u.cross(w);
      const double area = n.squaredNorm();
      if (vertex) {  // from the second corner, along the edges to the first and to the third
        const Vec3 up = rounded[0] - rounded[2], first = rounded[1] - rounded[2];
        const double s = std::clamp(n.dot(up.cross(w)) / area, 0.0, 1.0),
                     q = std::clamp(n.dot(first.cross(up)) / area, 0.0, (1 - s) * (1 - 2 * kUnitRoundoff));
        return now[0] - moved(moved(now[2], s, 2, 1), q, 2, 3);
      }
      const Vec3 across = rounded[2] - rounded[0];
      const double s = std::clamp(n.dot(across.cross(w)) / area, 0.0, 1.0),
                   q = std::clamp(n.dot(across.cross(u)) / area, 0.0, 1.0);
      return moved(now[0], s, 0, 1) - moved(now[2], q, 2, 3);
    }
    const auto [p, a, b] = vertex_and_edge<Query>(number);
    if (a == b) return now[p] - now[a];
    const Vec3 edge = rounded[b] - rounded[a];
    const double s = std::clamp((rounded[p] - rounded[a]).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    return now[p] - moved(now[a], s, a, b);
  }

  const std::array<MovingPoint, 4> points_;
  const double r_;
  std::array<Vec3, 4> start_, end_;  // seen from the last point
  double largest_ = 0;
};

}  // namespace

CloseResult close_in_doubles(const MovingVertexFace& query, double r, bool apart_at_start) {
  return Closeness<MovingVertexFace>(query, r).decide(apart_at_start);
}
CloseResult close_in_doubles(const MovingEdgeEdge& query, double r, bool apart_at_start) {
  return Closeness<MovingEdgeEdge>(query, r).decide(apart_at_start);
}
EndOfMotion end_of_motion(const MovingVertexFace& query, double r) {
  return Closeness<MovingVertexFace>(query, r).end_of_motion();
}
EndOfMotion end_of_motion(const MovingEdgeEdge& query, double r) {
  return Closeness<MovingEdgeEdge>(query, r).end_of_motion();
}
unsigned possible_cases(const MovingVertexFace& query, double r, double from) {
  return Closeness<MovingVertexFace>(query, r).possible_cases(from);
}
unsigned possible_cases(const MovingEdgeEdge& query, double r, double from) {
  return Closeness<MovingEdgeEdge>(query, r).possible_cases(from);
}

}  // namespace cscd
