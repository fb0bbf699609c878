#include <algorithm>
#include <array>
#include <cstring>

#include "core/detect/carried_lanes.h"
#include "core/detect/filter_block.h"

// Where a cubic certainly has no root by its signs, the filter finds that in double precision too: a sign
// that exceeds its bound here exceeds the much smaller bound there. If two coefficients certainly have
// opposite signs here, the cubic has no certain sign there, so that nothing is gained by asking.
namespace cscd {
namespace {

// Larger coordinates are left to double precision, so that all bounds stay finite. With coordinates up to M,
// the largest number here is the difference of two projections, 18432 M^4.
constexpr float kLargest = 1e8F;

// Signs that make edges run alike. An edge *runs upward* if it runs from its vertex with the smaller index.
// Bit i of `up` says so for edge i of the first triangle, bit 3 + k for edge k of the second. The entry of a
// place is 1 if both of its edges run upward or neither does, else -1. Vertex-face places have 1.
constexpr auto kAlike = [] {
  std::array<std::array<float, kLanes16>, 64> alike{};
  for (unsigned up = 0; up < alike.size(); ++up)
    for (unsigned place = 0; place < kLanes16; ++place) {
      const unsigned edge = place < 6 ? 0 : (place - 6) / 3 % 3, other = place < 6 ? 0 : (place - 6) % 3;
      const bool same = (up >> edge & 1) == (up >> (3 + other) & 1);
      alike[up][place] = place < 6 || same ? 1.0F : -1.0F;
    }
  return alike;
}();
Float16 alike(const Triangle& a, const Triangle& b) {
  const auto up = [](const Triangle& t) {
    return unsigned{t[0] < t[1]} | unsigned{t[1] < t[2]} << 1 | unsigned{t[2] < t[0]} << 2;
  };
  Float16 out;
  std::memcpy(&out, kAlike[up(a) | up(b) << 3].data(), sizeof out);
  return out;
}

// Single-precision version of apart_sideways() for sixteen pairs. Returns those that are certainly apart.
//
// Rounding. Let u = 2^-24. d = `error` is at least u times the largest coordinate, so a difference of two
// coordinates is off by at most D = 4 d; let S be the longest such difference. Twice its mean is off by 3 D.
// A difference of two of these is off by 8 D, and a difference of that and a single one by 14 D = 56 d, which
// is the most for anything in `along`. Call that e. Let A and B be the largest components of the first two
// vectors in `along`, and X that of the vector to which m is perpendicular. Then the normal is off by
//   2 e (A + B) + 4.1 u A B;
// m, which is not larger than 4 A B X, is off by
//   twice that times X, 4.1 e A B and 8.2 u A B X;
// and a projection is off by
//   3 S times the error of m, 12.1 A B X D, and 36 u A B X S for its own roundings.
// For two projections and their difference, using u A B <= u (A + B)^2 / 4, u (A + B) <= 0.22 e and X <= 6 S,
// the sum is less than 35 e S (X (A + B) + A B). Here A, B, S and X include their own errors. The factor 36
// also pays for the roundings of the bound itself.
Mask16 sideways(const VectorLanes16 (&p)[3], Float16 alike, float error) {
  const Float16 slack = all_lanes(56 * error);
  Float16 along[3][3];
  for (int i = 0; i < 3; ++i) {
    const auto twice = [&](int k) { return p[k].at[0][i] + p[k].at[1][i]; };
    along[0][i] = twice(0);
    along[1][i] = select(kVertexFace, twice(1), twice(2) - twice(1));
    along[2][i] = along[1][i] - alike * along[0][i];
  }
  const auto cross = [](const Float16(&a)[3], const Float16(&b)[3], Float16(&out)[3]) {
    for (int i = 0; i < 3; ++i)
      out[i] = product_minus(a[(i + 1) % 3], b[(i + 2) % 3], a[(i + 2) % 3] * b[(i + 1) % 3]);
  };
  const auto size = [&](const Float16(&v)[3]) { return larger_size(larger_size(v[0], v[1]), v[2]) + slack; };
  Float16 normal[3];
  cross(along[0], along[1], normal);
  const Float16 a = size(along[0]), b = size(along[1]);
  const Float16 most =
      larger(larger(largest_component(p[0]), largest_component(p[1])), largest_component(p[2]));
  const Float16 scale = 36 * slack * (most + slack);

  unsigned apart = 0;
  for (const Float16(&edge)[3] : along) {
    Float16 m[3];
    cross(normal, edge, m);
    const Float16 bound = scale * (size(edge) * (a + b) + a * b);
    unsigned above_all = 0xffff, below_all = 0xffff;
    for (int end = 0; end < 2; ++end) {
      const auto at = [&](int k) {
        const Float16(&x)[3] = p[k].at[end];
        return product_plus(m[2], x[2], product_plus(m[1], x[1], m[0] * x[0]));
      };
      const Float16 zero = {}, x = at(0), y = at(1), z = at(2);
      const Float16 in_first = select(kVertexFace, y, zero), in_second = select(kVertexFace, z, y);
      const Float16 over = smaller(in_second, z) - larger(larger(zero, x), in_first);
      const Float16 under = smaller(smaller(zero, x), in_first) - larger(in_second, z);
      above_all &= above(over, bound), below_all &= above(under, bound);
    }
    apart |= (above_all | below_all) & above(bound, all_lanes(1e-30F));
  }
  return static_cast<Mask16>(apart);
}

// The part of the interval in which each cubic may have a root. Lanes without a root may have their `low`
// above their `high`.
//
// A cubic that begins certainly positive is above the straight line from its first control point to the one
// that the steepest descent leads to, and so has no root before that line reaches 0; likewise from the other
// end. Narrowed once more, by the control points of the part, little more than the root itself is left
// (Bezier clipping, Sederberg and Nishita 1990).
//
// Rounding. With the sizes A, B and C of Rounding16, coefficients are at most 6 A B C, so that the control
// points of a part are off by 12 u times that, beside `bound`, and a descent by as much again. `bound` is at
// least 68 u A B C, so that four times the bound pays for all. 0.9999 pays for the quotient, and 2^-20 for
// the times.
struct PartWithRoots {
  Float16 low = {}, high = all_lanes(1);

