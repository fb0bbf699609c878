#include "core/fast/certify/parting.h"

#include "core/fast/classify/patch_lanes.h"

namespace cscd::fast {
namespace {

// Sixteen triangles, one a lane.
struct TriangleLanes {
  VectorLanes16 corner[3];
  Mask16 shared[3];  // lanes in which the other triangle has this corner too
};

TriangleLanes load(std::span<const LocalPositions::Record> records, const PairLanes::Vertices& own,
                   const PairLanes::Vertices& other) {
  TriangleLanes triangles;
  for (std::size_t k = 0; k < 3; ++k) {
    triangles.corner[k] = load(records, own[k]);
    triangles.shared[k] = equal(own[k], other[0]) | equal(own[k], other[1]) | equal(own[k], other[2]);
  }
  return triangles;
}

// Returns the lanes in which the plane of the first triangle has all of the second on one side.
Mask16 parted_by_plane(const TriangleLanes& of, const TriangleLanes& other, float error) {
  const VectorLanes16 a = of.corner[1] - of.corner[0], b = of.corner[2] - of.corner[0];
  Float16 normal[3][3];
  cross(a, b, normal);
  const Rounding16 rounding = rounding_of(largest_component(a), largest_component(b), error);
  unsigned above = 0xffff, below = 0xffff, any = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const TripleProducts16 products =
        triple_products(normal, other.corner[k] - of.corner[0], rounding, error);
    const unsigned positive = products.positive(), negative = products.negative();
    above &= positive | other.shared[k];
    below &= negative | other.shared[k];
    any |= positive | negative;  // shared corners lie in the plane and do not count
  }
  return static_cast<Mask16>((above | below) & any);
}

// Rounding of gaps. Let u = 2^-24 and r = `reach`, the largest component of any corner as seen from the first
// corner of the first triangle. A component is off by 2 `error` for the coordinates and by u r for their
// difference. A projection on a direction d of size |d| = |dx| + |dy| + |dz|, which is exact as it is, rounds
// by 3 u |d| r on top, and the difference of two projections by 2 u |d| r. So a gap is off by at most
// |d| (4 error + 10 u r). The larger factors below also pay for the roundings of the bound itself, and kTiny
// for underflow.
constexpr float kErrors = 4.2F, kRoundings = 12;

// The corners of sixteen pairs of triangles at both ends, seen from the first corner of the first triangle.
struct GapLanes {
  VectorLanes16 corner[2][3];  // [triangle][corner]
  Float16 rounding;            // by how much a gap may be off, along a direction of size 1
};

// Returns the lanes in which one triangle lies on one side of the other along a direction, at both ends.
[[gnu::always_inline]] inline Mask16 parted_along(const GapLanes& lanes, const Float16 (&d)[3]) {
  const Float16 size = absolute(d[0]) + absolute(d[1]) + absolute(d[2]);
  const Float16 bound = product_plus(size, lanes.rounding, all_lanes(Rounding16::kTiny));
  unsigned over = 0xffff, under = 0xffff;
  for (int end = 0; end < 2; ++end) {
    Float16 low[2], high[2];
    for (std::size_t t = 0; t < 2; ++t) {
      Float16 at[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& c = lanes.corner[t][k].at[end];
        at[k] = product_plus(d[2], c[2], product_plus(d[1], c[1], d[0] * c[0]));
      }
      low[t] = smaller(smaller(at[0], at[1]), at[2]);
      high[t] = larger(larger(at[0], at[1]), at[2]);
    }
    over &= above(low[1] - high[0], bound);
    under &= above(low[0] - high[1], bound);
  }
  return static_cast<Mask16>(over | under);
}

// Computes twice the edge of a triangle that leaves corner k, half-way through the interval.
inline void edge_half_way(const VectorLanes16 (&corner)[3], std::size_t k, Float16 (&out)[3]) {
  const VectorLanes16 &from = corner[k], &to = corner[(k + 1) % 3];
  for (int i = 0; i < 3; ++i) out[i] = (to.at[0][i] - from.at[0][i]) + (to.at[1][i] - from.at[1][i]);
}

// Computes three times the motion of the second triangle as seen from the first one.
inline void relative_motion(const GapLanes& lanes, Float16 (&out)[3]) {
  for (int i = 0; i < 3; ++i) {
    out[i] = Float16{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto &first = lanes.corner[0][k].at, &second = lanes.corner[1][k].at;
      out[i] += (second[1][i] - second[0][i]) - (first[1][i] - first[0][i]);
    }
  }
}

// Returns the lanes in which one triangle stays on one side of the other along a direction at right angles to
// an edge of each, or to an edge of one and the relative motion.
Mask16 parted_by_edges(const GapLanes& lanes) {
  Float16 a[3][3], b[3][3], motion[3];
  for (std::size_t k = 0; k < 3; ++k)
    edge_half_way(lanes.corner[0], k, a[k]), edge_half_way(lanes.corner[1], k, b[k]);
  relative_motion(lanes, motion);
  unsigned parted = 0;
  const auto ask = [&](const Float16(&p)[3], const Float16(&q)[3]) {
    Float16 d[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t x = (k + 1) % 3, y = (k + 2) % 3;
      d[k] = product_minus(p[x], q[y], p[y] * q[x]);
    }
    parted |= parted_along(lanes, d);
  };
  for (const auto& edge : a)
    for (const auto& other : b) ask(edge, other);
  for (const auto& edge : a) ask(edge, motion);
  for (const auto& edge : b) ask(edge, motion);
  return static_cast<Mask16>(parted);
}

}  // namespace

Mask16 not_parted(std::span<const LocalPositions::Record> records, const PairLanes& pairs, float error) {
  const TriangleLanes first = load(records, pairs.first, pairs.second);
  const TriangleLanes second = load(records, pairs.second, pairs.first);
  return static_cast<Mask16>(
      ~(parted_by_plane(first, second, error) | parted_by_plane(second, first, error)));
}

Mask16 not_parted_by_edges(std::span<const LocalPositions::Record> records, const PairLanes& pairs,
                           float error) {
  const TriangleLanes first = load(records, pairs.first, pairs.second);
  const TriangleLanes second = load(records, pairs.second, pairs.first);
  GapLanes lanes;
  Float16 reach = {};
  for (std::size_t k = 0; k < 3; ++k) {
    lanes.corner[0][k] = first.corner[k] - first.corner[0];
    lanes.corner[1][k] = second.corner[k] - first.corner[0];
    for (const auto& corner : lanes.corner) reach = larger(reach, largest_component(corner[k]));
  }
  lanes.rounding = product_plus(all_lanes(kRoundings * 0x1p-24F), reach, all_lanes(kErrors * error));
  const unsigned shared = first.shared[0] | first.shared[1] | first.shared[2];
  return static_cast<Mask16>(~parted_by_edges(lanes) | shared);
}

}  // namespace cscd::fast
