// Roots of integer polynomials of degree at most 3, for the integer stage of `filtered_exact`.
//
// Isolation: [0, 1] is cut near the critical points and then halved, until Descartes' rule (sign variations
// of the Bernstein coefficients on the piece) says "none" or "one". Roots of even order, where that would not
// end, are fractions, and so are then all roots: those are found by Euclid's algorithm. The floating-point
// guesses decide how soon an answer comes, never what it is: every sign is computed in integers.
//
// Sign of q at an isolated root of p: certain if q has no sign variation between the neighbouring doubles
// that enclose the root. Otherwise Euclid's algorithm tells whether the root is shared, and if it is not,
// halving below the spacing of doubles ends.
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

// Halving below the spacing of doubles is given up here; the referee goes on.
constexpr int kDeepest = 400;
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
  if (!fits(p.bits() + 3 * std::max(numerator.bits(), denominator.bits()) + 8)) return 0;
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

// Only called where Descartes' rule leaves more than one root. If one of them is of even order all roots are
// fractions. Returns true when that was so.
bool RootSolver::find_fractions(const Polynomial& p, Root* roots, int& count) {
  const int bits = p.bits() + 2;
  Wide numerator[2], denominator[2];
  int found = 0;
  if (p.degree == 2) {
    if (!fits(2 * bits + 4)) return false;
    if ((squared(p.c[1]) - (p.c[0] * p.c[2] << 2)).sign() != 0) return false;
    numerator[found] = -p.c[1];
    denominator[found++] = p.c[2] << 1;
  } else {
    if (!fits(8 * bits + 16)) return false;
    Polynomial slope;
    slope.c[0] = p.c[1];
    slope.c[1] = p.c[2] << 1;
    slope.c[2] = p.c[3] + (p.c[3] << 1);
    slope.degree = 2;
    const auto [r0, r1] = remainder(p, slope);
    if (r1.sign() == 0) {
      if (r0.sign() != 0) return false;
      numerator[found] = -p.c[2];  // a triple root
      denominator[found++] = slope.c[2];
    } else {
      Wide n = -r0, d = r1;
      if (d.sign() < 0) n = -n, d = -d;
      if (sign_at_fraction(slope, n, d) != 0) return false;
      numerator[found] = n;
      denominator[found++] = d;
      // The sum of the roots is -c2 / c3.
      numerator[found] = -(p.c[2] * d) - (p.c[3] * n << 1);
      denominator[found++] = p.c[3] * d;
    }
  }
  for (int i = 0; i < found; ++i) {
    Wide n = numerator[i], d = denominator[i];
    if (d.sign() < 0) n = -n, d = -d;
    if (n.sign() < 0 || (d - n).sign() < 0) continue;
    Root& root = roots[count++];
    root = Root{};
    root.numerator = n;
    root.denominator = d;
    const Wide::Leading top = n.leading(), bottom = d.leading();
    const double near =
        top.value == 0
            ? 0
            : std::clamp(std::ldexp(top.value / bottom.value, top.exponent - bottom.exponent), 0.0, 1.0);
    root.low = root.high = near;
    tighten(root);
  }
  // Two that tighten to the same double are in the right order, too, or nearly: the time is the same.
  if (count == 2 && roots[1].low < roots[0].low) std::swap(roots[0], roots[1]);
  if (count == 2 && roots[1].low == roots[0].low &&
      ((roots[1].numerator * roots[0].denominator) - (roots[0].numerator * roots[1].denominator)).sign() < 0)
    std::swap(roots[0], roots[1]);
  return true;
}

void RootSolver::search(const Polynomial& p, double low, double high, Root* roots, int& count, int depth) {
  if (gave_up_) return;
  const Signs signs = bernstein_signs(stretched(p, low, high));
  if (gave_up_ || signs.variations == 0) return;
  if (signs.variations == 1) {
    Root& root = roots[count++];
    root = Root{};
    root.low = low;
    root.high = high;
    root.polynomial = &p;
    root.sign_below = signs.first;
    return;
  }
  const double middle = low + (high - low) / 2;
  if (depth == kDeepestSearch || !(middle > low && middle < high)) {
    gave_up_ = true;
    return;
  }
  search(p, low, middle, roots, count, depth + 1);
  if (!gave_up_ && sign_at_double(p, middle) == 0) roots[count++] = root_at_double(middle);
  search(p, middle, high, roots, count, depth + 1);
}

