#pragma once

#include <cmath>
#include <cstddef>
#include <optional>

#include "core/elementary/doubles_stage.h"

// The time of a contact that the stage in double precision has proved, in twice that precision.
//
// The root is t + d with d = -f(t) / f'(x) for some x between it and t. For a double t near the root, f(t) is
// evaluated in pairs of doubles (error-free sums and products; Dekker 1971, Knuth), f' bounded in doubles.
// The largest double not above the root is certain unless the root is within some 2^-90 of a double.
namespace cscd {

// The unevaluated sum of two doubles, the second at most half an ulp of the first.
struct Pair {
  double high, low;
};

inline Pair exact_sum(double a, double b) {
  const double sum = a + b, b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}
inline Pair exact_sum_of_ordered(double large, double small) {
  const double sum = large + small;
  return {sum, small - (sum - large)};
}
inline Pair exact_product(double a, double b) {
  const double product = a * b;
#ifdef __FMA__
  return {product, std::fma(a, b, -product)};
#else  // the same, by Dekker's halves
  constexpr double kSplit = 0x1p27 + 1;
  const double a_wide = kSplit * a, a_high = a_wide - (a_wide - a), a_low = a - a_high;
  const double b_wide = kSplit * b, b_high = b_wide - (b_wide - b), b_low = b - b_high;
  return {product, a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low)};
#endif
}
// Off by less than 2^-103 (|a| + |b|).
inline Pair operator+(const Pair& a, const Pair& b) {
  const Pair high = exact_sum(a.high, b.high);
  return exact_sum_of_ordered(high.high, high.low + (a.low + b.low));
}
inline Pair operator-(const Pair& a) {
  return {-a.high, -a.low};
}
inline Pair operator-(const Pair& a, const Pair& b) {
  return a + -b;
}
// Off by less than 2^-103 |a b|.
inline Pair operator*(const Pair& a, const Pair& b) {
  const Pair high = exact_product(a.high, b.high);
  return exact_sum_of_ordered(high.high, high.low + (a.high * b.low + a.low * b.high));
}

struct VectorOfPairs {
  Pair x[3];
};
// The difference of two moving points at time t; off by less than 2^-100 times its largest component at 0
// and 1.
inline VectorOfPairs difference_at(const MovingPoint& from, const MovingPoint& to, double t) {
  VectorOfPairs d;
  for (int k = 0; k < 3; ++k) {
    const Pair start = exact_sum(to.start[k], -from.start[k]), end = exact_sum(to.end[k], -from.end[k]);
    d.x[k] = start + (end - start) * Pair{t, 0};
  }
  return d;
}
// Off by less than 2^-95 times the product of those largest components: 6 products of three, each factor off
// by a relative 2^-100, and five operations.
inline Pair triple_product(const VectorOfPairs& p, const VectorOfPairs& q, const VectorOfPairs& r) {
  const auto wedge = [&](int i, int j) { return p.x[i] * q.x[j] - p.x[j] * q.x[i]; };
  return wedge(1, 2) * r.x[0] + wedge(2, 0) * r.x[1] + wedge(0, 1) * r.x[2];
}
constexpr double kPairError = 0x1p-95;

inline Pair coplanarity_at(const MovingVertexFace& v, double t) {
  return triple_product(difference_at(v.corner[0], v.corner[1], t),
                        difference_at(v.corner[0], v.corner[2], t), difference_at(v.corner[0], v.vertex, t));
}
inline Pair coplanarity_at(const MovingEdgeEdge& e, double t) {
  return triple_product(difference_at(e.first[0], e.first[1], t), difference_at(e.second[0], e.second[1], t),
                        difference_at(e.first[0], e.second[0], t));
}

// The largest double not above the only root of the coplanarity cubic between low and high, if it is certain.
template <class Query>
std::optional<double> time_in_pairs(const Query& query, const Triple& v, const BernsteinCubic& cubic,
                                    double low, double high) {
  const Sizes size{v.p.largest(), v.q.largest(), v.r.largest()};
  // No part of a product may underflow or overflow.
  for (const double s : {size.p, size.q, size.r})
    if (!(s > 1e-80 && s < 1e80)) return std::nullopt;
  const Cubic f(cubic, 1);
  const double(&c)[4] = f.f.c;
  const double t = low + 0.5 * (high - low);
  const Pair value = coplanarity_at(query, t);
  const double slope = f.slope(t);
  const double bend = 6 * std::max(std::abs(c[0] - 2 * c[1] + c[2]), std::abs(c[1] - 2 * c[2] + c[3]));
  // Of the slope anywhere between low and high; 1.01 for the roundings of bounds.
  const double slope_error = 1.01 * ((high - low) * (bend + 24 * f.error) + 8 * f.error);
  const double least_slope = std::abs(slope) - slope_error;
  if (!(least_slope > 0)) return std::nullopt;
  const double step = -value.high / slope;
  // value.low, and the quotient's rounding.
  const double error =
      1.01 * ((std::abs(step) * slope_error + std::abs(value.low) + kPairError * size.p * size.q * size.r) /
                  least_slope +
              2 * kUnitRoundoff * std::abs(step));
  const Pair root = exact_sum(t, step);
  if (!(error < 0x1p-4 * (root.high - std::nextafter(root.high, 0.0)))) return std::nullopt;
  if (root.low > error) return root.high;
  if (root.low < -error) return std::nextafter(root.high, 0.0);
  return std::nullopt;
}

}  // namespace cscd
