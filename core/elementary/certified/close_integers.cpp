// The stage of integers at a distance.
//
// The start. Let a case of nearest features have its dimension and hold its nearest points x and y inside,
// and let no point of either feature lie before the plane at right angles to x - y through its own point.
// These planes part the features, so |x - y| is their distance, and the sign of the case's `beyond` decides.
// If the likely case does not show that, the features are close exactly if some case holds its nearest points
// inside and is not beyond r.
//
// The motion. The earliest time at which features become close is a root of a case's polynomial at which no
// `inside` is negative (exact/closeness.cpp). The stage halves [0, 1] into cells, from left to right, and
// drops a cell in which Descartes' rule finds no root, or in which some `inside` is negative throughout. A
// cell with one root in which no `inside` is negative holds the time. Cells that stay undecided, such as
// those round a double root, make the stage give up.
#include "core/elementary/certified/close_integers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "core/elementary/certified/scaled.h"
#include "core/elementary/certified/wide.h"
#include "core/elementary/exact/closeness_cases.h"

namespace cscd::integer {
namespace {

using exact::CloseCase;
using exact::PointOf;

using Number = WideOf<32>;
// With so many places between the lowest and the highest bit, a coefficient has 6 kMostSpan + 26 bits at
// most. A cell adds as many bits as the degree times its halvings, and 32 for sums and factorials.
constexpr int kMostSpan = 270;
// A root of a case comes to be alone in its cell, and signs at it certain, after few halvings, or for
// features that graze the distance never.
constexpr int kMostHalvings = 24;
constexpr int kMostDegree = 6;
static_assert(6 * kMostSpan + 26 + kMostDegree * kMostHalvings + 32 <= Number::kBits);

// c[0] + c[1] t + ... with integer coefficients.
struct TimePolynomial {
  Number c[kMostDegree + 1];
  int degree = -1;  // -1 for zero

  bool is_zero() const { return degree < 0; }
  void trim() {
    while (degree >= 0 && c[degree].sign() == 0) --degree;
  }
  int bits() const {
    int most = 0;
    for (int i = 0; i <= degree; ++i) most = std::max(most, c[i].bits());
    return most;
  }
};
template <class Combine>
TimePolynomial combined(const TimePolynomial& a, const TimePolynomial& b, const Combine& combine) {
  TimePolynomial result;
  result.degree = std::max(a.degree, b.degree);
  const Number zero;
  for (int i = 0; i <= result.degree; ++i)
    result.c[i] = combine(i <= a.degree ? a.c[i] : zero, i <= b.degree ? b.c[i] : zero);
  result.trim();
  return result;
}
TimePolynomial operator+(const TimePolynomial& a, const TimePolynomial& b) {
  return combined(a, b, [](const Number& x, const Number& y) { return x + y; });
}
TimePolynomial operator-(const TimePolynomial& a, const TimePolynomial& b) {
  return combined(a, b, [](const Number& x, const Number& y) { return x - y; });
}
TimePolynomial operator*(const TimePolynomial& a, const TimePolynomial& b) {
  TimePolynomial result;
  if (a.is_zero() || b.is_zero()) return result;
  result.degree = a.degree + b.degree;
  for (int k = 0; k <= result.degree; ++k) {
    Number sum;
    for (int i = std::max(0, k - b.degree); i <= std::min(k, a.degree); ++i) sum = sum + a.c[i] * b.c[k - i];
    result.c[k] = sum;
  }
  return result;  // the leading coefficient of a product is not zero
}

// The points of a query and r, scaled to integers by one power of two.
struct Scene {
  Scaled start[4][3], end[4][3], r;
  BitSpan span;

