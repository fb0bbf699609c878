// The exact oracle at a distance.
//
// Scaled by a power of two, coordinates are integer polynomials in t and r is an integer. For each case of
// least features (closeness_cases.h) the squared distance of the point, lines or planes that they span, minus
// r^2, is such a polynomial too, after multiplication by a square. Let t* > 0 be the earliest time at which
// the features are close. Their distance is continuous in t, so it is r at t*. Take nearest points that lie
// inside least features of lowest dimension. These have a length or an area, and are not parallel, since
// otherwise other nearest points would lie in lower features. So t* is a root of this case's polynomial. If
// that polynomial were zero throughout, the features were close shortly before t* as well, while their
// nearest points were still inside.
//
// So t* is 0 or a root of some polynomial that is not zero throughout, and at such a root exact signs decide
// whether the nearest points of the case lie inside its features. If they do, the distance of the features is
// r.
#include "core/elementary/exact/closeness.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/elementary/exact/closeness_cases.h"
#include "core/elementary/exact/touch.h"
#include "core/geometry/nearest_points.h"

namespace cscd::exact {
namespace {

using Case = CloseCase<Polynomial>;

std::vector<Case> cases(const MovingVertexFace& q, double r) {
  const auto [points, length] = linear_points({q.vertex, q.corner[0], q.corner[1], q.corner[2]}, r);
  const Polynomial r_squared(length * length);
  std::vector<Case> all;
  for (int i = 0; i < kVertexFaceCases; ++i) all.push_back(vertex_face_case(i, points, r_squared));
  return all;
}
std::vector<Case> cases(const MovingEdgeEdge& q, double r) {
  const auto [points, length] = linear_points({q.first[0], q.first[1], q.second[0], q.second[1]}, r);
  const Polynomial r_squared(length * length);
  std::vector<Case> all;
  for (int i = 0; i < kEdgeEdgeCases; ++i) all.push_back(edge_edge_case(i, points, r_squared));
  return all;
}

// True if the least features of the case have their dimension and hold their nearest points inside.
bool decides(const Case& which, AlgebraicNumber& time) {
  if (which.insides > 0 && time.sign_of(which.whole) == 0) return false;
  return std::all_of(which.inside.begin(), which.inside.begin() + which.insides,
                     [&](const Polynomial& side) { return time.sign_of(side) >= 0; });
}

bool close_at_start(const std::vector<Case>& cases) {
  AlgebraicNumber start{Dyadic{}};
  return std::any_of(cases.begin(), cases.end(), [&](const Case& which) {
    return start.sign_of(which.beyond) <= 0 && decides(which, start);
  });
}

// Asks the bounds of the distance before the cases are made. Points are seen from one of them.
template <std::size_t split, class Query>
bool close_at_start(const Query& query, std::array<Vec3, 4> points,
                    Nearest (*nearest)(const std::array<Vec3, 4>&), double r) {
  const Vec3 from = points[3];
  for (Vec3& x : points) x -= from;
  const DistanceBounds distance = distance_bounds(points, split, nearest(points).way);
  if (distance.high <= r) return true;
  return distance.low <= r && close_at_start(cases(query, r));
}

std::optional<TimeEnclosure> first_closeness(const std::vector<Case>& cases) {
  if (close_at_start(cases)) return TimeEnclosure{0, 0};
  struct Candidate {
    const Case* which;
    AlgebraicNumber time;
  };
  std::vector<Candidate> candidates;
  for (const Case& which : cases) {
    if (which.beyond.is_zero()) continue;
    for (AlgebraicNumber& root : roots_in_unit_interval(which.beyond))
      candidates.push_back({&which, std::move(root)});
  }
  // Roots of different cases may be equal, or too close to be ordered by their enclosures. The first that
  // decides has the smallest lower bound of all that do, in any such order.
  std::sort(candidates.begin(), candidates.end(), [](Candidate& a, Candidate& b) {
    const TimeEnclosure first = a.time.enclosure(), second = b.time.enclosure();
    return first.lo != second.lo ? first.lo < second.lo : first.hi < second.hi;
  });
  for (Candidate& candidate : candidates)
    if (decides(*candidate.which, candidate.time)) return candidate.time.enclosure();
  return std::nullopt;
}

}  // namespace

std::optional<TimeEnclosure> first_closeness(const MovingVertexFace& query, double r) {
  return first_closeness(cases(query, r));
}
std::optional<TimeEnclosure> first_closeness(const MovingEdgeEdge& query, double r) {
  return first_closeness(cases(query, r));
}

bool close_at_start(const MovingVertexFace& q, double r) {
  return close_at_start<1>(q, {q.vertex.start, q.corner[0].start, q.corner[1].start, q.corner[2].start},
                           nearest_of_vertex_face, r);
}
bool close_at_start(const MovingEdgeEdge& q, double r) {
  return close_at_start<2>(q, {q.first[0].start, q.first[1].start, q.second[0].start, q.second[1].start},
                           nearest_of_edges, r);
}

}  // namespace cscd::exact
