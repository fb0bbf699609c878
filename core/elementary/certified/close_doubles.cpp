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
// Where several pairs of features are nearest together, gaps and distances of points tell neighbouring times
// apart in pairs of doubles (fall_along).
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

  CloseResult decide() {
    double low = 0, tried = 0x1p-3;
    for (int step = 0; step < kMostSteps; ++step) {
      const std::array<Vec3, 4> now = at(low);
      const Nearest nearest = Kind<Query>::nearest(now);
      if (low == 0) {
        const DistanceBounds distance = distance_bounds(now, Kind<Query>::split, nearest.way);
        if (distance.high <= r_) return {CloseResult::close, 0};
        // In this range no product underflows or overflows so far that it matters.
        const bool in_range = largest_ > 0x1p-64 && largest_ < 0x1p64 && r_ > 0x1p-128 && r_ < 0x1p64;
        if (distance.low <= r_ || !in_range) return {CloseResult::unclear};
      }
      const double gain = advance(now, nearest.way) * (1 - low);
      if (low + gain >= 1) return {CloseResult::apart};
      if (gain < tried) {
        const CloseResult closed_in = close_in(low, nearest);
        if (closed_in.kind != CloseResult::unclear) return closed_in;
        if (gain < 0x1p-40) return fall_along(low, nearest);
        tried = gain / 4;
      }
      low += gain;
    }
    return {CloseResult::unclear};
  }

 private:
  static constexpr int kMostSteps = 200;

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

  // The case in which several pairs of features are nearest together, as in edges that stay parallel. From
  // `low` on, at which the features are nearly close, the gap along the direction of their nearest points
  // proves them apart, and the distance of two of their points proves them close. Both differ from the
  // distance by the square of what the direction and the points are off, so pairs of doubles tell
  // neighbouring times apart.
  CloseResult fall_along(double low, const Nearest& nearest) const {
    if (nearest.number == 0) return {CloseResult::unclear};
    PointOf<Pairs> direction = way_at(low, nearest.number);
    const auto [p, a, b] = vertex_and_edge<Query>(nearest.number);
    if (a != b) {  // at a right angle to the edge in pairs of doubles, too
      const std::array<PointOf<Pairs>, 4> now = pairs_at(low);
      const PointOf<Pairs> edge = now[b] - now[a];
      const double off = dot(direction, edge).value.high / dot(edge, edge).value.high;
      for (std::size_t k = 0; k < 3; ++k) direction[k] = direction[k] - Pairs{{off, 0}, 0} * edge[k];
    }
    // It may be any direction, and leads to the first feature.
    for (Pairs& x : direction) x = {p < Kind<Query>::split ? x.value : -x.value, 0};
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
    if (!apart_at(low)) return {CloseResult::unclear};
    const double time = std::min(first, 1.0);
    if (!(time > low) || !apart_at(time)) return {CloseResult::unclear};
    if (time == 1) return {CloseResult::apart};
    const PointOf<Pairs> last = way_at(std::nextafter(time, 2), nearest.number);
    const Pairs r{{r_, 0}, 0};
    const bool certain = (dot(last, last) - r * r).sign() < 0;
    return certain ? CloseResult{CloseResult::close, time} : CloseResult{CloseResult::unclear};
  }

  // The way from a point of the edge of the case to its vertex, or from the one vertex to the other. The
  // point is the nearest up to rounding.
  PointOf<Pairs> way_at(double t, int number) const {
    const auto [p, a, b] = vertex_and_edge<Query>(number);
    const std::array<PointOf<Pairs>, 4> now = pairs_at(t);
    PointOf<Pairs> way = now[p] - now[a];
    if (a == b) return way;
    const std::array<Vec3, 4> rounded = at(t);
    const Vec3 edge = rounded[b] - rounded[a];
    const double s = std::clamp((rounded[p] - rounded[a]).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    for (std::size_t k = 0; k < 3; ++k) way[k] = way[k] - Pairs{{s, 0}, 0} * (now[b][k] - now[a][k]);
    return way;
  }

  const std::array<MovingPoint, 4> points_;
  const double r_;
  std::array<Vec3, 4> start_, end_;  // seen from the last point
  double largest_ = 0;
};

}  // namespace

CloseResult close_in_doubles(const MovingVertexFace& query, double r) {
  return Closeness<MovingVertexFace>(query, r).decide();
}
CloseResult close_in_doubles(const MovingEdgeEdge& query, double r) {
  return Closeness<MovingEdgeEdge>(query, r).decide();
}

}  // namespace cscd