  explicit PartWithRoots(const TripleProducts16& f) {
    const Float16 third = all_lanes(1.0F / 3), bound = 4 * f.bound;
    const Float16 whole[4] = {f.c[0], f.c[1] * third, f.c[2] * third, f.c[3]};
    narrow(whole, bound);
    const auto polar = [&](Float16 r, Float16 s, Float16 t) {
      const auto mixed = [](Float16 x, Float16 y, Float16 at) { return (1 - at) * x + at * y; };
      const Float16 x = mixed(whole[0], whole[1], r), y = mixed(whole[1], whole[2], r),
                    z = mixed(whole[2], whole[3], r);
      return mixed(mixed(x, y, s), mixed(y, z, s), t);
    };
    narrow({polar(low, low, low), polar(low, low, high), polar(low, high, high), polar(high, high, high)},
           bound);
  }

 private:
  // `c` holds the control points between `low` and `high`.
  void narrow(const Float16 (&c)[4], Float16 bound) {
    const auto without_root = [&](int from, int step) {
      const Float16 zero = {}, one = all_lanes(1), sign = select(c[from] < zero, -one, one),
                    size = sign * c[from];
      const auto descent = [&](int i) {
        return (3.0F / static_cast<float>(i)) * (size - sign * c[from + i * step]);
      };
      const Float16 steepest = larger(larger(descent(1), descent(2)), descent(3)), clear = size - bound;
      const Float16 reached = select(steepest > zero, smaller(0.9999F * clear / steepest, one), one);
      return select(clear > zero, reached, zero);
    };
    const Float16 width = high - low, slack = all_lanes(0x1p-20F);
    const Float16 begin = low + width * without_root(0, 1) - slack,
                  end = high - width * without_root(3, -1) + slack;
    low = larger(low, begin), high = smaller(high, end);
  }
};

// The points at the ends of that part. If each was off by 4 `error`, it is now off by less than three times
// that, because a weighted mean of two numbers rounds thrice.
VectorLanes16 between(const VectorLanes16& x, const PartWithRoots& part) {
  VectorLanes16 out;
  for (int i = 0; i < 3; ++i) {
    const auto at = [&](Float16 t) { return product_plus(t, x.at[1][i], (all_lanes(1) - t) * x.at[0][i]); };
    out.at[0][i] = at(part.low), out.at[1][i] = at(part.high);
  }
  return out;
}

}  // namespace

CarriedPlaces not_filtered_when_coplanar(const Motion& motion, const Triangle& a, const Triangle& b,
                                         CarriedPlaces places, double last) {
  const Corners c = corners_of(motion, a, b, last);
  if (!(c.largest <= kLargest && c.beyond <= kLargest)) return not_filtered(motion, a, b, places);
  const float error = c.error();
  const CarriedLanes lanes(c);
  const VectorLanes16 &p = lanes.p, &q = lanes.q, &r = lanes.r;
  Float16 normal[3][3];
  cross(p, q, normal);
  const TripleProducts16 products =
      triple_products(normal, r, rounding_of(largest_component(p), largest_component(q), error), error);
  const unsigned never = products.positive() | products.negative();
  unsigned left = places & ~never;
  if (left == 0) return 0;

  const PartWithRoots part(products);
  VectorLanes16 seen[3];
  lanes.seen_from_first(seen);
  for (VectorLanes16& x : seen) x = between(x, part);
  left &= ~(sideways(seen, alike(a, b), 3 * error) & products.known);
  // Double precision may drop more of what is left unless each cubic certainly has two signs. It looks at the
  // whole interval.
  const bool certain = last < 1 || (places & ~(never | products.mixed())) == 0;
  const auto kept = static_cast<CarriedPlaces>(left);
  return certain || kept == 0 ? kept : not_filtered(motion, a, b, kept);
}

}  // namespace cscd
