// Exact static contact.
//
// The predicates are a cascade, cheapest step first: comparisons of coordinates, which are exact; then
// determinants in floating point, whose sign counts only beyond a forward error bound; then exact integers.
// Every "apart" of the first two steps is a proof. The cases that these steps cannot prove, in practice
// touching features and exact degeneracies, are decided by the oracle's predicates. A call takes 5 to 30
// ns, and microseconds if the exact step is needed.
//
// The error bounds, with u = kUnitRoundoff: A coordinate difference has a relative error of at most u, and
// so, term by term, has every later operation. A 2 x 2 determinant of differences collects 4 factors
// (1 + e), |e| <= u, in each product (two differences, the product, the subtraction). So it is off by at
// most ((1 + u)^4 - 1) times the sum of the exact magnitudes of the products, their permanent. A 3 x 3
// determinant, expanded along a row, collects 8 factors (two more for the third factor's difference and
// product, two for the sums). The computed permanent has positive terms with the same factors, so it is at
// least (1 - u)^8 times the exact permanent. The constants 6 u and 10 u leave room for the second-order
// terms and for rounding the bound.
//
// Differences never underflow. A product that underflows is off by at most 2^-1075 and is multiplied by at
// most one difference; the last term of the bound, with kUnderflow, covers this generously. An overflow
// makes the permanent infinite or NaN, and no comparison with such a number certifies anything.
#include "core/elementary/exact/static_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/rounding.h"
#include "core/elementary/exact/touch.h"
#include "core/mesh/adjacency.h"

namespace cscd {

namespace {

constexpr double kUnderflow = 0x1p-1000;

// +1 or -1 if certain, else 0.
int certain_sign(double value, double error_bound) {
  return static_cast<int>(value > error_bound) - static_cast<int>(value < -error_bound);
}

// The side of the plane a, b, c on which p lies, if it is certain, else 0: the sign of the determinant of a
// - p, b - p, c - p.
int certain_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const double ax = a.x() - p.x(), ay = a.y() - p.y(), az = a.z() - p.z();
  const double bx = b.x() - p.x(), by = b.y() - p.y(), bz = b.z() - p.z();
  const double cx = c.x() - p.x(), cy = c.y() - p.y(), cz = c.z() - p.z();
  const double bxcy = bx * cy, bycx = by * cx, cxay = cx * ay, cyax = cy * ax, axby = ax * by, aybx = ay * bx;
  const double determinant = az * (bxcy - bycx) + bz * (cxay - cyax) + cz * (axby - aybx);
  const double permanent = std::abs(az) * (std::abs(bxcy) + std::abs(bycx)) +
                           std::abs(bz) * (std::abs(cxay) + std::abs(cyax)) +
                           std::abs(cz) * (std::abs(axby) + std::abs(aybx));
  return certain_sign(determinant, 10 * kUnitRoundoff * permanent +
                                       kUnderflow * (1 + std::abs(az) + std::abs(bz) + std::abs(cz)));
}

// Seen along axis k, the side of the line a, b on which p lies, if it is certain, else 0.
int certain_orientation(const Vec3& a, const Vec3& b, const Vec3& p, int k) {
  const int i = k == 2 ? 0 : k + 1, j = k == 0 ? 2 : k - 1;
  const double left = (b[i] - a[i]) * (p[j] - a[j]), right = (b[j] - a[j]) * (p[i] - a[i]);
  return certain_sign(left - right, 6 * kUnitRoundoff * (std::abs(left) + std::abs(right)) + kUnderflow);
}

// True if the bounding boxes of two sets of points are apart.
template <class First, class Second>
bool boxes_apart(const First& first, const Second& second) {
  for (int k = 0; k < 3; ++k) {
    double first_min = (*first[0])[k], first_max = first_min;
    for (const Vec3* p : first)
      first_min = std::min(first_min, (*p)[k]), first_max = std::max(first_max, (*p)[k]);
    double second_min = (*second[0])[k], second_max = second_min;
    for (const Vec3* p : second)
      second_min = std::min(second_min, (*p)[k]), second_max = std::max(second_max, (*p)[k]);
    if (first_max < second_min || second_max < first_min) return true;
  }
  return false;
}
using Ends = std::array<const Vec3*, 2>;
using Corners = std::array<const Vec3*, 3>;

// True if, seen along some axis, the vertex certainly lies beyond an edge of the triangle.
bool apart_in_projection(const Vec3& v, const Vec3& a, const Vec3& b, const Vec3& c) {
  for (int k = 0; k < 3; ++k) {
    const int inside = certain_orientation(a, b, c, k);
    if (inside == 0) continue;
    if (certain_orientation(a, b, v, k) == -inside || certain_orientation(b, c, v, k) == -inside ||
        certain_orientation(c, a, v, k) == -inside)
      return true;
  }
  return false;
}

// True if, seen along some axis, one segment certainly lies on one side of the other segment's line.
bool segments_apart_in_projection(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  for (int k = 0; k < 3; ++k) {
    if (certain_orientation(a, b, c, k) * certain_orientation(a, b, d, k) > 0) return true;
    if (certain_orientation(c, d, a, k) * certain_orientation(c, d, b, k) > 0) return true;
  }
  return false;
}

// True if, seen along some axis, both ends of the segment certainly lie beyond one edge of the triangle, or
// the triangle certainly lies on one side of the segment's line.
bool segment_apart_in_projection(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  for (int k = 0; k < 3; ++k) {
    const int inside = certain_orientation(a, b, c, k);
    const auto beyond = [&](const Vec3& from, const Vec3& to) {
      return certain_orientation(from, to, p, k) == -inside && certain_orientation(from, to, q, k) == -inside;
    };
    if (inside != 0 && (beyond(a, b) || beyond(b, c) || beyond(c, a))) return true;
    const int side = certain_orientation(p, q, a, k);
    if (side != 0 && certain_orientation(p, q, b, k) == side && certain_orientation(p, q, c, k) == side)
      return true;
  }
  return false;
}

// The side of the plane a, b, c on which p lies, from exact integers.
int exact_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  return exact::coplanarity(exact::constant_points({p, a, b, c}))[0].sign();
}