  Scene(const std::array<const MovingPoint*, 4>& points, double distance) : r(scaled(distance)) {
    for (std::size_t i = 0; i < 4; ++i)
      for (int k = 0; k < 3; ++k) {
        span.add(start[i][k] = scaled(points[i]->start[k]));
        span.add(end[i][k] = scaled(points[i]->end[k]));
      }
    span.add(r);
  }
  bool fits() const { return span.bits() <= kMostSpan; }
  Number integer(const Scaled& x) const {
    return x.mantissa == 0 ? Number() : Number(x.mantissa) << (x.exponent - span.lowest());
  }
  Number r_squared() const {
    const Number length = integer(r);
    return length * length;
  }
  std::array<PointOf<Number>, 4> at(const Scaled (&places)[4][3]) const {
    std::array<PointOf<Number>, 4> points;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < 3; ++k) points[i][k] = integer(places[i][k]);
    return points;
  }
  std::array<PointOf<TimePolynomial>, 4> in_motion() const {
    std::array<PointOf<TimePolynomial>, 4> points;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        TimePolynomial& x = points[i][k];
        x.c[0] = integer(start[i][k]);
        x.c[1] = integer(end[i][k]) - x.c[0];
        x.degree = 1;
        x.trim();
      }
    return points;
  }
};

struct VertexFaceCases {
  static constexpr int count = exact::kVertexFaceCases;
  template <class Of>
  static CloseCase<Of> at(int number, const std::array<PointOf<Of>, 4>& points, const Of& rr) {
    return exact::vertex_face_case(number, points, rr);
  }
};
struct EdgeEdgeCases {
  static constexpr int count = exact::kEdgeEdgeCases;
  template <class Of>
  static CloseCase<Of> at(int number, const std::array<PointOf<Of>, 4>& points, const Of& rr) {
    return exact::edge_edge_case(number, points, rr);
  }
};

// Whether the case has its dimension and holds its nearest points inside.
bool decides(const CloseCase<Number>& which) {
  if (which.insides > 0 && which.whole.sign() == 0) return false;
  return std::all_of(which.inside.begin(), which.inside.begin() + which.insides,
                     [](const Number& side) { return side.sign() >= 0; });
}
bool is_nearest(const CloseCase<Number>& which) {
  return decides(which) && std::all_of(which.elsewhere.begin(), which.elsewhere.begin() + which.elsewheres,
                                       [](const Number& side) { return side.sign() <= 0; });
}

template <class Cases>
Outcome closeness_at_start(const Scene& scene, int likely) {
  if (!scene.fits()) return Outcome::gave_up;
  const std::array<PointOf<Number>, 4> points = scene.at(scene.start);
  const Number rr = scene.r_squared();
  const CloseCase<Number> first = Cases::at(likely, points, rr);
  if (is_nearest(first)) return first.beyond.sign() <= 0 ? Outcome::contact : Outcome::apart;
  for (int i = 0; i < Cases::count; ++i) {
    const CloseCase<Number> which = Cases::at(i, points, rr);
    if (which.beyond.sign() <= 0 && decides(which)) return Outcome::contact;
  }
  return Outcome::apart;
}

template <class Cases>
bool at_distance_at_end(const Scene& scene, int likely) {
  if (!scene.fits()) return false;
  const CloseCase<Number> which = Cases::at(likely, scene.at(scene.end), scene.r_squared());
  return which.beyond.sign() == 0 && is_nearest(which);
}

// The times from index / 2^halvings to (index + 1) / 2^halvings.
struct DyadicInterval {
  std::int64_t index = 0;
  int halvings = 0;

  double low() const { return std::ldexp(static_cast<double>(index), -halvings); }
  double high() const { return std::ldexp(static_cast<double>(index + 1), -halvings); }
  bool is_last() const { return index + 1 == std::int64_t{1} << halvings; }
  void halve() { index *= 2, ++halvings; }
  // The cell behind this one, of those that are not halved yet.
  void advance() {
    for (++index; index % 2 == 0 && halvings > 0; --halvings) index /= 2;
  }
};

// The Bernstein coefficients of a polynomial on a cell, times a positive number.
struct Control {
  Number b[kMostDegree + 1];
  int degree = -1;

  int sign(int i) const { return degree < 0 ? 0 : b[i].sign(); }
  int at_low() const { return sign(0); }
  int at_high() const { return sign(degree < 0 ? 0 : degree); }
  int variations() const {
    int count = 0, last = 0;
    for (int i = 0; i <= degree; ++i) {
      const int now = sign(i);
      count += now * last < 0;
      if (now != 0) last = now;
    }
    return count;
  }
  // The sign just behind the cell's beginning.
  int first_sign() const {
    for (int i = 0; i <= degree; ++i)
      if (sign(i) != 0) return sign(i);
    return 0;
  }
  bool has(int wanted) const {
    for (int i = 0; i <= degree; ++i)
      if (sign(i) == wanted) return true;
    return false;
  }
};

