#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "core/elementary/filter.h"

// The stage of `filtered_exact` in double precision: contact decided by certified signs, or not at all.
//
// The roots of the coplanarity cubic are enclosed between doubles by certain signs; at each, over its whole
// enclosure, it is told where the features would touch by the sides of integer_contact.cpp: combinations of
// components of n = p x q, g = p x r and h = r x q along an axis. Two with certain opposite signs all through
// an interval prove "apart" there; all with one certain sign prove "contact" at any root in it. After the
// idea of Bernstein sign classification (Tang, Tong, Wang and Manocha, TOG 2014); what differs: every sign
// has a forward error bound, and what is not certain is left to exact arithmetic instead of being decided.
namespace cscd {

// What both kinds of query are made of; points are coplanar where (p x q) . r = 0.
struct Triple {
  MovingVector p, q, r;
};
inline Triple triple(const MovingVertexFace& v) {
  return {difference(v.corner[0], v.corner[1]), difference(v.corner[0], v.corner[2]),
          difference(v.corner[0], v.vertex)};
}
inline Triple triple(const MovingEdgeEdge& e) {
  return {difference(e.first[0], e.first[1]), difference(e.second[0], e.second[1]),
          difference(e.first[0], e.second[0])};
}

enum class Place { outside, inside, unclear };

// A component of a product of two moving vectors over an interval: Bernstein coefficients, and how far each
// may be off.
struct Component {
  double b[3];
  double error;
};

// One vector component is off by at most 4 u L: a difference, and two products and a sum between the ends of
// the interval; L is the largest component at t = 0 and 1. A coefficient has two products of two of those,
// (2 * 2 * 4 + 2) u L L', and a difference of them, 2 u L L'; the middle one is half of twice as much, and
// one more sum: 22 u L L' altogether. Sides add up to three of these, at most 4 u more for each. 28 also pays
// for terms in u^2 and the bound's own roundings. What underflows is less than the last term.
struct ProvenBounds {
  static constexpr double component = 28 * kUnitRoundoff, cubic = 1;  // the latter in units of the proven one
};
inline constexpr double kUnderflow = 1e-300;

template <class Bounds>
Component component(const MovingVector& x, const MovingVector& y, int k, double size) {
  const int i = k == 2 ? 0 : k + 1, j = k == 0 ? 2 : k - 1;
  const auto wedge = [i, j](const Vec3& a, const Vec3& b) { return a[i] * b[j] - a[j] * b[i]; };
  return {
      {wedge(x.start, y.start), 0.5 * (wedge(x.start, y.end) + wedge(x.end, y.start)), wedge(x.end, y.end)},
      Bounds::component * size + kUnderflow};
}
inline Component operator+(const Component& x, const Component& y) {
  return {{x.b[0] + y.b[0], x.b[1] + y.b[1], x.b[2] + y.b[2]}, x.error + y.error};
}
inline Component operator-(const Component& x, const Component& y) {
  return {{x.b[0] - y.b[0], x.b[1] - y.b[1], x.b[2] - y.b[2]}, x.error + y.error};
}
inline Component operator-(const Component& x) {
  return {{-x.b[0], -x.b[1], -x.b[2]}, x.error};
}

// The signs that sides certainly have all through an interval.
struct SideSigns {
  bool some_positive = false, some_negative = false, all_positive = true, all_negative = true;
  void add(const Component& side) {
    const double e = side.error;
    const bool positive = (side.b[0] > e) & (side.b[1] > e) & (side.b[2] > e);
    const bool negative = (side.b[0] < -e) & (side.b[1] < -e) & (side.b[2] < -e);
    some_positive |= positive;
    some_negative |= negative;
    all_positive &= positive;
    all_negative &= negative;
  }
  Place place() const {
    if (some_positive && some_negative) return Place::outside;
    return all_positive || all_negative ? Place::inside : Place::unclear;
  }
};

template <class Query>
constexpr bool kIsVertexFace = std::is_same_v<Query, MovingVertexFace>;

struct Sizes {
  double p, q, r;
};

// Seen along axis k, over the interval at whose ends the vectors are given.
template <class Query, class Bounds>
Place place_along(const Triple& v, const Sizes& size, int k) {
  const Component n = component<Bounds>(v.p, v.q, k, size.p * size.q),
                  g = component<Bounds>(v.p, v.r, k, size.p * size.r),
                  h = component<Bounds>(v.r, v.q, k, size.r * size.q);
  SideSigns signs;
  if (kIsVertexFace<Query>) {
    signs.add(g);
    signs.add(h);
    signs.add(n - g - h);
  } else {
    signs.add(-g);
    signs.add(n + g);
    signs.add(h);
    signs.add(n - h);
  }
  return signs.place();
}

inline MovingVector between(const MovingVector& x, double low, double high) {
  return {(1 - low) * x.start + low * x.end, (1 - high) * x.start + high * x.end};
}

template <class Query, class Bounds>
Place place_between(const Triple& v, const Sizes& size, double low, double high) {
  const Triple part{between(v.p, low, high), between(v.q, low, high), between(v.r, low, high)};
  // Along the axis that shows most of the plane first; the others may only tell in wide intervals.
  int axis = 0;
  part.p.start.cross(part.q.start).cwiseAbs().maxCoeff(&axis);
  const Place place = place_along<Query, Bounds>(part, size, axis);
  if (place != Place::unclear || high - low < 0x1p-20) return place;
  for (const int other : {axis == 2 ? 0 : axis + 1, axis == 0 ? 2 : axis - 1})
    if (place_along<Query, Bounds>(part, size, other) == Place::outside) return Place::outside;
  return Place::unclear;
}

// The coplanarity cubic with one bound for all that is computed from it: 10 u times the largest coefficient
// pays for `at` and for control points of a part of the interval (three levels of (1 - t) x + t y, each off
// by 3 u).
struct Cubic {
  BernsteinCubic f;
  double error;