// The side of the plane a, b, c on which p lies, exactly.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const int side = certain_orientation(a, b, c, p);
  return side != 0 ? side : exact_orientation(a, b, c, p);
}

struct Frame {
  const TriangleMesh& mesh;
  std::span<const Vec3> x;

  bool touch(VertexId vertex, const Triangle& t) const {
    return vertex_touches_triangle(x[+vertex], x[+t[0]], x[+t[1]], x[+t[2]]);
  }
  bool touch(const Edge& e, const Triangle& t) const {
    return segment_touches_triangle(x[+e[0]], x[+e[1]], x[+t[0]], x[+t[1]], x[+t[2]]);
  }
  bool touch(const Edge& e, const Edge& f) const {
    return segments_touch(x[+e[0]], x[+e[1]], x[+f[0]], x[+f[1]]);
  }

  // Whether all vertices of `to` that `from` does not have certainly lie on one side of the plane of `from`.
  // Then `to` reaches that plane in the vertex or edge that both share alone, and the two meet nowhere else.
  // Neighbours are often nearly in one plane, and hardly ever exactly. So this settles most pairs, for the
  // price of one or two determinants.
  bool beside(TriangleId from, TriangleId to) const {
    const Triangle& plane = mesh.corners(from);
    int side = 0;
    for (const VertexId vertex : mesh.corners(to)) {
      if (contains(plane, vertex)) continue;
      const int here = certain_side(x[+plane[0]], x[+plane[1]], x[+plane[2]], x[+vertex]);
      if (here == 0 || here == -side) return false;
      side = here;
    }
    return side != 0;
  }

