#pragma once

#include <array>

#include "scenes/motion/interval.h"

// Functions of time, enclosed over a span of time.
namespace cscd::scenes {

// Encloses a function over a span of time: `value`, `rate` and `bend` hold the values of the function, of its
// first and of its second derivative at every time of the span at which it has them. A formula of jets
// encloses the formula of the functions, by the rules of sums, products and quotients.
struct Jet {
  Interval value, rate, bend;

  Jet() = default;
  Jet(double x) : value(x) {}  // a constant
  Jet(const Interval& v) : value(v) {}
  Jet(const Interval& v, const Interval& r, const Interval& b) : value(v), rate(r), bend(b) {}

  bool is_still() const { return rate.is_zero() && bend.is_zero(); }
};

inline Jet hull(const Jet& a, const Jet& b) {
  return {hull(a.value, b.value), hull(a.rate, b.rate), hull(a.bend, b.bend)};
}
inline Jet operator-(const Jet& a) {
  return {-a.value, -a.rate, -a.bend};
}
inline Jet operator+(const Jet& a, const Jet& b) {
  return {a.value + b.value, a.rate + b.rate, a.bend + b.bend};
}
inline Jet operator-(const Jet& a, const Jet& b) {
  return {a.value - b.value, a.rate - b.rate, a.bend - b.bend};
}
inline Jet operator*(const Jet& a, const Jet& b) {
  if (a.is_still()) return {a.value * b.value, a.value * b.rate, a.value * b.bend};
  if (b.is_still()) return {a.value * b.value, a.rate * b.value, a.bend * b.value};
  return {a.value * b.value, a.rate * b.value + a.value * b.rate,
          a.bend * b.value + 2 * (a.rate * b.rate) + a.value * b.bend};
}
inline Jet square(const Jet& a) {
  return {square(a.value), 2 * (a.value * a.rate), 2 * (square(a.rate) + a.value * a.bend)};
}
inline Jet reciprocal(const Jet& a) {
  const Interval r = reciprocal(a.value), r2 = square(r);
  return {r, -(a.rate * r2), (2 * (square(a.rate) * r) - a.bend) * r2};
}
inline Jet operator/(const Jet& a, const Jet& b) {
  return a * reciprocal(b);
}
inline Jet square_root(const Jet& a) {
  const Interval root = square_root(a.value), half = reciprocal(2 * root);
  return {root, a.rate * half, (a.bend - 2 * square(a.rate * half)) * half};
}
inline Jet sine(const Jet& a) {
  const Interval s = sine(a.value), c = cosine(a.value);
  return {s, c * a.rate, c * a.bend - s * square(a.rate)};
}
inline Jet cosine(const Jet& a) {
  const Interval s = sine(a.value), c = cosine(a.value);
  return {c, -(s * a.rate), -(s * a.bend) - c * square(a.rate)};
}

using JetVector = std::array<Jet, 3>;

template <class Each>
std::array<Each, 3> hull(const std::array<Each, 3>& a, const std::array<Each, 3>& b) {
  return {hull(a[0], b[0]), hull(a[1], b[1]), hull(a[2], b[2])};
}
inline JetVector operator+(const JetVector& a, const JetVector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline JetVector operator-(const JetVector& a, const JetVector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline JetVector operator*(const Jet& s, const JetVector& a) {
  return {s * a[0], s * a[1], s * a[2]};
}
inline Jet dot(const JetVector& a, const JetVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline JetVector cross(const JetVector& a, const JetVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Jet norm(const JetVector& a) {
  return square_root(square(a[0]) + square(a[1]) + square(a[2]));
}

}  // namespace cscd::scenes
