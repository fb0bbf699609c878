#pragma once

#include <type_traits>

#include "core/base/rounding.h"
#include "core/geometry/feature_motion.h"
#include "core/geometry/lanes.h"

// Where features in one plane are, by the sides of integer_contact.cpp: combinations of components of n = p x
// q, g = p x r and h = r x q along an axis. Two with certain opposite signs all through an interval prove
// "apart" there; all with one certain sign prove "contact" wherever they are in one plane. After the idea of
// Bernstein sign classification (Tang, Tong, Wang and Manocha, TOG 2014); what differs: every sign has a
// forward error bound.
//
// One text for a query and for eight side by side: with doubles and bools, and with lanes and their masks.
namespace cscd {

template <class Query>
constexpr bool kIsVertexFace = std::is_same_v<Query, MovingVertexFace>;

// A moving vector seen along an axis: its other two components at both ends of an interval.
template <class Real>
struct SeenAlong {
  Real at[2][2];
};

// A component of a product of two moving vectors over an interval: Bernstein coefficients, and a bound on the
// error of each.
template <class Real>
struct Component {
  Real b[3];
  Real error;
};

// One vector component is off by at most 4 u L: a difference, and two products and a sum between the ends of
// the interval; L is the largest component at t = 0 and 1. A coefficient has two products of two of those,
// (2 * 2 * 4 + 2) u L L', and a difference of them, 2 u L L'; the middle one is half of twice as much, and
// one more sum: 22 u L L' altogether. Sides add up to three of these, at most 4 u more for each. 28 also pays
// for terms in u^2 and the bound's own roundings. What underflows in a product is less than the last term;
// what does in a vector counts as little only if the vector is no smaller than kLeastSize.
struct ProvenBounds {
  static constexpr double component = 28 * kUnitRoundoff, cubic = 1;  // the latter in units of the proven one
};
inline constexpr double kUnderflow = 1e-300;
inline constexpr double kLeastSize = 1e-290, kLargestSize = 1e145;  // of vectors, for that and for overflow

template <class Bounds, class Real>
Component<Real> component(const SeenAlong<Real>& x, const SeenAlong<Real>& y, Real size) {
  const auto wedge = [&](int m, int n) { return x.at[m][0] * y.at[n][1] - x.at[m][1] * y.at[n][0]; };
  return {{wedge(0, 0), 0.5 * (wedge(0, 1) + wedge(1, 0)), wedge(1, 1)},
          Bounds::component * size + kUnderflow};
}
template <class Real>
Component<Real> operator+(const Component<Real>& x, const Component<Real>& y) {
  return {{x.b[0] + y.b[0], x.b[1] + y.b[1], x.b[2] + y.b[2]}, x.error + y.error};
}
template <class Real>
Component<Real> operator-(const Component<Real>& x, const Component<Real>& y) {
  return {{x.b[0] - y.b[0], x.b[1] - y.b[1], x.b[2] - y.b[2]}, x.error + y.error};
}
template <class Real>
Component<Real> operator-(const Component<Real>& x) {
  return {{-x.b[0], -x.b[1], -x.b[2]}, x.error};
}

// What is certain all through an interval.
template <class Real>
struct Place {
  MaskOf<Real> outside, inside;
};

// The signs that sides certainly have.
template <class Real>
struct SideSigns {
  using Mask = MaskOf<Real>;
  Mask some_positive = {}, some_negative = {}, all_positive = Mask(Real{} == Real{}),
       all_negative = all_positive;

  void add(const Component<Real>& side) {
    const Real e = side.error;
    const Mask positive = (side.b[0] > e) & (side.b[1] > e) & (side.b[2] > e);
    const Mask negative = (side.b[0] < -e) & (side.b[1] < -e) & (side.b[2] < -e);
    some_positive |= positive;
    some_negative |= negative;
    all_positive &= positive;
    all_negative &= negative;
  }
  Place<Real> place() const {
    return {Mask(some_positive & some_negative), Mask(all_positive | all_negative)};
  }
};

// Largest components.
template <class Real>
struct Sizes {
  Real p, q, r;

  MaskOf<Real> in_range() const {
    const Real least = smaller(smaller(p, q), r), largest = larger(larger(p, q), r);
    return MaskOf<Real>((least >= kLeastSize) & (largest <= kLargestSize));
  }
};

template <class Query, class Bounds, class Real>
Place<Real> place_along(const SeenAlong<Real>& p, const SeenAlong<Real>& q, const SeenAlong<Real>& r,
                        const Sizes<Real>& size) {
  const Component<Real> n = component<Bounds, Real>(p, q, size.p * size.q),
                        g = component<Bounds, Real>(p, r, size.p * size.r),
                        h = component<Bounds, Real>(r, q, size.r * size.q);
  SideSigns<Real> signs;
  if constexpr (kIsVertexFace<Query>) {
    signs.add(g);
    signs.add(h);
    signs.add(n - g - h);
  } else {
    signs.add(-g);
    signs.add(n + g);
    signs.add(h);
    signs.add(n - h);
  }
  const Place<Real> place = signs.place();
  const MaskOf<Real> known = size.in_range();
  return {MaskOf<Real>(place.outside & known), MaskOf<Real>(place.inside & known)};
}

}  // namespace cscd