  // Returns whether a feature of the first triangle meets the second triangle outside the vertices
  // and edges that both share. An edge without a vertex of the second triangle is tested as a
  // whole, which covers its two ends.
  bool reaches(TriangleId from, TriangleId to) const {
    const Triangle& target = mesh.corners(to);
    for (const VertexId vertex : mesh.corners(from))
      if (!contains(target, vertex) && touch(vertex, target)) return true;
    for (const EdgeId id : mesh.edges_of(from)) {
      const Edge& edge = mesh.ends(id);
      const int shared = contains(target, edge[0]) + contains(target, edge[1]);
      if (shared == 0 && touch(edge, target)) return true;
      if (shared != 1) continue;
      // One end of the edge is shared. If the edge lies in the plane of the target, it can still cross
      // the side opposite to that end.
      for (const EdgeId side : mesh.edges_of(to)) {
        const Edge& other = mesh.ends(side);
        if (!share_vertex(edge, other) && touch(edge, other)) return true;
      }
    }
    return false;
  }
};

using Triple = std::array<Vec3, 3>;

// Whether the corners of `other` lie strictly on both sides of the plane of `plane`. If so, turns `other` so
// that its first corner is alone on its side, and `plane` so that this side is the positive one.
bool part_by_plane(Triple& plane, Triple& other) {
  std::array<int, 3> side;
  for (std::size_t k = 0; k < 3; ++k) side[k] = orientation(plane[0], plane[1], plane[2], other[k]);
  const auto [least, most] = std::ranges::minmax(side);
  if (least >= 0 || most <= 0) return false;
  const int alone = std::ranges::count(side, 1) == 1 ? 1 : -1;
  std::rotate(other.begin(), other.begin() + (std::ranges::find(side, alone) - side.begin()), other.end());
  if (alone < 0) std::swap(plane[1], plane[2]);
  return true;
}

}  // namespace

int certain_side(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  return certain_orientation(a, b, c, p);
}

bool vertex_touches_triangle(const Vec3& vertex, const Vec3& a, const Vec3& b, const Vec3& c) {
  if (boxes_apart(std::array<const Vec3*, 1>{&vertex}, Corners{&a, &b, &c})) return false;
  if (certain_orientation(a, b, c, vertex) != 0) return false;
  if (apart_in_projection(vertex, a, b, c)) return false;
  const exact::FourPoints points = exact::constant_points({vertex, a, b, c});
  exact::AlgebraicNumber now{exact::Dyadic{}};
  return exact::coplanarity(points).is_zero() && exact::vertex_touches_triangle(points, now);
}

bool segments_touch(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  if (boxes_apart(Ends{&a, &b}, Ends{&c, &d})) return false;
  if (certain_orientation(a, b, c, d) != 0) return false;
  if (segments_apart_in_projection(a, b, c, d)) return false;
  const exact::FourPoints points = exact::constant_points({a, b, c, d});
  exact::AlgebraicNumber now{exact::Dyadic{}};
  return exact::coplanarity(points).is_zero() && exact::edges_touch(points, now);
}

bool segment_touches_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  if (boxes_apart(Ends{&p, &q}, Corners{&a, &b, &c})) return false;
  const int certain_p = certain_orientation(a, b, c, p), certain_q = certain_orientation(a, b, c, q);
  if (certain_p * certain_q > 0) return false;
  // Opposite certain signs of two volumes prove "apart". Let x = l1 a + l2 b + l3 c, with weights l >= 0,
  // be a point of the triangle on the line pq. Seen along that line, with the line as the origin, l1 a + l2
  // b + l3 c = 0. Taking the cross product with b gives l1 (a x b) = l3 (b x c), and so on round. If two of
  // a x b, b x c, c x a have strictly opposite signs, both their weights vanish, so x is a corner on the
  // line. This makes both products zero: a contradiction.
  const int certain_volume[3] = {certain_orientation(p, q, a, b), certain_orientation(p, q, b, c),
                                 certain_orientation(p, q, c, a)};
  const auto [least, most] = std::minmax_element(certain_volume, certain_volume + 3);
  if (*least < 0 && *most > 0) return false;
  // The segment touches if its ends are on opposite sides of the plane and the line passes inside all three
  // edges.
  if (certain_p * certain_q < 0 && *least == *most && *least != 0) return true;
  if (segment_apart_in_projection(p, q, a, b, c)) return false;

  const int side_p = certain_p != 0 ? certain_p : exact_orientation(a, b, c, p);
  const int side_q = certain_q != 0 ? certain_q : exact_orientation(a, b, c, q);
  if (side_p * side_q > 0) return false;
  // The segment and the triangle are in one plane, or the triangle is a segment or a point and has no plane.
  if (side_p == 0 && side_q == 0)
    return vertex_touches_triangle(p, a, b, c) || vertex_touches_triangle(q, a, b, c) ||
           segments_touch(p, q, a, b) || segments_touch(p, q, b, c) || segments_touch(p, q, c, a);
  // The line pq is not in the plane and the segment reaches the plane in one point. They touch if that
  // point is inside the triangle.
  const int volume[3] = {orientation(p, q, a, b), orientation(p, q, b, c), orientation(p, q, c, a)};
  const auto [lowest, highest] = std::minmax_element(volume, volume + 3);
  return *lowest >= 0 || *highest <= 0;
}

