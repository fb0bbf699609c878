#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

// Interval arithmetic that rounds outward.
namespace cscd::scenes {

// Thrown where a formula has no bound: a division by an interval that holds zero, or numbers that overflow.
struct Unbounded {};

// All numbers from `low` to `high`. An operation returns an interval that holds every result for numbers of
// its operands. Each end is rounded to nearest, which is off by half a unit in the last place at most, and
// then moved outward by at least one.
struct Interval {
  double low = 0, high = 0;

  constexpr Interval() = default;
  constexpr Interval(double x) : low(x), high(x) {}  // implicit: formulas mix numbers and intervals
  constexpr Interval(double l, double h) : low(l), high(h) {}

  double middle() const { return low + (high - low) / 2; }
  double width() const { return high - low; }
  bool holds(double x) const { return low <= x && x <= high; }
  // The largest absolute value of any number of the interval.
  double magnitude() const { return std::max(-low, high); }
  bool is_zero() const { return low == 0 && high == 0; }
  bool is_one() const { return low == 1 && high == 1; }
};

inline double rounded_down(double x) {
  return x - std::abs(x) * 0x1p-52 - std::numeric_limits<double>::denorm_min();
}
inline double rounded_up(double x) {
  return x + std::abs(x) * 0x1p-52 + std::numeric_limits<double>::denorm_min();
}
inline Interval outward(double low, double high) {
  if (!std::isfinite(high - low)) throw Unbounded();
  return {rounded_down(low), rounded_up(high)};
}

inline Interval hull(const Interval& a, const Interval& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}
inline Interval operator-(const Interval& a) {
  return {-a.high, -a.low};
}
inline Interval operator+(const Interval& a, const Interval& b) {
  if (a.is_zero()) return b;
  if (b.is_zero()) return a;
  return outward(a.low + b.low, a.high + b.high);
}
inline Interval operator-(const Interval& a, const Interval& b) {
  return a + -b;
}
inline Interval operator*(const Interval& a, const Interval& b) {
  if (a.is_zero() || b.is_zero()) return {};
  const double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
  if (!std::isfinite(p + q + r + s)) throw Unbounded();
  return outward(std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s)));
}
inline Interval square(const Interval& a) {
  const double p = a.low * a.low, q = a.high * a.high;
  return outward(a.holds(0) ? 0 : std::min(p, q), std::max(p, q));
}
inline Interval reciprocal(const Interval& a) {
  if (!(a.low > 0 || a.high < 0)) throw Unbounded();
  return outward(1 / a.high, 1 / a.low);
}
inline Interval operator/(const Interval& a, const Interval& b) {
  return a * reciprocal(b);
}
// The square root, of what of an interval is not negative.
inline Interval square_root(const Interval& a) {
  return outward(std::sqrt(std::max(0.0, a.low)), std::sqrt(std::max(0.0, a.high)));
}

// glibc's sine, cosine and arcsine are off by less than one unit in the last place of the result; we grant
// four.
inline Interval from_library(double low, double high) {
  constexpr double kSlack = 4 * 0x1p-52;
  return outward(low - kSlack * std::abs(low), high + kSlack * std::abs(high));
}
inline Interval sine(const Interval& a) {
  constexpr double kHalfTurn = std::numbers::pi, kTurn = 2 * kHalfTurn;
  if (!(a.magnitude() < 1e6)) return {-1, 1};
  // Between a lowest and a highest point sine is monotone. The extremes at turns/4 + k turns are looked for
  // in a slightly larger interval, which pays for the rounding of k turns.
  const auto passes = [&](double extreme) {
    return std::floor((a.high - extreme) / kTurn + 1e-9) > std::floor((a.low - extreme) / kTurn - 1e-9);
  };
  const double p = std::sin(a.low), q = std::sin(a.high);
  Interval out = from_library(std::min(p, q), std::max(p, q));
  if (passes(kHalfTurn / 2)) out.high = 1;
  if (passes(-kHalfTurn / 2)) out.low = -1;
  return {std::max(out.low, -1.0), std::min(out.high, 1.0)};
}
inline Interval cosine(const Interval& a) {
  return sine(a + Interval(rounded_down(std::numbers::pi / 2), rounded_up(std::numbers::pi / 2)));
}
// The arcsine of an interval in [0, 1].
inline Interval arcsine(const Interval& a) {
  return from_library(std::asin(std::clamp(a.low, 0.0, 1.0)), std::asin(std::clamp(a.high, 0.0, 1.0)));
}
// sin(x) / x for x in [0, 2], which falls from 1.
inline Interval sinc(const Interval& a) {
  const auto at = [](double x) { return x < 1e-4 ? 1 - x * x / 6 : std::sin(x) / x; };
  // For small x the series is off by less than x^4 / 120 < 1e-18.
  const Interval out = from_library(at(std::max(0.0, a.high)), at(std::max(0.0, a.low)));
  return {out.low, std::min(out.high, 1.0)};
}

}  // namespace cscd::scenes
