#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/elementary/certified/sides.h"
#include "core/elementary/question/filter.h"

// The stage of `filtered_exact` in double precision. It decides a contact by certified signs (rule
// certain-sign, core/soundness.md), or leaves the query to exact arithmetic.
//
// The stage encloses each root of the coplanarity cubic between two doubles by certain signs. For the whole
// enclosure it then tells whether the features are certainly apart or certainly touch where they are in one
// plane (sides.h).
namespace cscd {

// Both kinds of query are made of vectors p, q and r between points; the first and the last begin at the same
// point. The points of a query are coplanar where (p x q) . r = 0.
template <class Point>
struct TriplePoints {
  Point from, p_to, q_from, q_to, r_to;
};
inline TriplePoints<MovingPoint> triple_points(const MovingVertexFace& v) {
  return {v.corner[0], v.corner[1], v.corner[0], v.corner[2], v.vertex};
}
inline TriplePoints<MovingPoint> triple_points(const MovingEdgeEdge& e) {
  return {e.first[0], e.first[1], e.second[0], e.second[1], e.second[0]};
}
struct Triple {
  MovingVector p, q, r;

  Sizes<double> sizes() const { return {p.largest(), q.largest(), r.largest()}; }
};
inline Triple triple(const TriplePoints<MovingPoint>& v) {
  return {difference(v.from, v.p_to), difference(v.q_from, v.q_to), difference(v.from, v.r_to)};
}

// The vector seen along axis k.
inline SeenAlong<double> along(const MovingVector& v, int k) {
  const int i = k == 2 ? 0 : k + 1, j = k == 0 ? 2 : k - 1;
  return {{{v.start[i], v.start[j]}, {v.end[i], v.end[j]}}};
}
// Decides over the interval at whose ends the vectors are given.
template <class Query, class Bounds>
Place<double> place_along(const Triple& v, const Sizes<double>& size, int k) {
  return place_along<Query, Bounds>(along(v.p, k), along(v.q, k), along(v.r, k), size);
}

// The part of a moving vector between two times, as a vector that moves over [0, 1].
inline MovingVector between(const MovingVector& x, double low, double high) {
  return {(1 - low) * x.start + low * x.end, (1 - high) * x.start + high * x.end};
}

// The place of the features between the times `low` and `high`.
template <class Query, class Bounds>
Place<double> place_between(const Triple& v, const Sizes<double>& size, double low, double high) {
  const Triple part{between(v.p, low, high), between(v.q, low, high), between(v.r, low, high)};
  // The axis that shows most of the plane is asked first; the others may only tell in wide intervals.
  int axis = 0;
  part.p.start.cross(part.q.start).cwiseAbs().maxCoeff(&axis);
  const Place<double> place = place_along<Query, Bounds>(part, size, axis);
  if (place.outside || place.inside || high - low < 0x1p-20) return place;
  for (const int other : {axis == 2 ? 0 : axis + 1, axis == 0 ? 2 : axis - 1})
    if (place_along<Query, Bounds>(part, size, other).outside) return {.outside = true, .inside = false};
  return place;
}

// The coplanarity cubic with one error bound for everything that is computed from it. Besides the error of
// the coefficients, 10 u times the largest coefficient pays for `at` and for the control points of a part of
// the interval (three levels of (1 - t) x + t y, each off by 3 u).
template <class Real>
struct CubicOf {
  BernsteinCubicOf<Real> f;
  Real error;