bool fits(const TimePolynomial& p, int places) {
  return p.bits() + p.degree * places + 32 <= Number::kBits;
}

Control control_on(const TimePolynomial& p, const DyadicInterval& cell) {
  constexpr std::int64_t kFactorial[] = {1, 1, 2, 6, 24, 120, 720};
  const int n = p.degree;
  Control result;
  result.degree = n;
  if (n < 0) return result;
  // 2^(n halvings) p((index + s) / 2^halvings) in s, by Horner's scheme.
  Number c[kMostDegree + 1];
  for (int k = 0; k <= n; ++k) c[k] = p.c[k] << cell.halvings * (n - k);
  if (cell.index != 0) {
    const Number index(cell.index);
    for (int from = 0; from < n; ++from)
      for (int k = n - 1; k >= from; --k) c[k] = c[k] + index * c[k + 1];
  }
  // n! times the coefficient i is the sum of (i over k) / (n over k) n! c[k], which sums of neighbours give.
  for (int k = 0; k <= n; ++k) c[k] = c[k] * Number(kFactorial[k] * kFactorial[n - k]);
  for (int from = 0; from <= n; ++from) {
    result.b[from] = c[0];
    for (int k = 0; k < n - from; ++k) c[k] = c[k] + c[k + 1];
  }
  return result;
}

int sign_at(const TimePolynomial& p, const Scaled& t) {
  const Number at(t.mantissa);
  Number value = p.c[p.degree];
  for (int k = p.degree - 1; k >= 0; --k) value = value * at + (p.c[k] << -t.exponent * (p.degree - k));
  return value.sign();
}

std::uint64_t to_rank(double x) {
  return std::bit_cast<std::uint64_t>(x);
}
double from_rank(std::uint64_t rank) {
  return std::bit_cast<double>(rank);
}

// Where in the cell, from 0 to 1, the polynomial changes its sign, without a promise.
double guess_root(const Control& control) {
  double b[kMostDegree + 1];
  int exponent[kMostDegree + 1], largest = -(1 << 20);
  for (int i = 0; i <= control.degree; ++i) {
    const Number::Leading leading = control.b[i].leading();
    b[i] = leading.value, exponent[i] = leading.exponent;
    if (b[i] != 0) largest = std::max(largest, exponent[i]);
  }
  for (int i = 0; i <= control.degree; ++i) b[i] = std::ldexp(b[i], std::max(exponent[i] - largest, -2000));
  const bool falls = control.first_sign() > 0;
  double low = 0, high = 1;
  for (int step = 0; step < 60; ++step) {
    const double s = 0.5 * (low + high);
    double x[kMostDegree + 1];
    std::copy_n(b, control.degree + 1, x);
    for (int n = control.degree; n > 0; --n)
      for (int i = 0; i < n; ++i) x[i] = (1 - s) * x[i] + s * x[i + 1];
    ((x[0] > 0) == falls ? low : high) = s;
  }
  return high;
}

// The largest double not above the only root of p within the cell, where `control` has one variation.
Result time_within(const TimePolynomial& p, const DyadicInterval& cell, const Control& control) {
  double low = cell.low(), high = cell.high();
  const int below = control.first_sign();
  const auto gap = [&] { return to_rank(high) - to_rank(low); };
  const double guess = low + (high - low) * guess_root(control);
  std::uint64_t next = std::clamp(to_rank(guess), to_rank(low) + 1, to_rank(high) - 1), step = 1;
  int last = 0;  // on which side of the root the double before was, as long as the steps still grow
  bool bracketed = false;
  while (gap() > 1) {
    const double t = from_rank(next);
    const Scaled exact_t = scaled(t);
    if (!fits(p, -exact_t.exponent)) return {Outcome::gave_up};
    const int side = sign_at(p, exact_t) * below;  // above 0 before the root
    if (side == 0) return {Outcome::contact, t};
    (side > 0 ? low : high) = t;
    bracketed = bracketed || side * last < 0;
    last = side;
    if (gap() <= 1) break;
    if (bracketed || step >= gap())
      next = to_rank(low) + gap() / 2;
    else
      next = side > 0 ? to_rank(low) + step : to_rank(high) - step;
    step *= 4;
  }
  return {Outcome::contact, low};
}

