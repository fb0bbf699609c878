#pragma once

#include <bit>
#include <cstdint>

#include "core/elementary/certified/doubles_stage.h"
#include "core/geometry/triple_product_lanes.h"

// Computes the time of a contact that the stage in double precision has proved, in twice that precision.
//
// The time is a root of the coplanarity cubic f. For a double t near the root, the root is t + d with
// d = -f(t) / f'(x), for some x between t and the root. f(t) is evaluated in pairs of doubles (error-free
// sums and products; Dekker 1971, Knuth), and f' is bounded in doubles. This makes the largest double not
// above the root certain, unless the root is within some 2^-90 of a double.
//
// The code is written once for a single query and for eight queries side by side, as in sides.h.
namespace cscd {

// A number as the unevaluated sum of two doubles, the second at most half an ulp of the first.
template <class Real>
struct PairOf {
  Real high, low;
};
using Pair = PairOf<double>;

// `exact_sum` and `exact_product` are exact: the pair is the sum or the product of the two numbers.
template <class Real>
PairOf<Real> exact_sum(Real a, Real b) {
  const Real sum = a + b, b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}
// exact_sum for |large| >= |small|, in fewer operations.
template <class Real>
PairOf<Real> exact_sum_of_ordered(Real large, Real small) {
  const Real sum = large + small;
  return {sum, small - (sum - large)};
}
template <class Real>
PairOf<Real> exact_product(Real a, Real b) {
  const Real product = a * b;
#ifdef __FMA__
  return {product, rounded_once(a, b, -product)};
#else  // the same result from Dekker's halves of a and b
  constexpr double kSplit = 0x1p27 + 1;
  const Real a_wide = kSplit * a, a_high = a_wide - (a_wide - a), a_low = a - a_high;
  const Real b_wide = kSplit * b, b_high = b_wide - (b_wide - b), b_low = b - b_high;
  return {product, a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low)};
#endif
}
// The sum is off by less than 2^-103 (|a| + |b|).
template <class Real>
PairOf<Real> operator+(const PairOf<Real>& a, const PairOf<Real>& b) {
  const PairOf<Real> high = exact_sum(a.high, b.high);
  return exact_sum_of_ordered<Real>(high.high, high.low + (a.low + b.low));
}
template <class Real>
PairOf<Real> operator-(const PairOf<Real>& a) {
  return {-a.high, -a.low};
}
template <class Real>
PairOf<Real> operator-(const PairOf<Real>& a, const PairOf<Real>& b) {
  return a + -b;
}
// The product is off by less than 2^-103 |a b|.
template <class Real>
PairOf<Real> operator*(const PairOf<Real>& a, const PairOf<Real>& b) {
  const PairOf<Real> high = exact_product(a.high, b.high);
  return exact_sum_of_ordered<Real>(high.high, high.low + (a.high * b.low + a.low * b.high));
}

// The coordinate of a moving point along an axis, at t = `end`, which is 0 or 1.
inline double coordinate(const MovingPoint& p, int end, int axis) {
  return (end == 0 ? p.start : p.end)[axis];
}
inline Lane8 coordinate(const VectorLanes& p, int end, int axis) {
  return p.at[end][axis];
}

template <class Real>
struct VectorOfPairs {
  PairOf<Real> x[3];
};
// Returns the difference of two moving points at time t, off by less than 2^-100 times its largest component
// at 0 and 1.
template <class Real, class Point>
VectorOfPairs<Real> difference_at(const Point& from, const Point& to, Real t) {
  VectorOfPairs<Real> d;
  for (int k = 0; k < 3; ++k) {
    const auto at = [&](int end) {
      return exact_sum<Real>(coordinate(to, end, k), -coordinate(from, end, k));
    };
    const PairOf<Real> start = at(0), change = at(1) - start;
    d.x[k] = start + change * PairOf<Real>{t, {}};
  }
  return d;
}
// (p x q) . r. The result is off by less than 2^-95 times the product of the largest components of p, q and r
// at t = 0 and t = 1: it sums 6 products of three factors, each factor is off by a relative 2^-100, and five
// operations round.
template <class Real>
PairOf<Real> triple_product(const VectorOfPairs<Real>& p, const VectorOfPairs<Real>& q,
                            const VectorOfPairs<Real>& r) {
  const auto wedge = [&](int i, int j) { return p.x[i] * q.x[j] - p.x[j] * q.x[i]; };
  return wedge(1, 2) * r.x[0] + wedge(2, 0) * r.x[1] + wedge(0, 1) * r.x[2];
}
constexpr double kPairError = 0x1p-95;

// The value of the coplanarity cubic at time t.
template <class Real, class Point>
PairOf<Real> coplanarity_at(const TriplePoints<Point>& v, Real t) {
  return triple_product(difference_at(v.from, v.p_to, t), difference_at(v.q_from, v.q_to, t),
                        difference_at(v.from, v.r_to, t));
}

// Returns the next double below a positive one.
inline double next_below_positive(double x) {
  return std::bit_cast<double>(std::bit_cast<std::int64_t>(x) - 1);
}
inline Lane8 next_below_positive(Lane8 x) {
  return bits_as<Lane8>(bits_as<Sign8>(x) - 1);
}

template <class Real>
struct CertainTime {
  Real time;
  MaskOf<Real> known;
};

// Returns the largest double not above the only root of the coplanarity cubic between low and high, if that
// double is certain.
template <class Real, class Point>
CertainTime<Real> time_in_pairs(const TriplePoints<Point>& points, const Sizes<Real>& size,
                                const CubicOf<Real>& f, Real low, Real high) {
  using Mask = MaskOf<Real>;
  // In this range no part of a product underflows or overflows.
  const Mask in_range = (size.p > 1e-80) & (size.q > 1e-80) & (size.r > 1e-80) & (size.p < 1e80) &
                        (size.q < 1e80) & (size.r < 1e80);
  const Real(&c)[4] = f.f.c;
  const Real t = low + 0.5 * (high - low);
  const PairOf<Real> value = coplanarity_at(points, t);
  const Real slope = f.slope(t);
  const Real bend = 6 * larger(absolute(c[0] - 2 * c[1] + c[2]), absolute(c[1] - 2 * c[2] + c[3]));
  // Bounds the difference of `slope` to the slope anywhere between low and high. The factor 1.01 pays for the
  // roundings of the bound.
  const Real slope_error = 1.01 * ((high - low) * (bend + 24 * f.error) + 8 * f.error);
  const Real least_slope = absolute(slope) - slope_error;
  const Real step = -value.high / slope;
  // The step leaves out value.low, and its quotient is rounded. The error pays for both.
  const Real error =
      1.01 * ((absolute(step) * slope_error + absolute(value.low) + kPairError * size.p * size.q * size.r) /
                  least_slope +
              2 * kUnitRoundoff * absolute(step));
  const PairOf<Real> root = exact_sum(t, step);
  const Real below = next_below_positive(root.high);
  const Mask sharp = (least_slope > 0) & (root.high > 0) & (error < 0x1p-4 * (root.high - below));
  const Mask not_above = root.low > error, above = root.low < -error;
  return {select(above, below, root.high), Mask(in_range & sharp & (not_above | above))};
}

}  // namespace cscd
