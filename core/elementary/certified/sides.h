#pragma once

#include <type_traits>

#include "core/base/rounding.h"
#include "core/geometry/feature_motion.h"
#include "core/geometry/simd_doubles.h"

// Tells whether features touch wherever they are in one plane, from the signs of their *sides*. The sides are
// combinations of components of n = p x q, g = p x r and h = r x q along an axis; integer_contact.cpp derives
// them. If two sides have certain opposite signs all through an interval, the features are apart in that
// interval. If all sides have one certain sign, the features touch whenever they are in one plane.
//
// The idea is Bernstein sign classification (Tang, Tong, Wang and Manocha, TOG 2014). This implementation
// differs in that every sign has a forward error bound (rule certain-sign, core/soundness.md).
//
// The code is written once for a single query (Real = double, with bools as masks) and for eight queries side
// by side (Real = Lane8, with the masks of lanes).
namespace cscd {

template <class Query>
constexpr bool kIsVertexFace = std::is_same_v<Query, MovingVertexFace>;

// A moving vector seen along an axis: its components along the two other axes at both ends of an interval.
template <class Real>
struct SeenAlong {
  Real at[2][2];  // [end][component]
};

// A component of a product of two moving vectors over an interval: Bernstein coefficients, and a bound on the
// error of each.
template <class Real>
struct Component {
  Real b[3];
  Real error;
};

// The error bounds of components and of the cubic.
//
// Let L and L' be the largest components of the two vectors at t = 0 and t = 1. A vector component is off by
// at most 4 u L: it is a difference at each end, and two products and a sum for a time between the ends. A
// Bernstein coefficient of the cross product contains two products of two vector components, (2 * 2 * 4 + 2)
// u L L', and their difference, 2 u L L'. The middle coefficient is half of twice as much, with one more sum:
// 22 u L L' altogether. A side adds up to three components, which costs at most 4 u more for each. The
// constant 28 also pays for terms in u^2 and for the bound's own roundings.
//
// An underflow in a product costs less than kUnderflow. An underflow in a vector component is negligible only
// if the vector is at least as large as kLeastSize.
struct ProvenBounds {
  // `component` is relative to L L'; `cubic` is a factor on the bound of the cubic (CubicOf,
  // doubles_stage.h).
  static constexpr double component = 28 * kUnitRoundoff, cubic = 1;
};
inline constexpr double kUnderflow = 1e-300;
// The range of the largest components of vectors in which the bounds hold: no smaller, because of underflow,
// and no larger, because of overflow.
inline constexpr double kLeastSize = 1e-290, kLargestSize = 1e145;

// The component of x cross y along the axis along which both are seen. `size` is L L' of ProvenBounds.
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

// The place of the features, as far as it is certain all through an interval. `outside` proves that they
// never touch in the interval. `inside` proves that they touch at every time in the interval at which their
// four points are in one plane. At most one of both is true.
template <class Real>
struct Place {
  MaskOf<Real> outside, inside;
};

// Collects the signs of the sides that are certain.
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

// The largest absolute components of the vectors p, q and r at t = 0 and t = 1.
template <class Real>
struct Sizes {
  Real p, q, r;

  MaskOf<Real> in_range() const {
    const Real least = smaller(smaller(p, q), r), largest = larger(larger(p, q), r);
    return MaskOf<Real>((least >= kLeastSize) & (largest <= kLargestSize));
  }
};

// The place of the features by their sides along one axis. `size` holds the sizes over all of [0, 1], also if
// p, q and r are given over a part of it.
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
