// Roots of integer polynomials of degree at most 3, for the integer stage of `filtered_exact`.
//
// Isolation: Descartes' rule (sign variations of the Bernstein coefficients on a piece) says "none", "one",
// or nothing; then the discriminant tells whether there can be more than one. If it is zero the root of even
// order is a fraction, and so are all. Else [0, 1] is cut near the critical points and near the fraction that
// would be the double root, and then halved. Two roots between neighbouring doubles are on either side of
// that fraction. The floating-point guesses decide how soon an answer comes, never what it is: every sign is
// computed in integers.
//
// Sign of q at an isolated root r of p: certain if q has no sign variation between the neighbouring doubles
// that enclose r. Otherwise r is compared with the root of q there, without refining either: p at that root
// is p modulo q, which is linear, and its sign follows from that of q at a fraction.
//
// The referee (algebraic.h) was written before and shares no code with this, so that each can be tested
// against the other.
#include "core/elementary/integer_roots.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace cscd::integer {
namespace {

// Halving of [0, 1] while two roots are not told apart.
constexpr int kDeepestSearch = 100;

struct Dyadic {
  std::int64_t numerator;
  int places;
};
Dyadic dyadic(double t) {  // 0 <= t <= 1
  if (t == 0) return {0, 0};
  int exponent = 0;
  auto numerator = static_cast<std::int64_t>(std::ldexp(std::frexp(t, &exponent), 53));
  const int spare = std::countr_zero(static_cast<std::uint64_t>(numerator));
  return {numerator >> spare, 53 - exponent - spare};
}

// Doubles >= 0 are ordered like their bit patterns.
std::uint64_t rank_of(double t) {
  return std::bit_cast<std::uint64_t>(t + 0.0);
}
double at_rank(std::uint64_t rank) {
  return std::bit_cast<double>(rank);
}

// 2^(places degree) p((numerator + width s) / 2^places).
Polynomial stretched_by(const Polynomial& p, const Wide& numerator, const Wide& width, int places) {
  Polynomial r;
  r.degree = p.degree;
  for (int i = 0; i <= p.degree; ++i) r.c[i] = p.c[i] << places * (p.degree - i);
  if (numerator.sign() != 0)
    for (int i = 0; i < p.degree; ++i)
      for (int j = p.degree - 1; j >= i; --j) r.c[j] = r.c[j] + numerator * r.c[j + 1];
  if (width.bits() == 1) return r;
  Wide scale = width;
  for (int i = 1; i <= p.degree; ++i) {
    r.c[i] = r.c[i] * scale;
    if (i < p.degree) scale = scale * width;
  }
  return r;
}

struct Signs {
  int variations = 0, first = 0;  // the sign just above 0; 0 for the zero polynomial
  bool zero_end = false;          // at 0 or at 1
};
// Of the Bernstein coefficients on [0, 1].
Signs bernstein_signs(const Polynomial& p) {
  int sign[4] = {p.c[0].sign(), 0, 0, 0};
  if (p.degree == 3) {
    const Wide three = p.c[0] + (p.c[0] << 1), first = three + p.c[1];
    sign[1] = first.sign();
    sign[2] = (first + p.c[1] + p.c[2]).sign();
    sign[3] = (p.c[0] + p.c[1] + p.c[2] + p.c[3]).sign();
  } else if (p.degree == 2) {
    sign[1] = ((p.c[0] << 1) + p.c[1]).sign();
    sign[2] = (p.c[0] + p.c[1] + p.c[2]).sign();
  } else if (p.degree == 1) {
    sign[1] = (p.c[0] + p.c[1]).sign();
  } else if (p.degree < 0) {
    sign[0] = 0;
  }
  Signs result;
  result.zero_end = p.degree >= 0 && (sign[0] == 0 || sign[p.degree] == 0);
  int last = 0;
  for (int i = 0; i <= p.degree; ++i) {
    if (sign[i] == 0) continue;
    if (last == 0) result.first = sign[i];
    if (last == -sign[i]) ++result.variations;
    last = sign[i];
  }
  return result;
}

// The coefficients as doubles times a common power of two.
struct Rounded {
  double c[4] = {0, 0, 0, 0};
};
Rounded rounded(const Polynomial& p) {
  Wide::Leading lead[4];
  int largest = -(1 << 20);
  for (int i = 0; i <= p.degree; ++i) {
    lead[i] = p.c[i].leading();
    if (lead[i].value != 0) largest = std::max(largest, lead[i].exponent);
  }
  Rounded r;
  for (int i = 0; i <= p.degree; ++i)
    r.c[i] = std::ldexp(lead[i].value, std::max(lead[i].exponent - largest, -1000));
  return r;
}

// Approximates the only root of p in (0, 1), where p has this sign at 0.
double approximate_root(const Polynomial& p, int sign_at_0) {
  const Rounded r = rounded(p);
  double low = 0, high = 1;
  const auto value = [&](double s) { return ((r.c[3] * s + r.c[2]) * s + r.c[1]) * s + r.c[0]; };
  const double end = value(1);
  double s = r.c[0] / (r.c[0] - end);
  for (int step = 0; step < 60; ++step) {
    if (!(s > low && s < high)) s = 0.5 * (low + high);
    if (s == low || s == high) break;
    const double v = value(s), slope = (3 * r.c[3] * s + 2 * r.c[2]) * s + r.c[1];
    if (v == 0) break;
    ((v > 0) == (sign_at_0 > 0) ? low : high) = s;
    const double next = s - v / slope;
    if (std::abs(next - s) <= 0x1p-53 * s) {
      s = next;
      break;
    }
    // After some steps without an end, halve.
    s = step < 12 || step % 2 == 0 ? next : 0.5 * (low + high);
  }
  return std::clamp(s, 0.0, 1.0);
}

Wide squared(const Wide& a) {
  return a * a;
}

// A multiple of p modulo q, q of degree 2, p of degree 3 or less: {constant, slope}.
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

// numerator / denominator against t: -1, 0 or 1.
int compare(const Wide& numerator, const Wide& denominator, const Dyadic& t) {
  return ((numerator << t.places) - denominator * Wide(t.numerator)).sign();
}

}  // namespace

