// The exact referee.
//
// Doubles are rationals: scaled by a power of two, the moving points have integer polynomials for
// coordinates. Features in contact are coplanar, so contact can only be at a root of the coplanarity cubic;
// there it is decided by exact signs (touch.h). Where the cubic is identically zero the features move within
// one plane, and contact can only begin at t = 0 or where one of the deciding signs changes: those roots are
// the candidates. (The contact set is closed, and constant between neighbouring candidates, so its least
// element is one.) "No" is a proof, and so is "yes"; the time is enclosed by neighbouring doubles, or met.
// Cost: a few microseconds without a root in [0, 1], some tens with one, hundreds when coplanar throughout.
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
  // Roots of different polynomials may be equal or too close to be ordered by their enclosures. No matter:
  // the earliest contact is not after this candidate's time, nor before its lower bound, the least one left.
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
