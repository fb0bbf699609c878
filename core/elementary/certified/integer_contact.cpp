// The integer stage of `filtered_exact`.
//
// A query of either kind is three moving vectors p, q, r. For a vertex and a face, p and q are two edges of
// the face and r leads to the vertex, all from one corner. For two edges, p and q are the edges and r leads
// from the start of the first to the start of the second. Let n = p x q, g = p x r, h = r x q. The four
// points are coplanar where n . r = 0. At such a time the *sides* along an axis k decide whether the
// features touch:
//   vertex-face:  g_k, h_k and (n - g - h)_k,
//   edge-edge:    -g_k, (n + g)_k, h_k and (n - h)_k.
// The features touch only if the sides along k have one sign, zero allowed. They surely touch if, besides,
// one of these sides is not zero: the sides sum to n_k or 2 n_k, and where n_k is not zero the projection
// along k is one to one on the common plane. If the sides are zero along all three axes, the four points
// lie on one line. Then the features are apart exactly if, along some axis, all differences from the points
// of one feature to the points of the other have one strict sign (a vertex, a triangle and a segment are
// convex sets on that line).
//
// Suppose that n . r is zero throughout. If n_k is not zero throughout for some axis k, contact can begin
// only at t = 0, at a root of a side along k, or at a root of n_k. If n is zero throughout, two sides along
// an axis have opposite signs or all sides are zero, so the roots of any side that is not zero throughout
// include all contact times. If all sides are zero throughout, contact begins at t = 0 or at a root of one
// of the differences on the line.
//
// Each axis is scaled by its own power of two. Contacts do not depend on this scaling, and it keeps the
// integers short.
#include "core/elementary/certified/integer_contact.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/elementary/certified/integer_roots.h"
#include "core/elementary/certified/scaled.h"