int Polynomial::bits() const {
  int longest = 0;
  for (int i = 0; i <= degree; ++i) longest = std::max(longest, c[i].bits());
  return longest;
}

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

Root RootSolver::isolated_root(const Polynomial& p, double low, double high) {
  Root root;
  root.low = low;
  root.high = high;
  root.polynomial = &p;
  root.sign_below = sign_at_double(p, low);
  return root;
}

namespace {
Root root_at_double(double t) {
  const Dyadic at = dyadic(t);
  Root root;
  root.low = root.high = t;
  root.numerator = Wide(at.numerator);
  root.denominator = Wide(1) << at.places;
  return root;
}
}  // namespace

void RootSolver::add_fraction(Wide numerator, Wide denominator, Root* roots, int& count) {
  if (denominator.sign() < 0) numerator = -numerator, denominator = -denominator;
  if (numerator.sign() < 0 || (denominator - numerator).sign() < 0) return;
  Root& root = roots[count++];
  root = Root{};
  root.numerator = numerator;
  root.denominator = denominator;
  const Wide::Leading top = numerator.leading(), bottom = denominator.leading();
  root.low = root.high =
      top.value == 0
          ? 0
          : std::clamp(std::ldexp(top.value / bottom.value, top.exponent - bottom.exponent), 0.0, 1.0);
  tighten(root);
}

// Of a quadratic the vertex; of a cubic the root of p modulo p', which is the middle of its Hessian.
Turn RootSolver::turn_of(const Polynomial& p) {
  Turn turn;
  const int bits = p.bits() + 3;
  const Wide &d = p.c[0], &c = p.c[1], &b = p.c[2], &a = p.c[3];
  if (p.degree == 2) {
    if (!fits(2 * bits)) return turn;
    turn.discriminant = (squared(c) - (d * b << 2)).sign();
    turn.numerator = -c;
    turn.denominator = b << 1;
  } else {
    if (!fits(4 * bits + 8)) return turn;
    const Wide three(3), nine(9);
    const Wide first = squared(b) - three * (a * c), middle = b * c - nine * (a * d),
               last = squared(c) - three * (b * d);
    turn.discriminant = ((first * last << 2) - squared(middle)).sign();
    turn.numerator = -middle;
    turn.denominator = first << 1;
  }
  if (turn.denominator.sign() < 0) turn.numerator = -turn.numerator, turn.denominator = -turn.denominator;
  return turn;
}

