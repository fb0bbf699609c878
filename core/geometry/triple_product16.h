#pragma once

#include "core/base/vec3.h"
#include "core/geometry/lanes16.h"

// Sixteen triple products of moving vectors in single precision, with certified signs.
//
// Rounding. u = 2^-24; the vectors are differences of coordinates, each of which is off by at most d =
// `error`, which is at least u times the largest. (a x b) . c: a difference of coordinates is off by 2 d and
// rounds by u of itself. Let A, B, C be the largest computed components of the three and A' = A + 2 d, and so
// on. Every coefficient is a sum of products whose absolute values sum to 6 A B C (18 for the middle two,
// which are three times the Bernstein coefficients). Errors of the factors change it by at most
//   6 ((A' + u A)(B' + u B)(C' + u C) - A B C) <= 12 d (A' B' + A' C' + B' C') + 19 u A' B' C'.
// Then come the roundings behind each product. Where a product and a sum are rounded apart, the 6 have 28 in
// all (2 in `cross`, then 3, 3, 2), the 18 of the middle two 137 (12 have 2 to 4 in `cross`, then 6, 6, 5;
// the other 6 have 2, then 4, 3, 2); else 21 and 111. That is less than 8.1 each, hence at most
// 6 * 8.1 u A B C. 12.1 and 68 also pay for the roundings of the bound itself. Below kTiny products
// might underflow; nothing is certain then.
namespace cscd {

// A point in one register; the fourth number is 0.
using Double4 = HalfOf<double>;
inline Double4 row_of(const Vec3& p) {
  return Double4{p[0], p[1], p[2], 0};
}

// Sixteen moving vectors, or points: [end][axis].
struct VectorLanes16 {
  Float16 at[2][3];
};

inline VectorLanes16 operator-(const VectorLanes16& to, const VectorLanes16& from) {
  VectorLanes16 out;
  for (int end = 0; end < 2; ++end)
    for (int i = 0; i < 3; ++i) out.at[end][i] = to.at[end][i] - from.at[end][i];
  return out;
}

// Returns the largest absolute component of each vector, over both ends and all axes.
inline Float16 largest_component(const VectorLanes16& v) {
  const auto largest = [&](int end) {
    return larger_size(larger_size(v.at[end][0], v.at[end][1]), v.at[end][2]);
  };
  return larger_size(largest(0), largest(1));
}

// a(t) x b(t): control vectors on [0, 1], the middle one twice.
inline void cross(const VectorLanes16& a, const VectorLanes16& b, Float16 (&control)[3][3]) {
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    control[0][i] = product_minus(a.at[0][j], b.at[0][k], a.at[0][k] * b.at[0][j]);
    const Float16 less = product_plus(a.at[0][k], b.at[1][j], a.at[1][k] * b.at[0][j]);
    control[1][i] = product_plus(a.at[0][j], b.at[1][k], product_minus(a.at[1][j], b.at[0][k], less));
    control[2][i] = product_minus(a.at[1][j], b.at[1][k], a.at[1][k] * b.at[1][j]);
  }
}

// What bounds the rounding, by the reach of the third vector: `apart` + reach * `sloped`. `area` is the
// product of the largest components of the first two vectors.
struct Rounding16 {
  static constexpr float kTiny = 1e-30F;
  Float16 area, apart, sloped;
};
// `a` and `b` are those largest components.
[[gnu::always_inline]] inline Rounding16 rounding_of(Float16 a, Float16 b, float error) {
  a += all_lanes(2 * error), b += all_lanes(2 * error);
  const Float16 area = a * b, errors = all_lanes(12.1F * error);
  return {area, errors * area, product_plus(errors, a + b, all_lanes(68 * 0x1p-24F) * area)};
}

// The coefficients, the middle two times three, and bounds on the errors of the outer and of the middle ones.
struct TripleProducts16 {
  Float16 c[4], bound, bound3;
  Mask16 known;  // where nothing underflows

  Mask16 positive() const {
    return static_cast<Mask16>(known & above(c[0], bound) & above(c[1], bound3) & above(c[2], bound3) &
                               above(c[3], bound));
  }
  Mask16 negative() const {
    return static_cast<Mask16>(known & above(-bound, c[0]) & above(-bound3, c[1]) & above(-bound3, c[2]) &
                               above(-bound, c[3]));
  }
  // Where one coefficient certainly is positive and another negative.
  Mask16 mixed() const {
    const unsigned some_positive =
        above(c[0], bound) | above(c[1], bound3) | above(c[2], bound3) | above(c[3], bound);
    const unsigned some_negative =
        above(-bound, c[0]) | above(-bound3, c[1]) | above(-bound3, c[2]) | above(-bound, c[3]);
    return static_cast<Mask16>(known & some_positive & some_negative);
  }
};
// Computes the coefficients of (a x b) . c from the control vectors of a x b.
[[gnu::always_inline]] inline void coefficients(const Float16 (&normal)[3][3], const VectorLanes16& third,
                                                Float16 (&c)[4]) {
  const auto dot = [&](int n, int end) {
    return product_plus(normal[n][2], third.at[end][2],
                        product_plus(normal[n][1], third.at[end][1], normal[n][0] * third.at[end][0]));
  };
  const auto plus_dot = [&](Float16 sum, int n, int end) {
    for (int i = 0; i < 3; ++i) sum = product_plus(normal[n][i], third.at[end][i], sum);
    return sum;
  };
  c[0] = dot(0, 0), c[1] = plus_dot(dot(1, 0), 0, 1), c[2] = plus_dot(dot(1, 1), 2, 0), c[3] = dot(2, 1);
}

// Computes the coefficients together with their error bounds.
[[gnu::always_inline]] inline TripleProducts16 bounded(const Float16 (&c)[4], const VectorLanes16& third,
                                                       const Rounding16& rounding, float error) {
  const Float16 reach = largest_component(third) + all_lanes(2 * error);
  const Float16 bound = product_plus(reach, rounding.sloped, rounding.apart);
  return {{c[0], c[1], c[2], c[3]},
          bound,
          3 * bound,
          static_cast<Mask16>(above(rounding.area, all_lanes(Rounding16::kTiny)) &
                              above(rounding.area * reach, all_lanes(Rounding16::kTiny)))};
}
[[gnu::always_inline]] inline TripleProducts16 triple_products(const Float16 (&normal)[3][3],
                                                               const VectorLanes16& third,
                                                               const Rounding16& rounding, float error) {
  Float16 c[4];
  coefficients(normal, third, c);
  return bounded(c, third, rounding, error);
}

// Whether all certainly are positive, of third vectors none of which has a component of `reach` - 2 `error`:
// in fewer steps, and never where `positive` would not say so of all. (Of a coefficient above ten times
// Rounding16::kTiny the largest components have a product above it.)
[[gnu::always_inline]] inline bool all_positive(const Float16 (&c)[4], const Rounding16& rounding,
                                                float reach) {
  const Float16 bound =
      product_plus(all_lanes(reach), rounding.sloped, rounding.apart) + all_lanes(10 * Rounding16::kTiny);
  const Float16 bound3 = 3 * bound;
  Mask16 positive = above(rounding.area, all_lanes(Rounding16::kTiny));
  positive = above(positive, c[0], bound);
  positive = above(positive, c[1], bound3);
  positive = above(positive, c[2], bound3);
  return above(positive, c[3], bound) == 0xffff;
}

}  // namespace cscd
