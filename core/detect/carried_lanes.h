#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "core/geometry/triple_product16.h"
#include "core/mesh/motion.h"
#include "core/mesh/triangle_mesh.h"

// The fifteen feature pairs that two triangles carry (carried_pairs.h), one a lane, in single precision.
// Lanes 0 to 5 hold a vertex and a face, the others two edges; the last lane repeats the one before.
namespace cscd {

// The corners of the first triangle, then those of the second. At each end of the interval, positions are
// taken relative to the first triangle's first corner.
struct Corners {
  // Rows of four numbers (x, y, z and 0), one row a corner: corners 0 to 3 in `first`,
  // corners 4 and 5 (twice) in `last`.
  struct End {
    Float16 first, last;
  } end[2];
  float largest;  // absolute coordinate
  float beyond;   // largest absolute coordinate at t = 1, where the interval is cut short; otherwise 0

  // Returns a bound of a coordinate's error: u times the largest coordinate, and the rounding of differences
  // in doubles. Where the interval is cut short, each coordinate at its end comes from the coordinates at
  // t = 0 and t = 1, which rounds a few times more: by at most 2^-49 times `beyond`.
  float error() const { return 1.01F * 0x1p-24F * largest + 0x1p-49F * beyond; }
};

// The corners as the first corner of the first triangle sees them: b0 and the others of `a`, then the
// others of `b`.
using Seen = std::array<Double4, 5>;
inline Seen seen(std::span<const Vec3> x, const Triangle& a, const Triangle& b) {
  const Double4 from = row_of(x[+a[0]]);
  const auto at = [&](VertexId v) { return row_of(x[+v]) - from; };
  return {at(a[1]), at(a[2]), at(b[0]), at(b[1]), at(b[2])};
}

inline Corners::End narrowed(const Seen& seen) {
  const auto row = [&](std::size_t i) { return converted<Float4>(seen[i]); };
  const Float8 last = joined<Float8>(row(3), row(4));
  return {joined<Float16>(joined<Float8>(Float4{}, row(0)), joined<Float8>(row(1), row(2))),
          joined<Float16>(last, last)};
}

inline float largest_of(const Corners::End& end) {
  return folded(larger_size(end.first, end.last), [](auto x, auto y) { return larger(x, y); });
}

// The corners at t = 0 and at t = last.
inline Corners corners_of(const Motion& motion, const Triangle& a, const Triangle& b, double last) {
  const Seen start = seen(motion.start(), a, b);
  Seen end = seen(motion.end(), a, b);
  float beyond = 0;
  if (last < 1) {
    beyond = largest_of(narrowed(end));
    for (std::size_t i = 0; i < end.size(); ++i) end[i] = start[i] + last * (end[i] - start[i]);
  }
  const Corners::End ends[2] = {narrowed(start), narrowed(end)};
  return {{ends[0], ends[1]}, std::max(largest_of(ends[0]), largest_of(ends[1])), beyond};
}

// Returns one corner in each lane. The first fifteen of the sixteen lanes stand for the places.
template <int... kCorner>
VectorLanes16 points(const Corners& c) {
  VectorLanes16 out;
  for (int end = 0; end < 2; ++end) {
    const auto [first, last] = c.end[end];
    out.at[end][0] = shuffled<4 * kCorner...>(first, last);
    out.at[end][1] = shuffled<4 * kCorner + 1 ...>(first, last);
    out.at[end][2] = shuffled<4 * kCorner + 2 ...>(first, last);
  }
  return out;
}

inline constexpr Int16 kVertexFace = {-1, -1, -1, -1, -1, -1};
inline VectorLanes16 chosen(const VectorLanes16& vertex_face, const VectorLanes16& edge_edge) {
  VectorLanes16 out;
  for (int end = 0; end < 2; ++end)
    for (int i = 0; i < 3; ++i)
      out.at[end][i] = select(kVertexFace, vertex_face.at[end][i], edge_edge.at[end][i]);
  return out;
}

// The vectors of sixteen feature pairs. Their products are as in core/elementary/question/filter.h.
struct CarriedLanes {
  VectorLanes16 from, second, p, q, r;

  explicit CarriedLanes(const Corners& c)
      : from(points<3, 3, 3, 0, 0, 0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2>(c)),
        second(points<5, 5, 5, 2, 2, 2, 4, 5, 3, 4, 5, 3, 4, 5, 3, 3>(c)),
        p(points<4, 4, 4, 1, 1, 1, 1, 1, 1, 2, 2, 2, 0, 0, 0, 0>(c) - from),
        q(second - points<3, 3, 3, 0, 0, 0, 3, 4, 5, 3, 4, 5, 3, 4, 5, 5>(c)),
        r(points<0, 1, 2, 3, 4, 5, 3, 4, 5, 3, 4, 5, 3, 4, 5, 5>(c) - from) {}

  // Three of the four points as the first one sees them: of a face, the second and third corner, and the
  // vertex; of two edges, the first one's other end and both ends of the second.
  void seen_from_first(VectorLanes16 (&out)[3]) const {
    out[0] = p, out[1] = chosen(q, r), out[2] = chosen(r, second - from);
  }
};

}  // namespace cscd
