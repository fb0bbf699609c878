#include "core/base/rounding.h"
#include "core/detect/carried_lanes.h"
#include "core/detect/filter_block.h"

namespace cscd {
namespace {

using Vector16 = std::array<Float16, 3>;

Vector16 operator-(const Vector16& a, const Vector16& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Float16 dot(const Vector16& a, const Vector16& b) {
  return product_plus(a[2], b[2], product_plus(a[1], b[1], a[0] * b[0]));
}
Vector16 cross(const Vector16& a, const Vector16& b) {
  Vector16 out;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    out[i] = product_minus(a[j], b[k], a[k] * b[j]);
  }
  return out;
}
// The part of `v` at right angles to `edge`, times the squared length of the edge.
Vector16 across(const Vector16& edge, const Vector16& v) {
  const Float16 length = dot(edge, edge), along = dot(edge, v);
  return {v[0] * length - edge[0] * along, v[1] * length - edge[1] * along, v[2] * length - edge[2] * along};
}
Vector16 of_kind(const Vector16& vertex_face, const Vector16& edge_edge) {
  Vector16 out;
  for (std::size_t i = 0; i < 3; ++i) out[i] = select(kVertexFace, vertex_face[i], edge_edge[i]);
  return out;
}

// The way from the middle of the first triangle to that of the second, times six, in every lane.
Vector16 way(const Corners& corners) {
  Vector16 out;
  for (std::size_t i = 0; i < 3; ++i) {
    float sum = 0;
    for (const auto& [first, last] : corners.end)
      sum += first[12 + i] + last[i] + last[4 + i] - (first[i] + first[4 + i] + first[8 + i]);
    out[i] = all_lanes(sum);
  }
  return out;
}

// The lanes whose features are farther apart along a direction, on one side at both ends. Once the direction
// is divided by its largest component, a gap is off by less than 32 u times the largest coordinate of the
// points, by the bound of no_contact_before.cpp. Here points are differences of corners, so that they are up
// to twice as large as corners and round once more, which the factor 64 pays for. A direction of 0 divides to
// no number, and then no comparison holds.
struct Gaps {
  const VectorLanes16 (&point)[3];
  Float16 error, distance;

  Mask16 farther_along(Vector16 direction) const {
    const Float16 largest = larger_size(larger_size(direction[0], direction[1]), direction[2]);
    for (Float16& component : direction) component = component / largest;
    const Float16 least =
        product_plus(all_lanes(1 + 0x1p-20F) * square_root(dot(direction, direction)), distance, error);
    unsigned over = 0xffff, under = 0xffff;
    for (std::size_t end = 0; end < 2; ++end) {
      const auto at = [&](int k) {
        const Float16(&x)[3] = point[k].at[end];
        return product_plus(direction[2], x[2], product_plus(direction[1], x[1], direction[0] * x[0]));
      };
      const Float16 zero = {}, x = at(0), y = at(1), z = at(2);
      const Float16 in_first = select(kVertexFace, y, zero), in_second = select(kVertexFace, z, y);
      over &= above(smaller(in_second, z) - larger(larger(zero, x), in_first), least);
      under &= above(smaller(smaller(zero, x), in_first) - larger(in_second, z), least);
    }
    return static_cast<Mask16>(over | under);
  }
};

}  // namespace

CarriedPlaces not_farther_than(double distance, const Motion& motion, const Triangle& a, const Triangle& b,
                               CarriedPlaces places) {
  constexpr float kSmallest = 1e-20F, kLargest = 1e8F;  // beyond, products might underflow or overflow
  const Corners corners = corners_of(motion, a, b, 1);
  if (!(corners.largest >= kSmallest && corners.largest <= kLargest)) return places;
  VectorLanes16 point[3];
  CarriedLanes(corners).seen_from_first(point);
  const Gaps gaps{point, all_lanes(64 * 0x1p-24F * 2 * corners.largest),
                  all_lanes(float_not_below(distance))};

  // The points half-way, times two, and the first one at 0. Nearest points of a vertex and a face lie on the
  // face, on an edge or at a corner; those of two edges inside both, or at an end of one or of both.
  const auto half_way = [&](std::size_t k) {
    Vector16 out;
    for (std::size_t i = 0; i < 3; ++i) out[i] = point[k].at[0][i] + point[k].at[1][i];
    return out;
  };
  const Vector16 p = half_way(0), q = half_way(1), r = half_way(2), rp = r - p, rq = r - q;
  unsigned left = places;
  const auto ask = [&](const Vector16& direction) {
    left &= ~static_cast<unsigned>(gaps.farther_along(direction));
    return left == 0;
  };
  // The way from one triangle to the other parts most that share no vertex.
  if (ask(way(corners)) || ask(across(p, r)) || ask(of_kind(across(q - p, rp), across(rq, p - q))) ||
      ask(of_kind(across(q, r), across(rq, q))) || ask(of_kind(cross(p, q), cross(p, rq))) || ask(r) ||
      ask(rp) || ask(of_kind(rq, q)) || ask(of_kind(rq, q - p)) || ask(of_kind(rq, across(p, q))))
    return 0;
  return static_cast<CarriedPlaces>(left);
}

}  // namespace cscd