// All roots, where one of them is of even order, or of order 3.
void RootSolver::find_fractions(const Polynomial& p, const Turn& turn, Root* roots, int& count) {
  const Wide &n = turn.numerator, &d = turn.denominator;
  if (d.sign() == 0) {
    add_fraction(-p.c[2], p.c[3] + (p.c[3] << 1), roots, count);  // a triple root
    return;
  }
  add_fraction(n, d, roots, count);
  if (p.degree == 2) return;
  // The sum of the roots is -c2 / c3.
  if (!fits(p.bits() + std::max(n.bits(), d.bits()) + 3)) return;
  add_fraction(-(p.c[2] * d) - (p.c[3] * n << 1), p.c[3] * d, roots, count);
  if (count < 2 || roots[0].low < roots[1].low) return;
  // Of two that tighten to the same double either may be the earlier.
  if (!fits(std::max(roots[0].numerator.bits(), roots[1].numerator.bits()) +
            std::max(roots[0].denominator.bits(), roots[1].denominator.bits())))
    return;
  if (roots[1].low < roots[0].low ||
      (roots[1].numerator * roots[0].denominator - roots[0].numerator * roots[1].denominator).sign() < 0)
    std::swap(roots[0], roots[1]);
}

// Two sign variations between neighbouring doubles: there are two roots if p has the other sign at its turn.
void RootSolver::cut_in_two(const Polynomial& p, const Turn& turn, double low, double high, int sign_below,
                            Root* roots, int& count) {
  const Wide &n = turn.numerator, &d = turn.denominator;
  if (d.sign() == 0 || compared(n, d, {low}) <= 0 || compared(n, d, {high}) >= 0 || gave_up_) {
    gave_up_ = true;
    return;
  }
  int sign = 0;
  if (p.degree == 2) {
    sign = sign_at_fraction(p, n, d);
  } else {
    // There p is p' times (3 c3 x + c2) / (9 c3).
    Polynomial slope;
    slope.c[0] = p.c[1];
    slope.c[1] = p.c[2] << 1;
    slope.c[2] = p.c[3] + (p.c[3] << 1);
    slope.degree = 2;
    sign = sign_at_fraction(slope, n, d) * p.c[3].sign();
    if (gave_up_) return;
    sign *= (slope.c[2] * n + p.c[2] * d).sign();
  }
  if (sign != -sign_below) {
    gave_up_ = true;
    return;
  }
  for (const int side : {-1, 1}) {
    Root& root = roots[count++];
    root = Root{};
    root.low = low;
    root.high = high;
    root.polynomial = &p;
    root.sign_below = -side * sign_below;
    root.numerator = n;
    root.denominator = d;
    root.cut = side;
  }
}

void RootSolver::search(const Polynomial& p, const Turn& turn, double low, double high, Root* roots,
                        int& count, int depth) {
  if (gave_up_) return;
  const Signs signs = bernstein_signs(stretched(p, low, high));
  if (gave_up_) return;
  int most = signs.variations;
  if (turn.discriminant < 0 && most > 1) most -= 2;  // there is no pair of them
  if (most == 0) return;
  if (most == 1) {
    Root& root = roots[count++];
    root = Root{};
    root.low = low;
    root.high = high;
    root.polynomial = &p;
    root.sign_below = signs.first;
    return;
  }
  if (most == 2 && rank_of(high) - rank_of(low) == 1) {
    cut_in_two(p, turn, low, high, signs.first, roots, count);
    return;
  }
  const double middle = low + (high - low) / 2;
  if (depth == kDeepestSearch || !(middle > low && middle < high)) {
    gave_up_ = true;
    return;
  }
  search(p, turn, low, middle, roots, count, depth + 1);
  if (!gave_up_ && sign_at_double(p, middle) == 0) roots[count++] = root_at_double(middle);
  search(p, turn, middle, high, roots, count, depth + 1);
}

