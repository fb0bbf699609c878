// The exact oracle.
//
// Doubles are rational numbers: scaled by a power of two, the coordinates of the moving points are integer
// polynomials in t. Features in contact are coplanar, so a contact can only be at a root of the coplanarity
// cubic. At each root exact signs decide whether the features touch (touch.h).
//
// If the cubic is identically zero, the features are coplanar throughout. Contact can then begin only at
// t = 0 or where one of the deciding signs changes, so the roots of the polynomials with these signs are
// the candidates. (The set of contact times is closed, and contact does not change between neighbouring
// candidates, so the least contact time is a candidate.)
//
// "Apart" and "contact" are both proofs. The time is enclosed by neighbouring doubles, or is itself a
// double. A query takes a few microseconds without a root in [0, 1], some tens with one root, and hundreds
// if the features are coplanar throughout.
#include "core/elementary/exact/exact.h"

#include <algorithm>
#include <vector>

#include "core/elementary/exact/algebraic.h"
#include "core/elementary/exact/touch.h"

namespace cscd::exact {
namespace {

using TouchTest = bool (*)(const FourPoints&, AlgebraicNumber&);
using EventList = std::vector<Polynomial> (*)(const FourPoints&);

std::optional<TimeEnclosure> first_coplanar_contact(const FourPoints& points, TouchTest touch,
                                                    EventList events) {
  AlgebraicNumber start{Dyadic{}};
  if (touch(points, start)) return TimeEnclosure{0, 0};
  std::vector<AlgebraicNumber> candidates;
  for (const Polynomial& event : events(points)) {
    if (event.degree() <= 0) continue;
    for (AlgebraicNumber& root : roots_in_unit_interval(event)) candidates.push_back(std::move(root));
  }
  // Roots of different polynomials may be equal, or too close to be ordered by their enclosures. The result
  // is right in any such order: the earliest contact is not after the first candidate that touches, and not
  // before that candidate's lower bound, which is the smallest lower bound of all candidates that are left.
  std::sort(candidates.begin(), candidates.end(), [](AlgebraicNumber& a, AlgebraicNumber& b) {
    const TimeEnclosure first = a.enclosure(), second = b.enclosure();
    return first.lo != second.lo ? first.lo < second.lo : first.hi < second.hi;
  });
  for (AlgebraicNumber& candidate : candidates)
    if (touch(points, candidate)) return candidate.enclosure();
  return std::nullopt;
}

std::optional<TimeEnclosure> first_contact(const std::array<MovingPoint, 4>& query, TouchTest touch,
                                           EventList events) {
  const FourPoints points = linear_points(query);
  const Polynomial coplanar = coplanarity(points);
  if (coplanar.is_zero()) return first_coplanar_contact(points, touch, events);
  for (AlgebraicNumber& time : roots_in_unit_interval(coplanar))
    if (touch(points, time)) return time.enclosure();
  return std::nullopt;
}

}  // namespace

std::optional<TimeEnclosure> first_contact(const MovingVertexFace& query) {
  return first_contact({query.vertex, query.corner[0], query.corner[1], query.corner[2]},
                       vertex_touches_triangle, vertex_triangle_events);
}

std::optional<TimeEnclosure> first_contact(const MovingEdgeEdge& query) {
  return first_contact({query.first[0], query.first[1], query.second[0], query.second[1]}, edges_touch,
                       edge_edge_events);
}

}  // namespace cscd::exact
