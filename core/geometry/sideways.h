#pragma once

#include "core/base/rounding.h"
#include "core/geometry/bernstein.h"
#include "core/geometry/simd_doubles.h"

// Directions along which features that come into one plane stay apart. They lie in that plane at the middle
// of the interval, across an edge or, for two edges, also across their difference. Along a direction that
// stays the same, points that move in straight lines stay between their ends, so features that are apart on
// the same side at both ends are apart at every t.
//
// One text serves a query and eight queries side by side: with doubles and bools, and with lanes.
namespace cscd {

// Three points seen from a fourth at both ends of the interval: [point][end][axis]. For a vertex and a face:
// the face's second and third corner and the vertex, seen from the first corner. For two edges: the first
// edge's other end and both ends of the second edge, seen from the first edge's first end.
template <class Real>
using SeenFromFirst = Real[3][2][3];

// Returns whether two features certainly are apart at every t in [0, 1]. The points may carry
// one rounding for each coordinate.
//
// Error bound: let m be a direction, L the largest coordinate, M = |m_x| + |m_y| + |m_z| and u =
// kUnitRoundoff. The projection of a point on m is off by at most 4.1 u M L (the point's own rounding, a
// product, two sums), and two projections by 8.2 u M L. The factor 16 also pays for the roundings of the
// bound itself. The computed m is taken as the direction, so m has no error. If the bound's M L is below
// kTinyProduct, products may lose more, and nothing is certain. If something overflows, the bound is infinite
// or NaN, and nothing exceeds it.
template <class Real, class Mask>
Mask apart_sideways(const SeenFromFirst<Real>& p, Mask vertex_face) {
  Real along[3][3], most_along[3];
  for (int i = 0; i < 3; ++i) {
    const auto twice = [&](int k) { return p[k][0][i] + p[k][1][i]; };  // at the middle of the interval
    along[0][i] = twice(0);
    along[1][i] = select(vertex_face, twice(1), Real(twice(2) - twice(1)));
    along[2][i] = along[1][i] - along[0][i];
    const auto most_of = [&](int k) { return larger(absolute(p[k][0][i]), absolute(p[k][1][i])); };
    most_along[i] = larger(larger(most_of(0), most_of(1)), most_of(2));
  }
  const Real most = larger(larger(most_along[0], most_along[1]), most_along[2]);
  const auto cross = [](const Real(&a)[3], const Real(&b)[3], Real(&out)[3]) {
    for (int i = 0; i < 3; ++i) out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
  };
  Real normal[3];
  cross(along[0], along[1], normal);

  Mask apart = {};
  for (const Real(&edge)[3] : along) {
    Real m[3];
    cross(normal, edge, m);
    const Real reach = (absolute(m[0]) + absolute(m[1]) + absolute(m[2])) * most;
    const Real slack = 16 * kUnitRoundoff * reach;
    Mask above = reach >= kTinyProduct, below = above;
    for (int end = 0; end < 2; ++end) {
      const auto at = [&](int k) { return m[0] * p[k][end][0] + m[1] * p[k][end][1] + m[2] * p[k][end][2]; };
      const Real zero = {}, x = at(0), y = at(1), z = at(2);
      const Real in_first = select(vertex_face, y, zero), in_second = select(vertex_face, z, y);
      above &= smaller(in_second, z) > larger(larger(zero, x), in_first) + slack;
      below &= larger(in_second, z) < smaller(smaller(zero, x), in_first) - slack;
    }
    apart |= above | below;
  }
  return apart;
}

}  // namespace cscd
