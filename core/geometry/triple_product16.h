#pragma once

#include "core/base/vec3.h"
#include "core/geometry/simd_floats.h"

// Sixteen triple products of moving vectors in single precision, with certified signs.
//
// Rounding. Let u = 2^-24. The vectors are differences of coordinates; each coordinate is off by at most d =
// `error`, which is at least u times the largest coordinate. So a component of a vector is off by 2 d and by
// u times itself. Let A, B and C be the largest computed components of a, b and c, and A' = A + 2 d, and so
// on. Every coefficient of (a x b) . c is a sum of products whose absolute values sum to 6 A B C (to 18 A B C
// for the middle two, which are stored as three times the Bernstein coefficients). The errors of the factors
// change a coefficient by at most
//   6 ((A' + u A)(B' + u B)(C' + u C) - A B C) <= 12 d (A' B' + A' C' + B' C') + 19 u A' B' C'.
// The roundings that follow each product come on top. If a product and a sum are rounded separately, the 6
// products have 28 roundings in all (2 in `cross`, then 3, 3, 2). The 18 products of the middle two then have
// 137 (12 products have 2 to 4 in `cross`, then 6, 6, 5; the other 6 have 2, then 4, 3, 2). If a product and
// a sum are rounded once, the numbers are 21 and 111. That is less than 8.1 roundings for each of the 6 or 18
// products, hence an error of at most 6 * 8.1 u A B C. The factors 12.1 and 68 in the code also pay for the
// roundings of the bound itself. Below kTiny products might underflow, and nothing is certain.
namespace cscd {

// A point in one register. The fourth number is 0.
using Double4 = HalfOf<double>;
inline Double4 row_of(const Vec3& p) {
  return Double4{p[0], p[1], p[2], 0};
}

// Sixteen moving vectors or points: [end][axis].
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

// Computes a(t) x b(t): its control vectors on [0, 1], of which the middle one is stored twice as large.
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
  Mask16 known;  // lanes in which nothing underflows

  // Lanes in which the cubic certainly is positive at every t in [0, 1].
  Mask16 positive() const {
    return static_cast<Mask16>(known & above(c[0], bound) & above(c[1], bound3) & above(c[2], bound3) &
                               above(c[3], bound));
  }
  // Lanes in which the cubic certainly is negative at every t in [0, 1].
  Mask16 negative() const {
    return static_cast<Mask16>(known & above(-bound, c[0]) & above(-bound3, c[1]) & above(-bound3, c[2]) &
                               above(-bound, c[3]));
  }
  // Lanes in which one coefficient certainly is positive and another one certainly is negative.
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

// Returns whether all sixteen cubics certainly are positive. No third vector may have a component larger than
// `reach` - 2 `error`. The function takes fewer steps than TripleProducts16::positive(), and it returns true
// only if positive() would have all lanes set. (If a coefficient exceeds ten times kTiny, the product of the
// largest components exceeds kTiny, so nothing underflows.)
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
