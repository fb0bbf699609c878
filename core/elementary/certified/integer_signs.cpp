// Exact signs of integer polynomials at doubles, at fractions, and at roots of other polynomials.
//
// The sign of q at an isolated root r of p is certain if q has no sign variation between the neighbouring
// doubles that enclose r. Otherwise q has a root x between these doubles, and r is compared with x without
// refining either: at x the value of p is that of p modulo q, which is linear, and the sign of this linear
// polynomial at x follows from the sign of q at a fraction.
#include <algorithm>
#include <utility>

#include "core/elementary/certified/integer_roots.h"

namespace cscd::integer {
namespace {

// Returns a multiple of p modulo q as {constant, slope}, for q of degree 2 and p of degree at most 3. The
// factor is the square of q's leading coefficient if p has degree 3, and that coefficient otherwise.
std::pair<Wide, Wide> remainder(const Polynomial& p, const Polynomial& q) {
  const auto coefficient = [&](int i) { return i <= p.degree ? p.c[i] : Wide(); };
  Wide r2 = coefficient(2), r1 = coefficient(1), r0 = coefficient(0);
  if (p.degree == 3) {
    r2 = q.c[2] * r2 - p.c[3] * q.c[1];
    r1 = q.c[2] * r1 - p.c[3] * q.c[0];
    r0 = q.c[2] * r0;
  }
  return {q.c[2] * r0 - r2 * q.c[0], q.c[2] * r1 - r2 * q.c[1]};
}

}  // namespace

bool RootSolver::fits(int bits) {
  if (bits > Wide::kBits) gave_up_ = true;
  return !gave_up_;
}

int RootSolver::sign_at_double(const Polynomial& p, double t) {
  if (p.degree <= 0) return p.is_zero() ? 0 : p.c[0].sign();
  const Dyadic at = dyadic(t);
  if (at.numerator == 0) return p.c[0].sign();
  if (!fits(p.bits() + 3 * (at.places + 1) + 8)) return 0;
  const Wide factor(at.numerator);
  Wide value = p.c[p.degree];
  for (int i = p.degree - 1; i >= 0; --i) value = value * factor + (p.c[i] << at.places * (p.degree - i));
  return value.sign();
}

int RootSolver::sign_at_fraction(const Polynomial& p, const Wide& numerator, const Wide& denominator) {
  if (p.degree <= 0) return p.is_zero() ? 0 : p.c[0].sign();
  if (!fits(p.bits() + p.degree * std::max(numerator.bits(), denominator.bits()) + 8)) return 0;
  Wide value = p.c[p.degree], scale = denominator;
  for (int i = p.degree - 1; i >= 0; --i) {
    value = value * numerator + p.c[i] * scale;
    if (i > 0) scale = scale * denominator;
  }
  return value.sign();
}

Polynomial RootSolver::stretched(const Polynomial& p, double low, double high) {
  if (low == 0 && high == 1) return p;
  const Dyadic a = dyadic(low), b = dyadic(high);
  const int places = std::max(a.places, b.places);
  if (!fits(p.bits() + 3 * (places + 1) + 16)) return Polynomial{};
  const Wide from = Wide(a.numerator) << places - a.places;
  return stretched_by(p, from, (Wide(b.numerator) << places - b.places) - from, places);
}

// The order of numerator / denominator and a bound: -1, 0 or 1, as the fraction is below, at or above the
// bound. The denominator is positive.
int RootSolver::compared(const Wide& numerator, const Wide& denominator, const Bound& bound) {
  if (bound.is_fraction) {
    if (!fits(std::max(numerator.bits() + bound.denominator.bits(),
                       bound.numerator.bits() + denominator.bits()) +
              2))
      return 0;
    return (numerator * bound.denominator - bound.numerator * denominator).sign();
  }
  const Dyadic at = dyadic(bound.at);
  if (!fits(std::max(numerator.bits() + at.places, denominator.bits() + 64) + 2)) return 0;
  return compare(numerator, denominator, at);
}

int RootSolver::sign_at_bound(const Polynomial& p, const Bound& bound) {
  return bound.is_fraction ? sign_at_fraction(p, bound.numerator, bound.denominator)
                           : sign_at_double(p, bound.at);
}

// The sign of q at an isolated root that lies between two bounds. In the closed interval of the bounds q
// has at most one root, and that root is simple.
int RootSolver::sign_at_side(const Polynomial& q, const Root& root, const Bound& low, const Bound& high) {
  const Polynomial& p = *root.polynomial;
  const int below = sign_at_bound(q, low), above = sign_at_bound(q, high);
  if (below * above >= 0) return below != 0 ? below : above;
  // q has a root x between the bounds. Find the sign of p at x.
  int sign = 0;
  if (q.degree == 1) {
    const bool flip = q.c[1].sign() < 0;
    sign = sign_at_fraction(p, flip ? q.c[0] : -q.c[0], flip ? -q.c[1] : q.c[1]);
  } else if (p.degree == 1) {
    const bool flip = p.c[1].sign() < 0;
    return sign_at_fraction(q, flip ? p.c[0] : -p.c[0], flip ? -p.c[1] : p.c[1]);
  } else {
    if (!fits(p.bits() + 2 * q.bits() + 8)) return 0;
    auto [r0, r1] = remainder(p, q);
    if (p.degree == 2 && q.c[2].sign() < 0) r0 = -r0, r1 = -r1;  // for degree 3 the factor is positive
    sign = r1.sign();
    if (sign == 0) {
      sign = r0.sign();
    } else {
      Wide numerator = -r0, denominator = r1;
      if (sign < 0) numerator = -numerator, denominator = -denominator;
      // Compare x with the root of the remainder.
      int side = 0;
      if (compared(numerator, denominator, low) <= 0) {
        side = 1;
      } else if (compared(numerator, denominator, high) >= 0) {
        side = -1;
      } else {
        const int there = sign_at_fraction(q, numerator, denominator);
        side = there == 0 ? 0 : there == below ? 1 : -1;
      }
      sign *= side;
    }
  }
  return sign == 0 ? 0 : sign == root.sign_below ? above : below;
}

int RootSolver::sign_at(const Polynomial& q, const Root& root) {
  if (q.degree <= 0) return q.is_zero() ? 0 : q.c[0].sign();
  if (root.polynomial == nullptr) return sign_at_fraction(q, root.numerator, root.denominator);
  const Signs signs = bernstein_signs(stretched(q, root.low, root.high));
  if (gave_up_) return 0;
  if (signs.variations == 0) return signs.first;

  Bound low{root.low}, high{root.high};
  if (root.cut != 0) (root.cut > 0 ? low : high) = {0, true, root.numerator, root.denominator};
  if (q.degree == 2 && (signs.variations == 2 || signs.zero_end)) {
    Bound vertex{0, true, -q.c[1], q.c[2] << 1};
    Wide &n = vertex.numerator, &d = vertex.denominator;
    if (d.sign() < 0) n = -n, d = -d;
    if (compared(n, d, low) > 0 && compared(n, d, high) < 0 && !gave_up_) {
      const int sign = sign_at_fraction(*root.polynomial, n, d);
      if (sign == 0) return gave_up_ ? 0 : sign_at_fraction(q, n, d);
      (sign == root.sign_below ? low : high) = vertex;
    }
  }
  return gave_up_ ? 0 : sign_at_side(q, root, low, high);
}

}  // namespace cscd::integer