int RootSolver::find_roots(const Polynomial& p, Root* roots) {
  int count = 0;
  if (p.degree == 0) return 0;
  const Signs whole = bernstein_signs(p);
  Turn turn;
  if (whole.variations > 1) {
    turn = turn_of(p);
    if (gave_up_) return 0;
    if (turn.discriminant == 0) {
      find_fractions(p, turn, roots, count);
      return count;
    }
  }
  if (p.c[0].sign() == 0) roots[count++] = root_at_double(0);

  // Cut near the critical points, and round the turn.
  double cut[6] = {0, 1};
  int cuts = 1;
  if (turn.discriminant > 0) {
    const auto add = [&](double at) {
      if (!(at > 0 && at < 1) || std::find(cut + 1, cut + cuts, at) != cut + cuts) return;
      int place = cuts++;
      for (; place > 1 && cut[place - 1] > at; --place) cut[place] = cut[place - 1];
      cut[place] = at;
    };
    const Rounded r = rounded(p);
    const double a = 3 * r.c[3], b = r.c[2], c = r.c[1];  // p' = a s^2 + 2 b s + c
    const double q = -(b + std::copysign(std::sqrt(std::max(0.0, b * b - a * c)), b));
    add(q / a);
    add(c / q);
    Root at_turn;
    int turns = 0;
    if (turn.denominator.sign() != 0) add_fraction(turn.numerator, turn.denominator, &at_turn, turns);
    if (turns > 0) add(at_turn.low), add(at_turn.high);
    cut[cuts] = 1;
  }
  for (int i = 0; i < cuts; ++i) {
    if (i > 0 && sign_at_double(p, cut[i]) == 0) roots[count++] = root_at_double(cut[i]);
    search(p, turn, cut[i], cut[i + 1], roots, count, 0);
    if (gave_up_) return 0;
  }
  if (sign_at_double(p, 1) == 0) roots[count++] = root_at_double(1);
  return count;
}

void RootSolver::tighten(Root& root) {
  if (root.polynomial == nullptr) {
    // A fraction near a double: step until it is enclosed.
    const auto side = [&](double t) {
      const Dyadic at = dyadic(t);
      if (!fits(std::max(root.numerator.bits() + at.places, root.denominator.bits() + 64) + 2)) return 0;
      return compare(root.numerator, root.denominator, at);
    };
    if (root.low == root.high) {
      double t = root.low;
      int s = side(t);
      while (s < 0 && !gave_up_) s = side(t = std::nextafter(t, 0.0));
      if (s == 0) {
        root.low = root.high = t;
        return;
      }
      double above = std::nextafter(t, 2.0);
      while (!gave_up_ && (s = side(above)) > 0) t = above, above = std::nextafter(t, 2.0);
      root.low = s == 0 ? above : t;
      root.high = above;
    }
    return;
  }
  if (rank_of(root.high) - rank_of(root.low) <= 1 || gave_up_) return;
  const Polynomial near = stretched(*root.polynomial, root.low, root.high);
  if (gave_up_) return;
  const double guess = root.low + (root.high - root.low) * approximate_root(near, root.sign_below);
  std::uint64_t low = rank_of(root.low), high = rank_of(root.high);
  const auto probe = [&](std::uint64_t rank) {
    const int sign = sign_at_double(*root.polynomial, at_rank(rank));
    const int side = sign == 0 ? 0 : sign == root.sign_below ? 1 : -1;
    if (side >= 0) low = rank;
    if (side <= 0) high = rank;
    return side;
  };
  // From the guess outwards in growing steps until the root is overtaken.
  const int direction = probe(std::clamp(rank_of(guess), low + 1, high - 1));
  for (std::uint64_t step = 1; direction != 0 && step < high - low && !gave_up_; step *= 8) {
    const std::uint64_t next = direction > 0 ? low + step : high - step;
    if (probe(next) != direction) break;
  }
  while (high - low > 1 && !gave_up_) probe(low + (high - low) / 2);
  if (gave_up_) return;
  root.low = at_rank(low);
  root.high = at_rank(high);
  if (low == high) root = root_at_double(root.low);
}

// numerator / denominator, which is positive, against a bound: -1, 0 or 1.
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

// The sign of q at an isolated root between bounds between which, and at
// which, q has at most one root, and that simple.
int RootSolver::sign_at_side(const Polynomial& q, const Root& root, const Bound& low, const Bound& high) {
  const Polynomial& p = *root.polynomial;
  const int below = sign_at_bound(q, low), above = sign_at_bound(q, high);
  if (below * above >= 0) return below != 0 ? below : above;
  // q has a root there, x. What is the sign of p at x?
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
    if (p.degree == 2 && q.c[2].sign() < 0) r0 = -r0, r1 = -r1;  // else the multiple is positive
    sign = r1.sign();
    if (sign == 0) {
      sign = r0.sign();
    } else {
      Wide numerator = -r0, denominator = r1;
      if (sign < 0) numerator = -numerator, denominator = -denominator;
      // x against the root of the remainder.
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
