#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

#include "core/base/rounding.h"
#include "core/base/vec3.h"

// Triple products of moving vectors as cubics in t, with certified signs.
//
// Both the coplanarity of four moving points (the deforming non-penetration filter, Tang, Manocha and Tong
// 2010) and the orientation of a moving triangle towards a moving observer (Wong et al. 2013) are (a(t) x
// b(t)) . c(t) for vectors that move linearly. On [0, 1] a cubic lies in the hull of its four Bernstein
// coefficients: when they share a sign, so does the cubic.
namespace cscd {

// A difference of two linearly moving points at t = 0 and t = 1.
struct MovingVector {
  Vec3 start, end;
  double largest() const { return std::max(start.cwiseAbs().maxCoeff(), end.cwiseAbs().maxCoeff()); }
};

// The Bernstein coefficients of a cubic on [0, 1]. Each is within `error` of the exact coefficient for the
// exact input. `error` is infinite if nothing is known, because a product on the way underflowed or
// overflowed. `Real` is a double for one cubic, or lanes for several cubics side by side.
template <class Real>
struct BernsteinCubicOf {
  Real c[4];
  Real error;

  // The value of the cubic at t.
  Real at(Real t) const {
    const Real s = 1 - t;
    return s * s * (s * c[0] + 3 * t * c[1]) + t * t * (3 * s * c[2] + t * c[3]);
  }
};
using BernsteinCubic = BernsteinCubicOf<double>;

// Bounds for the size of products on the way. Below kTinyProduct a product may be subnormal and lose more
// than a relative rounding; above kHugeProduct it may overflow.
inline constexpr double kTinyProduct = 1e-280, kHugeProduct = 1e300;
inline constexpr double kTripleProductError = 72 * kUnitRoundoff;

// The cross product a(t) x b(t) of two moving vectors: its three control vectors on [0, 1], of which the
// middle one is stored twice as large, and the product of the largest components of a and b.
struct MovingNormal {
  Vec3 at[3];
  double area;
};
inline MovingNormal moving_cross(const MovingVector& a, const MovingVector& b) {
  return {{a.start.cross(b.start), a.start.cross(b.end) + a.end.cross(b.start), a.end.cross(b.end)},
          a.largest() * b.largest()};
}

// Returns the cubic (a x b) . c. Each component of a, b and c may carry one rounding (it is a difference of
// two doubles). In addition, the components of c may be off by `c_slack`, an absolute bound.
//
// Error bound: with A, B, C the largest components, every coefficient is a sum of products a_i b_j c_k whose
// absolute values sum to at most 6 A B C. The longest chain has 11 roundings (3 inputs; multiply, subtract
// and add in the crosses; multiply and two additions in the dot; one addition; one division), so the error is
// at most gamma_11 * 6 A B C < 67 u A B C, with u = kUnitRoundoff. The factor 72 also pays for the
// roundings of the bound itself.
inline BernsteinCubic triple_product(const MovingNormal& n, const MovingVector& c, double c_slack = 0) {
  const double volume = n.area * c.largest();
  const bool known =
      n.area >= kTinyProduct && n.area <= kHugeProduct && volume >= kTinyProduct && volume <= kHugeProduct;
  return {
      {n.at[0].dot(c.start), (n.at[1].dot(c.start) + n.at[0].dot(c.end)) / 3,
       (n.at[1].dot(c.end) + n.at[2].dot(c.start)) / 3, n.at[2].dot(c.end)},
      known ? kTripleProductError * volume + 7 * n.area * c_slack : std::numeric_limits<double>::infinity()};
}
inline BernsteinCubic triple_product(const MovingVector& a, const MovingVector& b, const MovingVector& c,
                                     double c_slack = 0) {
  return triple_product(moving_cross(a, b), c, c_slack);
}

// +1: positive for every t in [0, 1]; -1: negative for every t; 0: not certain. Coefficient by coefficient,
// because a minimum may forget a NaN.
template <std::floating_point Real>
int certain_sign(const BernsteinCubicOf<Real>& f) {
  const Real e = f.error;
  const bool above = (f.c[0] > e) & (f.c[1] > e) & (f.c[2] > e) & (f.c[3] > e);
  const bool below = (f.c[0] < -e) & (f.c[1] < -e) & (f.c[2] < -e) & (f.c[3] < -e);
  return above - below;
}

}  // namespace cscd
