// Roots of integer polynomials of degree at most 3, for the integer stage of `filtered_exact`.
//
// Isolation starts with Descartes' rule (sign variations of the Bernstein coefficients on a piece), which
// says "none", "one", or nothing. If it says nothing, the discriminant tells whether there can be more than
// one root. If the discriminant is zero, the root of even order is a fraction, and so are all roots.
// Otherwise [0, 1] is cut near the critical points and near the fraction that would be the double root (the
// turn, integer_roots.h), and then halved. Two roots between neighbouring doubles lie on either side of
// that fraction.
//
// Floating-point guesses decide how soon an answer comes, never what the answer is: every sign is computed in
// integers.
//
// The oracle (algebraic.h) shares no code with this file, so that each can be tested against the other.
#include "core/elementary/certified/integer_roots.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace cscd::integer {

int Polynomial::bits() const {
  int longest = 0;
  for (int i = 0; i <= degree; ++i) longest = std::max(longest, c[i].bits());
  return longest;
}

Dyadic dyadic(double t) {
  if (t == 0) return {0, 0};
  int exponent = 0;
  auto numerator = static_cast<std::int64_t>(std::ldexp(std::frexp(t, &exponent), 53));
  const int spare = std::countr_zero(static_cast<std::uint64_t>(numerator));
  return {numerator >> spare, 53 - exponent - spare};
}

int compare(const Wide& numerator, const Wide& denominator, const Dyadic& t) {
  return ((numerator << t.places) - denominator * Wide(t.numerator)).sign();
}

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

namespace {

// The most halvings of a piece while two roots are not told apart.
constexpr int kDeepestSearch = 100;

// The rank of a double t >= 0 among all doubles. Doubles that are not negative are ordered like their bit
// patterns.
std::uint64_t rank_of(double t) {
  return std::bit_cast<std::uint64_t>(t + 0.0);
}
double at_rank(std::uint64_t rank) {
  return std::bit_cast<double>(rank);
}

// Approximates the only root of p in (0, 1). `sign_at_0` is the sign of p at 0.
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
    // After 12 steps without an end, every other step halves the bracket.
    s = step < 12 || step % 2 == 0 ? next : 0.5 * (low + high);
  }
  return std::clamp(s, 0.0, 1.0);
}

Wide squared(const Wide& a) {
  return a * a;
}

Root root_at_double(double t) {
  const Dyadic at = dyadic(t);
  Root root;
  root.low = root.high = t;
  root.numerator = Wide(at.numerator);
  root.denominator = Wide(1) << at.places;
  return root;
}

}  // namespace

Root RootSolver::isolated_root(const Polynomial& p, double low, double high) {
  Root root;
  root.low = low;
  root.high = high;
  root.polynomial = &p;
  root.sign_below = sign_at_double(p, low);
  return root;
}

// Appends the root numerator / denominator to `roots`, tightened, if it is in [0, 1].
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

// The turn of a quadratic is its vertex. The turn of a cubic p is the root of p modulo p', which is the
// middle of p's Hessian.
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

// Finds all roots of a polynomial with discriminant zero: one root is of even order, or of order 3.
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
  // If both roots tighten to the same double, either of them may be the earlier root.
  if (!fits(std::max(roots[0].numerator.bits(), roots[1].numerator.bits()) +
            std::max(roots[0].denominator.bits(), roots[1].denominator.bits())))
    return;
  if (roots[1].low < roots[0].low ||
      (roots[1].numerator * roots[0].denominator - roots[0].numerator * roots[1].denominator).sign() < 0)
    std::swap(roots[0], roots[1]);
}

// Finds the roots between two neighbouring doubles where p has two sign variations. There are two roots if
// the sign of p at its turn differs from the sign just above `low`; otherwise the solver gives up.
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
    // At the turn x the value of p is p' times (3 c3 x + c2) / (9 c3).
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

// Appends the roots in the open interval (low, high) to `roots`, in ascending order.
void RootSolver::search(const Polynomial& p, const Turn& turn, double low, double high, Root* roots,
                        int& count, int depth) {
  if (gave_up_) return;
  const Signs signs = bernstein_signs(stretched(p, low, high));
  if (gave_up_) return;
  int most = signs.variations;
  if (turn.discriminant < 0 && most > 1) most -= 2;  // two of the roots are not real
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

  // Cut near the critical points, and at the doubles round the turn.
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
    // The fraction is near root.low: step from there until two neighbouring doubles enclose the fraction.
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
  // Step from the guess towards the root, in growing steps, until the root is overtaken.
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

}  // namespace cscd::integer
