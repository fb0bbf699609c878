// Real roots in [0, 1] of integer polynomials, and exact signs at them.
//
// Isolation works on the square-free part of a polynomial, which has simple roots only. It halves intervals
// until Descartes' rule (sign variations of the Bernstein coefficients) says "none" or "one". This ends,
// because all roots are simple. A split point that is a root is recorded as a dyadic number and divided
// out. So every root is found once, whatever the coefficients are.
//
// The sign of g at a root alpha of f is 0 if and only if gcd(f, g) changes sign across alpha's interval.
// Otherwise the interval is narrowed until g keeps one sign on it.
//
// Narrowing starts from a floating-point guess and tests its neighbours exactly. A bad guess costs time,
// but it never makes an answer wrong. A root whose coefficients have a few hundred bits takes one to ten
// microseconds.
#include "core/elementary/exact/algebraic.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <utility>

namespace cscd::exact {
namespace {

// The rank of a double x >= 0 among all doubles. Doubles that are not negative are ordered like their bit
// patterns.
std::uint64_t to_rank(double x) {
  return std::bit_cast<std::uint64_t>(x + 0.0);
}
double from_rank(std::uint64_t rank) {
  return std::bit_cast<double>(rank);
}

Polynomial square_free_part(const Polynomial& p) {
  const Polynomial repeated = greatest_common_divisor(p, p.derivative());
  return repeated.degree() > 0 ? exact_quotient(p, repeated) : p;
}

// The primitive linear polynomial with the root t.
Polynomial linear_factor(const Dyadic& t) {
  return {-t.numerator, Integer(1) << t.exponent};
}

struct Interval {
  Dyadic lower, upper;
};

}  // namespace

AlgebraicNumber::AlgebraicNumber(Dyadic value) : lower_(value), upper_(std::move(value)) {}

AlgebraicNumber::AlgebraicNumber(Polynomial polynomial, Dyadic lower, Dyadic upper)
    : polynomial_(std::move(polynomial)),
      lower_(std::move(lower)),
      upper_(std::move(upper)),
      sign_below_(sign_at(polynomial_, lower_)) {
  assert(sign_below_ != 0 && sign_at(polynomial_, upper_) == -sign_below_);
}

void AlgebraicNumber::become(Dyadic value) {
  lower_ = value;
  upper_ = std::move(value);
  polynomial_ = {};
}

void AlgebraicNumber::move_end(const Dyadic& to, int sign_there) {
  if (sign_there == 0) {
    become(to);
  } else if (sign_there == sign_below_) {
    lower_ = to;
  } else {
    upper_ = to;
  }
}

void AlgebraicNumber::bisect() {
  if (is_dyadic()) return;
  const Dyadic middle = midpoint(lower_, upper_);
  move_end(middle, sign_at(polynomial_, middle));
}

int AlgebraicNumber::compare_to(const Dyadic& t) const {
  if (is_dyadic()) return compare(lower_, t);
  if (compare(t, lower_) <= 0) return 1;
  if (compare(t, upper_) >= 0) return -1;
  const int sign = sign_at(polynomial_, t);
  return sign == 0 ? 0 : sign == sign_below_ ? 1 : -1;
}

bool AlgebraicNumber::isolated_below(const AlgebraicNumber& other) const {
  if (other.is_dyadic()) return compare_to(other.lower_) < 0;
  if (is_dyadic()) return other.compare_to(lower_) > 0;
  return compare(lower_, other.lower_) < 0;
}

double AlgebraicNumber::guess() const {
  const Polynomial f = polynomial_.stretched(lower_, upper_);
  std::array<double, Polynomial::kMaxDegree + 1> c{};
  std::array<long, Polynomial::kMaxDegree + 1> exponent{};
  long largest = 0;
  for (std::size_t i = 0; i < c.size(); ++i) {
    c[i] = truncated(f[static_cast<int>(i)], exponent[i]);
    largest = std::max(largest, exponent[i]);
  }
  for (std::size_t i = 0; i < c.size(); ++i)
    c[i] = std::ldexp(c[i], static_cast<int>(std::max(exponent[i] - largest, -2000L)));
  double low = 0, high = 1;
  for (int step = 0; step < 64; ++step) {
    const double s = 0.5 * (low + high);
    if (s == low || s == high) break;
    double value = 0;
    for (auto i = static_cast<std::size_t>(f.degree() + 1); i-- > 0;) value = value * s + c[i];
    (value > 0) == (sign_below_ > 0) ? low = s : high = s;
  }
  const double from = double_below(lower_), to = double_above(upper_);
  return from + (to - from) * high;
}

void AlgebraicNumber::tighten() {
  if (tight_) return;
  tight_ = true;
  double low = double_below(lower_), high = double_above(upper_);
  const auto probe = [&](std::uint64_t rank) {
    const double t = from_rank(rank);
    const Dyadic exact_t = dyadic(t);
    const int side = compare_to(exact_t);
    if (compare(exact_t, lower_) > 0 && compare(exact_t, upper_) < 0)
      move_end(exact_t, side == 0 ? 0 : side > 0 ? sign_below_ : -sign_below_);
    if (side >= 0) low = t;
    if (side <= 0) high = t;
    return side;
  };
  const auto gap = [&] { return to_rank(high) - to_rank(low); };
  if (!is_dyadic() && gap() > 1) {
    // Step from the guess towards the root, in growing steps, until the root is overtaken.
    const std::uint64_t start =
        std::clamp(to_rank(std::clamp(guess(), low, high)), to_rank(low) + 1, to_rank(high) - 1);
    const int direction = probe(start);
    for (std::uint64_t step = 1; direction != 0 && step < gap(); step *= 4) {
      const std::uint64_t next = direction > 0 ? to_rank(low) + step : to_rank(high) - step;
      if (probe(next) != direction) break;
    }
    while (gap() > 1) probe(to_rank(low) + gap() / 2);
  }
  enclosure_ = {low, high};
}

TimeEnclosure AlgebraicNumber::enclosure() {
  tighten();
  return enclosure_;
}

int AlgebraicNumber::sign_of(const Polynomial& p) {
  if (p.degree() <= 0) return p[0].sign();
  const auto certain_sign = [&] {  // 0 if not certain
    if (is_dyadic()) return sign_at(p, lower_);
    const UnitIntervalSigns signs = signs_on_unit_interval(p.stretched(lower_, upper_));
    return signs.variations == 0 ? signs.sign : 0;
  };
  if (const int sign = certain_sign(); sign != 0 || is_dyadic()) return sign;
  if (!tight_) {
    tighten();
    if (const int sign = certain_sign(); sign != 0 || is_dyadic()) return sign;
  }
  const Polynomial shared = greatest_common_divisor(polynomial_, p);
  // `shared` divides polynomial_. So it has at most one root inside the interval, which is simple, and no
  // root at the ends.
  if (shared.degree() > 0 && sign_at(shared, lower_) != sign_at(shared, upper_)) return 0;
  for (int steps = 4;; steps *= 2) {
    for (int i = 0; i < steps; ++i) bisect();
    if (const int sign = certain_sign(); sign != 0) return sign;
  }
}

std::vector<AlgebraicNumber> roots_in_unit_interval(const Polynomial& polynomial) {
  assert(!polynomial.is_zero());
  const Dyadic zero{}, one{Integer(1), 0};
  std::vector<AlgebraicNumber> roots;
  Polynomial f = polynomial;
  for (const Dyadic* end : {&zero, &one}) {
    if (sign_at(f, *end) != 0) continue;
    roots.emplace_back(*end);
    while (sign_at(f, *end) == 0) f = exact_quotient(f, linear_factor(*end));
  }

  std::vector<Interval> isolating;
  const int variations = signs_on_unit_interval(f).variations;
  if (variations == 1) isolating.push_back({zero, one});
  if (variations > 1) {
    f = square_free_part(f);
    std::vector<Interval> open{{zero, one}};
    while (!open.empty()) {
      const Interval interval = std::move(open.back());
      open.pop_back();
      const int count = signs_on_unit_interval(f.stretched(interval.lower, interval.upper)).variations;
      if (count == 1) isolating.push_back(interval);
      if (count <= 1) continue;
      const Dyadic middle = midpoint(interval.lower, interval.upper);
      if (sign_at(f, middle) == 0) {
        // Divide the root out and start again, so that no interval ever ends in a root.
        roots.emplace_back(middle);
        f = exact_quotient(f, linear_factor(middle));
        isolating.clear();
        open.assign(1, {zero, one});
      } else {
        open.push_back({interval.lower, middle});
        open.push_back({middle, interval.upper});
      }
    }
  }
  for (const Interval& interval : isolating) roots.emplace_back(f, interval.lower, interval.upper);
  std::sort(roots.begin(), roots.end(), [](const auto& a, const auto& b) { return a.isolated_below(b); });
  return roots;
}

}  // namespace cscd::exact