namespace cscd::integer {
namespace {

enum class Kind { vertex_face, edge_edge };

// x(t) = start + slope t on one axis.
struct Line {
  Wide start, slope;
};
Line operator-(const Line& a, const Line& b) {
  return {a.start - b.start, a.slope - b.slope};
}
Line operator+(const Line& a, const Line& b) {
  return {a.start + b.start, a.slope + b.slope};
}
Polynomial polynomial(const Line& line) {
  Polynomial p;
  p.c[0] = line.start;
  p.c[1] = line.slope;
  p.trim();
  return p;
}

// The vectors p, q, r in integers: [axis].
struct FeatureTriple {
  Line p[3], q[3], r[3];
  int bits[3];  // the most bits of a number on each axis
};

// Makes the vectors from four points: the three corners and the vertex, or the ends of the first edge and
// the ends of the second edge. An axis whose numbers are too long has its `bits` set and no vectors.
FeatureTriple triple(Kind kind, const MovingPoint* const (&points)[4]) {
  FeatureTriple result;
  for (int axis = 0; axis < 3; ++axis) {
    Scaled part[8];
    BitSpan span;
    for (int i = 0; i < 8; ++i)
      span.add(part[i] = scaled((i < 4 ? points[i]->start : points[i - 4]->end)[axis]));
    // A difference of differences has two bits more.
    result.bits[axis] = span.bits() + 2;
    if (result.bits[axis] > Wide::kBits / 8) continue;  // `Contact` gives up on so many bits
    const auto at = [&](int i) {
      return part[i].mantissa == 0 ? Wide() : Wide(part[i].mantissa) << part[i].exponent - span.lowest();
    };
    Line line[4];
    for (int i = 0; i < 4; ++i) {
      line[i].start = at(i);
      line[i].slope = at(i + 4) - line[i].start;
    }
    result.p[axis] = line[1] - line[0];
    result.q[axis] = kind == Kind::vertex_face ? line[2] - line[0] : line[3] - line[2];
    result.r[axis] = kind == Kind::vertex_face ? line[3] - line[0] : line[2] - line[0];
  }
  return result;
}

// Component k of u x w.
Polynomial cross(const Line (&u)[3], const Line (&w)[3], int k) {
  const int i = (k + 1) % 3, j = (k + 2) % 3;
  Polynomial result;
  result.c[0] = u[i].start * w[j].start - u[j].start * w[i].start;
  result.c[1] = (u[i].start * w[j].slope + u[i].slope * w[j].start) -
                (u[j].start * w[i].slope + u[j].slope * w[i].start);
  result.c[2] = u[i].slope * w[j].slope - u[j].slope * w[i].slope;
  result.trim();
  return result;
}

Polynomial sum(const Polynomial& a, const Polynomial& b) {
  Polynomial result;
  for (int i = 0; i < 3; ++i) result.c[i] = a.c[i] + b.c[i];
  result.trim();
  return result;
}
Polynomial difference(const Polynomial& a, const Polynomial& b) {
  Polynomial result;
  for (int i = 0; i < 3; ++i) result.c[i] = a.c[i] - b.c[i];
  result.trim();
  return result;
}
Polynomial negated(Polynomial a) {
  for (int i = 0; i < 3; ++i) a.c[i] = -a.c[i];
  return a;
}

// One query, whose polynomials are made on demand.
class Contact {
 public:
  Contact(Kind kind, const MovingPoint* const (&points)[4]) : kind_(kind), v_(triple(kind, points)) {
    // The longest number is the value of a quadratic at a fraction that is made of the cubic and this
    // quadratic. With s bits in the cubic and d bits in the quadratic, it has 2 s + 5 d bits and some
    // carries.
    const int all = v_.bits[0] + v_.bits[1] + v_.bits[2];
    const int two = all - std::min({v_.bits[0], v_.bits[1], v_.bits[2]});
    fits_ = 2 * all + 5 * two + 80 <= Wide::kBits;
    if (!fits_) return;
    for (int k = 0; k < 3; ++k) normal_[k] = cross(v_.p, v_.q, k);
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i <= normal_[k].degree; ++i) {
        coplanarity_.c[i] = coplanarity_.c[i] + normal_[k].c[i] * v_.r[k].start;
        coplanarity_.c[i + 1] = coplanarity_.c[i + 1] + normal_[k].c[i] * v_.r[k].slope;
      }
    coplanarity_.trim();
  }

  Result decide() {
    if (!fits_) return {Outcome::gave_up};
    if (coplanarity_.is_zero()) return planar();
    Result result{Outcome::apart};
    solver_.for_each_root(coplanarity_, [&](Root& root) {
      solver_.tighten(root);
      if (!touches(root)) return false;
      result = {Outcome::contact, root.low};
      return true;
    });
    return solver_.gave_up() ? Result{Outcome::gave_up} : result;
  }

  Result time_between(double low, double high) {
    if (!fits_) return {Outcome::gave_up};
    Root root = solver_.isolated_root(coplanarity_, low, high);
    solver_.tighten(root);
    return solver_.gave_up() ? Result{Outcome::gave_up} : Result{Outcome::contact, root.low};
  }

 private:
  static constexpr int kMostSides = 4, kMostCandidates = 12;

  int side_count() const { return kind_ == Kind::vertex_face ? 3 : 4; }

  // The sides along axis k. They are computed at the first call.
  const Polynomial* sides(int k) {
    Polynomial(&side)[kMostSides] = side_[k];
    if (have_sides_[k]) return side;
    have_sides_[k] = true;
    const Polynomial g = cross(v_.p, v_.r, k), h = cross(v_.r, v_.q, k);
    if (kind_ == Kind::vertex_face) {
      side[0] = g;
      side[1] = h;
      side[2] = difference(difference(normal_[k], g), h);
    } else {
      side[0] = negated(g);
      side[1] = sum(normal_[k], g);
      side[2] = h;
      side[3] = difference(normal_[k], h);
    }
    return side;
  }