// Finds the first time before `until` at which the case decides. `apart` means that there is none.
Result first_of_case(const CloseCase<TimePolynomial>& which, double until) {
  const TimePolynomial& f = which.beyond;
  if (f.is_zero() || (which.insides > 0 && which.whole.is_zero())) return {Outcome::apart};
  DyadicInterval cell;
  while (cell.low() < until) {
    const Control at = control_on(f, cell);
    const int roots = at.variations();
    const bool starts = at.at_low() == 0 && cell.index != 0, ends = at.at_high() == 0 && cell.is_last();
    bool decides_at_low = starts, decides_at_high = ends, may_decide = roots > 0, certain = true;
    const auto ask = [&](const TimePolynomial& side, bool strict) {
      const Control signs = control_on(side, cell);
      const int least = strict ? 1 : 0;
      decides_at_low = decides_at_low && signs.at_low() >= least;
      decides_at_high = decides_at_high && signs.at_high() >= least;
      may_decide = may_decide && (signs.has(1) || !signs.has(-1));
      certain = certain && !signs.has(-1);
    };
    if (which.insides > 0 && (starts || ends || may_decide)) {
      ask(which.whole, true);
      for (std::size_t i = 0; i < which.insides; ++i)
        if (starts || ends || may_decide) ask(which.inside[i], false);
    }
    if (decides_at_low) return {Outcome::contact, cell.low()};
    if (may_decide && roots == 1 && certain) return time_within(f, cell, at);
    if (may_decide) {
      if (cell.halvings == kMostHalvings) return {Outcome::gave_up};
      cell.halve();
      continue;
    }
    if (decides_at_high) return {Outcome::contact, 1};
    if (cell.is_last()) break;
    cell.advance();
  }
  return {Outcome::apart};
}

template <class Cases>
Result first_closeness(const Scene& scene, unsigned cases) {
  if (!scene.fits()) return {Outcome::gave_up};
  const std::array<PointOf<TimePolynomial>, 4> points = scene.in_motion();
  TimePolynomial rr;
  rr.c[0] = scene.r_squared();
  rr.degree = 0;
  Result earliest{Outcome::apart, 2};
  for (int i = 0; i < Cases::count; ++i) {
    if ((cases >> i & 1) == 0) continue;
    const Result found = first_of_case(Cases::at(i, points, rr), earliest.time);
    if (found.outcome == Outcome::gave_up) return found;
    if (found.outcome == Outcome::contact && found.time < earliest.time) earliest = found;
  }
  return earliest;
}

Scene scene_of(const MovingVertexFace& q, double r) {
  return {{&q.vertex, &q.corner[0], &q.corner[1], &q.corner[2]}, r};
}
Scene scene_of(const MovingEdgeEdge& q, double r) {
  return {{&q.first[0], &q.first[1], &q.second[0], &q.second[1]}, r};
}

}  // namespace

Outcome closeness_at_start(const MovingVertexFace& query, double r, int likely) {
  return closeness_at_start<VertexFaceCases>(scene_of(query, r), likely);
}
Outcome closeness_at_start(const MovingEdgeEdge& query, double r, int likely) {
  return closeness_at_start<EdgeEdgeCases>(scene_of(query, r), likely);
}
bool at_distance_at_end(const MovingVertexFace& query, double r, int likely) {
  return at_distance_at_end<VertexFaceCases>(scene_of(query, r), likely);
}
bool at_distance_at_end(const MovingEdgeEdge& query, double r, int likely) {
  return at_distance_at_end<EdgeEdgeCases>(scene_of(query, r), likely);
}
Result first_closeness(const MovingVertexFace& query, double r, unsigned cases) {
  return first_closeness<VertexFaceCases>(scene_of(query, r), cases);
}
Result first_closeness(const MovingEdgeEdge& query, double r, unsigned cases) {
  return first_closeness<EdgeEdgeCases>(scene_of(query, r), cases);
}

}  // namespace cscd::integer