int RootSolver::find_roots(const Polynomial& p, Root* roots) {
  int count = 0;
  if (p.degree == 0) return 0;
  const Signs whole = bernstein_signs(p);
  if (whole.variations > 1 && find_fractions(p, roots, count)) return count;
  if (gave_up_) return 0;
  if (p.c[0].sign() == 0) roots[count++] = root_at_double(0);

  // Cut near the critical points.
  double cut[4] = {0, 1, 1, 1};
  int cuts = 1;
  if (whole.variations > 1) {
    const Rounded r = rounded(p);
    const double a = 3 * r.c[3], b = r.c[2], c = r.c[1];  // p' = a s^2 + 2 b s + c
    const double q = -(b + std::copysign(std::sqrt(std::max(0.0, b * b - a * c)), b));
    double s[2] = {q / a, c / q};
    if (s[1] < s[0]) std::swap(s[0], s[1]);
    for (const double at : s)
      if (at > cut[cuts - 1] && at < 1) cut[cuts++] = at;
  }
  cut[cuts] = 1;
  for (int i = 0; i < cuts; ++i) {
    if (i > 0 && sign_at_double(p, cut[i]) == 0) roots[count++] = root_at_double(cut[i]);
    search(p, cut[i], cut[i + 1], roots, count, 0);
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

bool RootSolver::shares_root(const Polynomial& q, const Root& root) {
  const Polynomial& p = *root.polynomial;
  if (q.degree == 0) return false;
  // Is the only common root of p and q, a fraction, this root?
  const auto inside = [&](Wide numerator, Wide denominator) {
    if (denominator.sign() < 0) numerator = -numerator, denominator = -denominator;
    if (sign_at_fraction(q, numerator, denominator) != 0) return false;
    if (sign_at_fraction(p, numerator, denominator) != 0) return false;
    const Dyadic low = dyadic(root.low), high = dyadic(root.high);
    if (!fits(std::max(numerator.bits(), denominator.bits()) + std::max(low.places, high.places) + 2))
      return false;
    return compare(numerator, denominator, low) > 0 && compare(numerator, denominator, high) < 0;
  };
  if (q.degree == 1) return inside(-q.c[0], q.c[1]);
  if (!fits(p.bits() + 2 * q.bits() + 8)) return false;
  if (p.degree == 1) return inside(-p.c[0], p.c[1]);
  const auto [r0, r1] = remainder(p, q);
  if (r1.sign() != 0) return inside(-r0, r1);
  if (r0.sign() != 0) return false;
  // q divides p.
  return bernstein_signs(stretched(q, root.low, root.high)).variations == 1;
}

int RootSolver::sign_at(const Polynomial& q, Root& root) {
  if (q.degree <= 0) return q.is_zero() ? 0 : q.c[0].sign();
  if (root.polynomial == nullptr) return sign_at_fraction(q, root.numerator, root.denominator);
  if (!root.deep) {
    const Signs signs = bernstein_signs(stretched(q, root.low, root.high));
    if (gave_up_) return 0;
    if (signs.variations == 0) return signs.first;
    if (shares_root(q, root) || gave_up_) return 0;
    tighten(root);
    if (gave_up_) return 0;
    if (root.polynomial == nullptr) return sign_at_fraction(q, root.numerator, root.denominator);
    // Neighbouring doubles: one unit apart at the places of their spacing.
    const Dyadic low = dyadic(root.low), high = dyadic(root.high);
    root.places = std::max(low.places, high.places);
    root.numerator = Wide(low.numerator) << root.places - low.places;
    root.deep = true;
  } else if (shares_root(q, root) || gave_up_) {
    return 0;
  }
  const Polynomial& p = *root.polynomial;
  for (int depth = 0; depth < kDeepest; ++depth) {
    if (!fits(std::max(p.bits(), q.bits()) + 3 * (root.places + 2) + 16)) return 0;
    const Signs signs = bernstein_signs(stretched_by(q, root.numerator, Wide(1), root.places));
    if (signs.variations == 0) return signs.first;
    root.numerator = root.numerator << 1;
    ++root.places;
    const Wide middle = root.numerator + Wide(1);
    const int sign = stretched_by(p, middle, Wide(1), root.places).c[0].sign();
    if (sign == 0) {
      root.polynomial = nullptr;
      root.numerator = middle;
      root.denominator = Wide(1) << root.places;
      return sign_at_fraction(q, root.numerator, root.denominator);
    }
    if (sign == root.sign_below) root.numerator = middle;
  }
  gave_up_ = true;
  return 0;
}

}  // namespace cscd::integer