  Cubic(const BernsteinCubic& cubic, double scale)
      : f(cubic),
        error(scale * cubic.error + scale * 10 * kUnitRoundoff *
                                        std::max(std::max(std::abs(cubic.c[0]), std::abs(cubic.c[1])),
                                                 std::max(std::abs(cubic.c[2]), std::abs(cubic.c[3])))) {}
  int sign(double value) const { return (value > error) - (value < -error); }
  double at(double t) const { return f.at(t); }
  double slope(double t) const {
    const double s = 1 - t;
    return 3 * (s * s * (f.c[1] - f.c[0]) + 2 * s * t * (f.c[2] - f.c[1]) + t * t * (f.c[3] - f.c[2]));
  }
};

enum class Roots { none, one, unclear };

// By Descartes' rule for the signs of control points that are certain, whatever the others are.
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
inline Roots count_roots(const Cubic& f, double low, double high) {
  const auto polar = [&](double r, double s, double t) {
    const double a = mix(f.f.c[0], f.f.c[1], r), b = mix(f.f.c[1], f.f.c[2], r),
                 c = mix(f.f.c[2], f.f.c[3], r);
    return mix(mix(a, b, s), mix(b, c, s), t);
  };
  return count_roots(
      f, {polar(low, low, low), polar(low, low, high), polar(low, high, high), polar(high, high, high)});
}

// A part of [0, 1] that holds roots: exactly one, with certain opposite signs at both ends, or who knows.
struct Part {
  double low, high;
  bool one_root;
};
struct Parts {
  static constexpr int kMost = 8;
  Part at[kMost];
  int count = 0;
  void add(double low, double high, Roots roots) {
    if (roots != Roots::none) at[count++] = {low, high, roots == Roots::one};
  }
};

// In ascending order; the cubic has no root elsewhere in [0, 1]. Cut near the critical points and near ends
// that may be roots. Where a sign is not certain there, a narrow part round it is cut out. Any cuts give
// right parts.
inline Parts parts_with_roots(const Cubic& f) {
  const double(&c)[4] = f.f.c;
  Parts parts;
  const Roots whole = count_roots(f, c);
  if (whole != Roots::unclear) {
    parts.add(0, 1, whole);
    return parts;
  }
  double cut[Parts::kMost + 1] = {0};
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
      // f is near f(t) + 3 (a t + b) (s - t)^2 there.
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

// Narrows a part with one root to about the error bound.
inline void narrow(const Cubic& f, Part& part) {
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

// What double precision can prove.
struct DoublesResult {
  enum Kind { apart, contact, unclear } kind;
  // Of a contact: the earliest is at the only root of the cubic between these, with opposite signs there.
  double low = 0, high = 0;
};

// `cubic` is the coplanarity cubic with a finite error.
template <class Query, class Bounds = ProvenBounds>
DoublesResult decide_in_doubles(const Triple& v, const BernsteinCubic& cubic) {
  const Sizes size{v.p.largest(), v.q.largest(), v.r.largest()};
  for (int k = 0; k < 3; ++k)
    if (place_along<Query, Bounds>(v, size, k) == Place::outside) return {DoublesResult::apart};
  const Cubic f(cubic, Bounds::cubic);
  Parts parts = parts_with_roots(f);
  for (int i = 0; i < parts.count; ++i) {
    Part& part = parts.at[i];
    if (part.one_root) narrow(f, part);
    const Place place = place_between<Query, Bounds>(v, size, part.low, part.high);
    if (place == Place::outside) continue;
    if (place == Place::unclear || !part.one_root) return {DoublesResult::unclear};
    return {DoublesResult::contact, part.low, part.high};
  }
  return {DoublesResult::apart};
}

}  // namespace cscd