  // Writes the differences from the points of one feature to the points of the other along axis k. Returns
  // their number.
  int line_differences(int k, Polynomial (&out)[kMostSides]) const {
    const Line &p = v_.p[k], &q = v_.q[k], &r = v_.r[k];
    out[0] = polynomial(r);
    out[1] = polynomial(r - p);
    if (kind_ == Kind::vertex_face) {
      out[2] = polynomial(r - q);
      return 3;
    }
    out[2] = polynomial(r + q);
    out[3] = polynomial(r + q - p);
    return 4;
  }

  // True if the features touch at `root`, at which their points are coplanar.
  bool touches(Root& root) {
    for (int k = 0; k < 3; ++k) {
      const Polynomial* side = sides(k);
      int seen = 0;
      for (int i = 0; i < side_count(); ++i) {
        const int sign = solver_.sign_at(side[i], root);
        if (sign * seen < 0) return false;
        if (sign != 0) seen = sign;
      }
      if (seen != 0) return true;
    }
    // All sides are zero, so the points lie on one line.
    for (int k = 0; k < 3; ++k) {
      Polynomial step[kMostSides];
      const int count = line_differences(k, step);
      int total = 0;
      for (int i = 0; i < count; ++i) total += solver_.sign_at(step[i], root);
      if (total == count || total == -count) return false;
    }
    return true;
  }

  // Decides features that are coplanar throughout.
  Result planar() {
    Root start;
    start.denominator = Wide(1);
    if (touches(start)) return {Outcome::contact, 0};

    Root candidates[kMostCandidates];
    int count = 0;
    const auto add = [&](const Polynomial& event) {
      if (event.degree > 0 && !solver_.gave_up()) count += solver_.find_roots(event, candidates + count);
    };
    Polynomial step[3][kMostSides];
    int axis = 0;
    while (axis < 3 && normal_[axis].is_zero()) ++axis;
    if (axis < 3) {
      add(normal_[axis]);
      for (int i = 0; i < side_count(); ++i) add(sides(axis)[i]);
    } else if (const Polynomial* side = some_side()) {
      add(*side);
    } else {
      for (int k = 0; k < 3; ++k)
        for (int i = 0, n = line_differences(k, step[k]); i < n; ++i) add(step[k][i]);
    }
    for (int i = 0; i < count; ++i) solver_.tighten(candidates[i]);
    // Try the candidates in ascending order of the largest doubles not above them. That double is the
    // answer, so the order of candidates with the same double does not matter.
    for (; count > 0 && !solver_.gave_up(); --count) {
      Root* first = std::min_element(candidates, candidates + count,
                                     [](const Root& a, const Root& b) { return a.low < b.low; });
      if (touches(*first) && !solver_.gave_up()) return {Outcome::contact, first->low};
      *first = candidates[count - 1];
    }
    return {solver_.gave_up() ? Outcome::gave_up : Outcome::apart};
  }

  // Any side that is not zero throughout, or null.
  const Polynomial* some_side() {
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < side_count(); ++i)
        if (!sides(k)[i].is_zero()) return &side_[k][i];
    return nullptr;
  }

  Kind kind_;
  bool fits_ = false;
  FeatureTriple v_;
  Polynomial normal_[3], coplanarity_;
  Polynomial side_[3][kMostSides];
  bool have_sides_[3] = {false, false, false};
  RootSolver solver_;
};

Contact contact(const MovingVertexFace& q) {
  return Contact(Kind::vertex_face, {&q.corner[0], &q.corner[1], &q.corner[2], &q.vertex});
}
Contact contact(const MovingEdgeEdge& q) {
  return Contact(Kind::edge_edge, {&q.first[0], &q.first[1], &q.second[0], &q.second[1]});
}

}  // namespace

Result first_contact(const MovingVertexFace& query) {
  return contact(query).decide();
}
Result first_contact(const MovingEdgeEdge& query) {
  return contact(query).decide();
}
Result contact_time(const MovingVertexFace& query, double low, double high) {
  return contact(query).time_between(low, high);
}
Result contact_time(const MovingEdgeEdge& query, double low, double high) {
  return contact(query).time_between(low, high);
}

}  // namespace cscd::integer