  CubicOf(const BernsteinCubicOf<Real>& cubic, double scale)
      : f(cubic),
        error(scale * cubic.error + scale * 10 * kUnitRoundoff *
                                        larger(larger(absolute(cubic.c[0]), absolute(cubic.c[1])),
                                               larger(absolute(cubic.c[2]), absolute(cubic.c[3])))) {}
  int sign(Real value) const { return (value > error) - (value < -error); }
  Real at(Real t) const { return f.at(t); }
  Real slope(Real t) const {
    const Real s = 1 - t;
    return 3 * (s * s * (f.c[1] - f.c[0]) + 2 * s * t * (f.c[2] - f.c[1]) + t * t * (f.c[3] - f.c[2]));
  }
};

using Cubic = CubicOf<double>;

enum class Roots { none, one, unclear };

// Counts roots by Descartes' rule for the signs of those control points that are certain, whatever the others
// are.
inline Roots count_roots(const Cubic& f, const double (&control)[4]) {
  const int s0 = f.sign(control[0]), s1 = f.sign(control[1]), s2 = f.sign(control[2]),
            s3 = f.sign(control[3]);
  if (s0 != 0 && s1 == s0 && s2 == s0 && s3 == s0) return Roots::none;
  if (s0 * s3 < 0 && !(s1 * s0 <= 0 && s2 * s0 >= 0)) return Roots::one;
  return Roots::unclear;
}

inline double mix(double x, double y, double t) {
  return (1 - t) * x + t * y;
}
// Counts the roots between `low` and `high`.
inline Roots count_roots(const Cubic& f, double low, double high) {
  const auto polar = [&](double r, double s, double t) {
    const double a = mix(f.f.c[0], f.f.c[1], r), b = mix(f.f.c[1], f.f.c[2], r),
                 c = mix(f.f.c[2], f.f.c[3], r);
    return mix(mix(a, b, s), mix(b, c, s), t);
  };
  return count_roots(
      f, {polar(low, low, low), polar(low, low, high), polar(low, high, high), polar(high, high, high)});
}

// A part of [0, 1] that holds roots: exactly one, with certain opposite signs at both ends, or an unknown
// number.
struct RootInterval {
  double low, high;
  bool one_root;
};
struct RootIntervals {
  static constexpr int kMost = 8;
  RootInterval at[kMost];
  int count = 0;
  void add(double low, double high, Roots roots) {
    if (roots != Roots::none) at[count++] = {low, high, roots == Roots::one};
  }
};

// Returns the parts of [0, 1] that may hold roots, in ascending order; the cubic has no root elsewhere in
// [0, 1]. The interval is cut near the critical points of the cubic and near ends that may be roots. If the
// sign of the cubic at a critical point is uncertain, a narrow part round that point is cut out. The parts
// are right for any choice of cuts.
inline RootIntervals root_intervals(const Cubic& f) {
  const double(&c)[4] = f.f.c;
  RootIntervals parts;
  const Roots whole = count_roots(f, c);
  if (whole != Roots::unclear) {
    parts.add(0, 1, whole);
    return parts;
  }
  double cut[RootIntervals::kMost + 1] = {0};
  int cuts = 1;
  const auto add_cut = [&](double t) {
    if (t > cut[cuts - 1] && t < 1) cut[cuts++] = t;
  };
  const double d0 = c[1] - c[0], d1 = c[2] - c[1], d2 = c[3] - c[2];
  if (f.sign(c[0]) == 0) add_cut(2 * f.error / std::abs(d0));
  // f' / 3 = a t^2 + 2 b t + d0.
  const double a = d0 - 2 * d1 + d2, b = d1 - d0;
  const double root = std::sqrt(std::max(0.0, b * b - a * d0)), q = -(b + std::copysign(root, b));
  double critical[2] = {q / a, d0 / q};
  if (critical[1] < critical[0]) std::swap(critical[0], critical[1]);
  for (const double t : critical) {
    if (!(t > 0 && t < 1)) continue;
    if (f.sign(f.at(t)) != 0) {
      add_cut(t);
    } else {
      // Near t, f(s) is about f(t) + 3 (a t + b) (s - t)^2.
      const double reach = 1.5 * std::sqrt(f.error / std::abs(a * t + b));
      add_cut(t - reach);
      add_cut(t + reach);
    }
  }
  if (f.sign(c[3]) == 0) add_cut(1 - 2 * f.error / std::abs(d2));
  cut[cuts] = 1;
  for (int i = 0; i < cuts; ++i) parts.add(cut[i], cut[i + 1], count_roots(f, cut[i], cut[i + 1]));
  return parts;
}

// Narrows a part with one root until the cubic at its ends is about as small as the error bound.
inline void narrow(const Cubic& f, RootInterval& part) {
  const double at_low = f.at(part.low), at_high = f.at(part.high);
  const bool falls = at_low > 0;
  double t = part.low + (part.high - part.low) * (at_low / (at_low - at_high));
  double value = 0, slope = 0;
  for (int step = 0; step < 20; ++step) {
    if (!(t > part.low && t < part.high)) t = 0.5 * (part.low + part.high);
    value = f.at(t);
    slope = f.slope(t);
    const int sign = f.sign(value);
    if (sign == 0) break;
    ((sign > 0) == falls ? part.low : part.high) = t;
    if (std::abs(value) <= 4 * f.error) break;
    t -= value / slope;
  }
  double reach = 2 * (std::abs(value) + f.error) / std::abs(slope) + 0x1p-52;
  for (int widened = 0; widened < 3; ++widened, reach *= 8) {
    const double low = t - reach, high = t + reach;
    if (low > part.low && (f.at(low) > 0) == falls && f.sign(f.at(low)) != 0) part.low = low;
    if (high < part.high && (f.at(high) < 0) == falls && f.sign(f.at(high)) != 0) part.high = high;
    if (part.high - part.low <= 2.5 * reach) return;
  }
}

// What double precision can prove about a query.
struct DoublesResult {
  enum Kind { apart, contact, unclear } kind;
  // For a contact: the earliest one is at the only root of the cubic between these two times, at which the
  // cubic has opposite signs.
  double low = 0, high = 0;
};

// Decides one query. `cubic` is the query's coplanarity cubic, with a finite error. `Bounds` holds the error
// bounds; tests pass other bounds than the proven ones (ProvenBounds, sides.h) to show that each is needed.
template <class Query, class Bounds = ProvenBounds>
DoublesResult decide_in_doubles(const Triple& v, const BernsteinCubic& cubic) {
  const Sizes<double> size = v.sizes();
  for (int k = 0; k < 3; ++k)
    if (place_along<Query, Bounds>(v, size, k).outside) return {DoublesResult::apart};
  const Cubic f(cubic, Bounds::cubic);
  RootIntervals parts = root_intervals(f);
  for (int i = 0; i < parts.count; ++i) {
    RootInterval& part = parts.at[i];
    if (part.one_root) narrow(f, part);
    const Place<double> place = place_between<Query, Bounds>(v, size, part.low, part.high);
    if (place.outside) continue;
    if (!place.inside || !part.one_root) return {DoublesResult::unclear};
    return {DoublesResult::contact, part.low, part.high};
  }
  return {DoublesResult::apart};
}

}  // namespace cscd
