#pragma once

// For tests only: a second oracle that shares no algorithm with the first (exact.h). It uses rational
// arithmetic, parameters of the touching points (barycentric coordinates, positions along the edges) instead
// of projected orientations, Sturm sequences instead of Descartes' rule, and Tarski queries instead of
// greatest common divisors. It is slow (up to tens of milliseconds) and meant for coordinates that are small
// integers.

#include <algorithm>
#include <array>
#include <functional>
#include <gmpxx.h>
#include <optional>
#include <utility>
#include <vector>

#include "core/geometry/feature_motion.h"

namespace cscd::brute {

using Poly = std::vector<mpq_class>;  // by ascending power, no leading zero
using PolyPoint = std::array<Poly, 3>;
using SignOf = std::function<int(const Poly&)>;

inline Poly trimmed(Poly p) {
  while (!p.empty() && p.back() == 0) p.pop_back();
  return p;
}
inline Poly operator+(const Poly& a, const Poly& b) {
  Poly sum(std::max(a.size(), b.size()));
  for (std::size_t i = 0; i < a.size(); ++i) sum[i] += a[i];
  for (std::size_t i = 0; i < b.size(); ++i) sum[i] += b[i];
  return trimmed(sum);
}
inline Poly operator*(const Poly& a, const Poly& b) {
  if (a.empty() || b.empty()) return {};
  Poly product(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) product[i + j] += a[i] * b[j];
  return trimmed(product);
}
inline Poly negated(Poly p) {
  for (mpq_class& c : p) c = -c;
  return p;
}
inline Poly operator-(const Poly& a, const Poly& b) {
  return a + negated(b);
}
inline Poly derivative(const Poly& p) {
  Poly result;
  for (std::size_t i = 1; i < p.size(); ++i) result.push_back(static_cast<unsigned long>(i) * p[i]);
  return trimmed(result);
}
inline Poly remainder(Poly a, const Poly& b) {
  while (a.size() >= b.size()) {
    const mpq_class factor = a.back() / b.back();
    for (std::size_t i = 0; i < b.size(); ++i) a[a.size() - b.size() + i] -= factor * b[i];
    a.pop_back();
    a = trimmed(a);
  }
  return a;
}
inline mpq_class value(const Poly& p, const mpq_class& t) {
  mpq_class sum = 0, power = 1;
  for (const mpq_class& c : p) {
    sum += c * power;
    power *= t;
  }
  return sum;
}

// A Tarski query. Among the roots of f in (lower, upper), it returns the number with g > 0 minus the number
// with g < 0. Neither end may be a root of f.
inline int tarski_query(const Poly& f, const Poly& g, const mpq_class& lower, const mpq_class& upper) {
  std::vector<Poly> chain{f, derivative(f) * g};
  while (!chain.back().empty())
    chain.push_back(negated(remainder(chain[chain.size() - 2], chain[chain.size() - 1])));
  const auto variations = [&](const mpq_class& t) {
    int count = 0, last = 0;
    for (const Poly& p : chain) {
      const int sign = sgn(value(p, t));
      if (sign == 0) continue;
      if (last != 0 && sign != last) ++count;
      last = sign;
    }
    return count;
  };
  return variations(lower) - variations(upper);
}

struct Root {
  Poly f;
  mpq_class lower, upper;  // the root is the only one of f between these
  int sign_of(const Poly& g) const { return tarski_query(f, g, lower, upper); }
  void narrow(const mpq_class& width) {
    while (upper - lower > width) {
      mpq_class middle = (lower + upper) / 2;
      while (value(f, middle) == 0) middle = (middle + upper) / 2;
      if (tarski_query(f, {1}, lower, middle) == 1)
        upper = middle;
      else
        lower = middle;
    }
  }
};

// Appends the roots of f in (lower, upper) to `roots`, in ascending order.
inline void isolate(const Poly& f, const mpq_class& lower, const mpq_class& upper, std::vector<Root>& roots) {
  const int count = tarski_query(f, {1}, lower, upper);
  if (count == 0) return;
  if (count == 1) {
    roots.push_back({f, lower, upper});
    return;
  }
  mpq_class middle = (lower + upper) / 2;
  while (value(f, middle) == 0) middle = (middle + upper) / 2;
  isolate(f, lower, middle, roots);
  isolate(f, middle, upper, roots);
}

// The roots of f in [0, 1], in ascending order.
inline std::vector<Root> unit_roots(const Poly& f) {
  mpq_class lower = mpq_class(-1, 3), upper = mpq_class(4, 3);
  while (value(f, lower) == 0) lower /= 2;
  while (value(f, upper) == 0) upper = (upper + 1) / 2;
  std::vector<Root> all, inside;
  isolate(f, lower, upper, all);
  for (Root& root : all)
    if (root.sign_of({0, 1}) >= 0 && root.sign_of({-1, 1}) <= 0) inside.push_back(root);
  return inside;
}

inline PolyPoint operator-(const PolyPoint& a, const PolyPoint& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Poly dot(const PolyPoint& a, const PolyPoint& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline PolyPoint cross(const PolyPoint& a, const PolyPoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline PolyPoint moving(const MovingPoint& p) {
  PolyPoint result;
  for (int k = 0; k < 3; ++k)
    result[static_cast<std::size_t>(k)] =
        trimmed({mpq_class(p.start[k]), mpq_class(p.end[k]) - mpq_class(p.start[k])});
  return result;
}

// Every predicate is given in two functions. One lists the polynomials whose signs decide the predicate, its
// events; the other decides the predicate from these signs.
inline void add_segment_events(std::vector<Poly>& events, const PolyPoint& p, const PolyPoint& a,
                               const PolyPoint& b) {
  const PolyPoint ab = b - a, ap = p - a;
  const Poly length = dot(ab, ab), along = dot(ap, ab), distance = dot(ap, ap);
  events.insert(events.end(), {length, distance, distance * length - along * along, along, length - along});
}

inline bool on_segment(const Poly* event, const SignOf& sign) {
  if (sign(event[0]) == 0) return sign(event[1]) == 0;
  return sign(event[2]) == 0 && sign(event[3]) >= 0 && sign(event[4]) >= 0;
}

using Four = std::array<PolyPoint, 4>;
inline Four moving(const std::array<MovingPoint, 4>& p) {
  return {moving(p[0]), moving(p[1]), moving(p[2]), moving(p[3])};
}

struct Predicate {
  std::vector<Poly> (*events)(const Four&);
  bool (*touch)(const std::vector<Poly>& events, const SignOf& sign);
};

inline std::vector<Poly> vertex_triangle_events(const Four& p) {
  const PolyPoint &v = p[0], &a = p[1], &b = p[2], &c = p[3], n = cross(b - a, c - a);
  std::vector<Poly> events{dot(n, n), dot(n, v - a), dot(n, cross(b - v, c - v)), dot(n, cross(c - v, a - v)),
                           dot(n, cross(a - v, b - v))};
  add_segment_events(events, v, a, b);
  add_segment_events(events, v, b, c);
  add_segment_events(events, v, c, a);
  return events;
}

inline bool vertex_on_triangle(const std::vector<Poly>& e, const SignOf& sign) {
  if (sign(e[0]) == 0) return on_segment(&e[5], sign) || on_segment(&e[10], sign) || on_segment(&e[15], sign);
  return sign(e[1]) == 0 && sign(e[2]) >= 0 && sign(e[3]) >= 0 && sign(e[4]) >= 0;
}

inline std::vector<Poly> edge_edge_events(const Four& p) {
  const PolyPoint &a = p[0], &b = p[1], &c = p[2], &d = p[3], u = b - a, w = d - c, m = cross(u, w);
  // The lines meet where a + s u = c + r w. The variables s and r hold these numbers times the square of m.
  const Poly whole = dot(m, m), s = dot(cross(c - a, w), m), r = dot(cross(c - a, u), m);
  std::vector<Poly> events{whole, dot(m, c - a), s, whole - s, r, whole - r};
  add_segment_events(events, a, c, d);
  add_segment_events(events, b, c, d);
  add_segment_events(events, c, a, b);
  add_segment_events(events, d, a, b);
  return events;
}

inline bool segments_meet(const std::vector<Poly>& e, const SignOf& sign) {
  if (sign(e[0]) == 0)
    return on_segment(&e[6], sign) || on_segment(&e[11], sign) || on_segment(&e[16], sign) ||
           on_segment(&e[21], sign);
  return sign(e[1]) == 0 && sign(e[2]) >= 0 && sign(e[3]) >= 0 && sign(e[4]) >= 0 && sign(e[5]) >= 0;
}

inline constexpr Predicate kVertexTriangle{vertex_triangle_events, vertex_on_triangle};
inline constexpr Predicate kEdgeEdge{edge_edge_events, segments_meet};

inline bool touches_at(const std::vector<Poly>& events, const Predicate& predicate, const mpq_class& t) {
  return predicate.touch(events, [&](const Poly& p) { return sgn(value(p, t)); });
}

struct Enclosure {
  mpq_class lower, upper;
};

// Encloses the earliest candidate for which `holds`, to within 2^-60.
template <class Holds>
std::optional<Enclosure> earliest(std::vector<Root>& candidates, const Holds& holds) {
  std::optional<Enclosure> first;
  for (Root& root : candidates) {
    if (!holds([&](const Poly& p) { return root.sign_of(p); })) continue;
    root.narrow(mpq_class(1, mpz_class(1) << 60));
    if (!first) first = Enclosure{root.lower, root.upper};
    first = Enclosure{std::min(first->lower, root.lower), std::min(first->upper, root.upper)};
  }
  return first;
}

// Encloses the earliest contact time in [0, 1] to within 2^-60. Returns nullopt if there is no contact.
inline std::optional<Enclosure> first_contact(const Four& points, const Predicate& predicate) {
  const std::vector<Poly> events = predicate.events(points);
  const Poly volume = dot(cross(points[1] - points[0], points[2] - points[0]), points[3] - points[0]);
  std::vector<Root> candidates;
  if (!volume.empty()) {
    candidates = unit_roots(volume);
  } else {
    // If the points are coplanar throughout, contact begins at t = 0 or where a deciding sign changes.
    if (touches_at(events, predicate, 0)) return Enclosure{0, 0};
    for (const Poly& p : events)
      if (p.size() > 1)
        for (const Root& root : unit_roots(p)) candidates.push_back(root);
  }
  return earliest(candidates, [&](const SignOf& sign) { return predicate.touch(events, sign); });
}

// Closeness at a distance. Squared distances and nearest points come from dot products alone (Gram
// determinants). The features are close if, in some case, `whole` is above zero and no other number is
// negative.
struct CloseCase {
  Poly whole;
  std::vector<Poly> others;
};

inline void add_vertex_close(std::vector<CloseCase>& cases, const PolyPoint& p, const PolyPoint& q,
                             const Poly& rr) {
  const PolyPoint e = p - q;
  cases.push_back({{1}, {rr - dot(e, e)}});
}
inline void add_segment_close(std::vector<CloseCase>& cases, const PolyPoint& p, const PolyPoint& a,
                              const PolyPoint& b, const Poly& rr) {
  const PolyPoint u = b - a, e = p - a;
  const Poly length = dot(u, u), along = dot(e, u);
  cases.push_back({length, {along, length - along, rr * length - dot(e, e) * length + along * along}});
}

inline std::vector<CloseCase> close_cases(const Four& x, bool vertex_face, const Poly& rr) {
  const PolyPoint u = x[vertex_face ? 2 : 1] - x[vertex_face ? 1 : 0], w = x[3] - x[vertex_face ? 1 : 2],
                  e = x[0] - x[vertex_face ? 1 : 2];
  // For the vertex and the face, the vertex is nearest to x[1] + s u + q w; for edges, x[0] + s u to x[2] + q
  // w. The variables s, q and `squared` hold these numbers and the squared distance times `gram`.
  const Poly uu = dot(u, u), uw = dot(u, w), ww = dot(w, w), eu = dot(e, u), ew = dot(e, w);
  const Poly gram = uu * ww - uw * uw, q = ew * uu - eu * uw, along = eu * ww - ew * uw;
  const Poly s = vertex_face ? along : negated(along);
  const Poly squared = dot(e, e) * gram - eu * along - ew * q;
  std::vector<CloseCase> cases;
  if (vertex_face) {
    cases.push_back({gram, {s, q, gram - s - q, rr * gram - squared}});
    for (std::size_t i = 1; i < 4; ++i) {
      add_segment_close(cases, x[0], x[i], x[1 + i % 3], rr);
      add_vertex_close(cases, x[0], x[i], rr);
    }
  } else {
    cases.push_back({gram, {s, gram - s, q, gram - q, rr * gram - squared}});
    for (std::size_t i = 0; i < 4; ++i) {
      add_segment_close(cases, x[i], x[i < 2 ? 2 : 0], x[i < 2 ? 3 : 1], rr);
      add_vertex_close(cases, x[i / 2], x[2 + i % 2], rr);
    }
  }
  return cases;
}

// Encloses the earliest time in [0, 1] at which the features are within r.
inline std::optional<Enclosure> first_closeness(const Four& points, bool vertex_face, const mpq_class& r) {
  const std::vector<CloseCase> cases = close_cases(points, vertex_face, {r * r});
  const auto close = [&](const SignOf& sign) {
    return std::any_of(cases.begin(), cases.end(), [&](const CloseCase& which) {
      return sign(which.whole) > 0 && std::all_of(which.others.begin(), which.others.end(),
                                                  [&](const Poly& p) { return sign(p) >= 0; });
    });
  };
  if (close([](const Poly& p) { return sgn(value(p, 0)); })) return Enclosure{0, 0};
  std::vector<Root> candidates;
  for (const CloseCase& which : cases)
    for (const Poly& p : which.others)
      if (p.size() > 1)
        for (const Root& root : unit_roots(p)) candidates.push_back(root);
  return earliest(candidates, close);
}

}  // namespace cscd::brute