bool triangles_meet(const TriangleMesh& mesh, std::span<const Vec3> positions, TriangleId a, TriangleId b) {
  const Frame frame{mesh, positions};
  if (frame.beside(a, b) || frame.beside(b, a)) return false;
  return frame.reaches(a, b) || frame.reaches(b, a);
}

// Each triangle cuts the line in which the planes meet along a segment. After both are turned, the signs of
// two volumes tell the order of the four ends on that line (Guigue and Devillers 2003, "Fast and robust
// triangle-triangle overlap test using orientation predicates"). Strict signs leave out segments that share
// one point alone.
bool triangles_cross(const TriangleMesh& mesh, std::span<const Vec3> positions, TriangleId a, TriangleId b) {
  const auto corners = [&](TriangleId t) {
    const Triangle& c = mesh.corners(t);
    return Triple{positions[+c[0]], positions[+c[1]], positions[+c[2]]};
  };
  Triple p = corners(a), q = corners(b);
  if (!part_by_plane(q, p) || !part_by_plane(p, q)) return false;
  return orientation(p[0], p[1], q[0], q[1]) < 0 && orientation(p[0], p[2], q[2], q[0]) < 0;
}

int lie_on_each_other(const TriangleMesh& mesh, std::span<const Vec3> positions, TriangleId a, TriangleId b) {
  Vec3 p[3], q[3];
  for (std::size_t i = 0; i < 3; ++i)
    p[i] = positions[+mesh.corners(a)[i]], q[i] = positions[+mesh.corners(b)[i]];
  for (const Vec3& corner : q)
    if (orientation(p[0], p[1], p[2], corner) != 0) return 0;
  // Twice the signed area of a triangle, seen along axis k, has the sign of the volume that it spans with a
  // point right above its first corner.
  const auto turn = [](const Vec3& u, const Vec3& v, const Vec3& w, int k) {
    constexpr double kInf = std::numeric_limits<double>::infinity();
    const bool is_largest = u[k] == std::numeric_limits<double>::max();  // then the point is right below
    Vec3 beside = u;
    beside[k] = std::nextafter(u[k], is_largest ? -kInf : kInf);
    return is_largest ? -orientation(u, v, w, beside) : orientation(u, v, w, beside);
  };
  for (int k = 0; k < 3; ++k) {
    const int facing_p = turn(p[0], p[1], p[2], k), facing_q = turn(q[0], q[1], q[2], k);
    if (facing_p == 0 || facing_q == 0) continue;
    // Open convex polygons of a plane are apart if and only if an edge of one has the other behind it.
    const auto has_behind = [&](const Vec3(&own)[3], int facing, const Vec3(&other)[3]) {
      for (std::size_t i = 0; i < 3; ++i)
        if (std::ranges::all_of(
                other, [&](const Vec3& x) { return facing * turn(own[i], own[(i + 1) % 3], x, k) <= 0; }))
          return true;
      return false;
    };
    return has_behind(p, facing_p, q) || has_behind(q, facing_q, p) ? 0 : facing_p * facing_q;
  }
  return 0;  // one of them has no area
}

}  // namespace cscd
