#include <algorithm>
#include <limits>

#include "core/geometry/simd_doubles.h"
#include "core/hierarchy/bounds.h"

// Bounds of eight vertices at a time. A projection is an exact sum of two coordinates, stored as
// the rounded sum and its error. The smaller of the projections at both ends of the interval is
// rounded down, and the larger one up.
namespace cscd {
namespace {

using Float8 = HalfOf<float>;
using Mask8 = HalfOf<std::int32_t>;
// Unsigned, because lanes that are not chosen step as well and may wrap round.
using Bits8 = HalfOf<std::uint32_t>;

// The exact number value + error.
struct Exact8 {
  Lane8 value, error;
  Exact8 operator-() const { return {-value, -error}; }
};

Exact8 sum(Lane8 x, Lane8 y) {
  const Lane8 value = x + y, y_part = value - x;
  return {value, (x - (value - y_part)) + (y - y_part)};
}

Exact8 lesser(const Exact8& a, const Exact8& b) {
  const Sign8 second = (b.value < a.value) | ((b.value == a.value) & (b.error < a.error));
  return {select(second, b.value, a.value), select(second, b.error, a.error)};
}

// Returns the largest float that is not above each number: float_below_sum() for eight numbers.
Float8 rounded_down(const Exact8& x) {
  const Float8 nearest = converted<Float8>(x.value);
  const Lane8 widened = converted<Lane8>(nearest);
  const Lane8 infinity = Lane8{} + std::numeric_limits<double>::infinity();
  const Sign8 above = (widened > x.value) | ((widened == x.value) & (x.error < 0)) | (x.value == infinity);

  const Bits8 bits = bits_as<Bits8>(nearest);
  const Bits8 smallest_negative = Bits8{} + 0x80000001u;
  const Bits8 stepped = select(nearest == 0, smallest_negative, select(nearest > 0, bits - 1, bits + 1));
  const Float8 lowest = Float8{} - std::numeric_limits<float>::infinity();
  const Mask8 steps = converted<Mask8>(above) & (nearest != lowest);
  return bits_as<Float8>(select(steps, stepped, bits));
}

struct Position8 {
  Lane8 x, y, z;
};

Position8 load(std::span<const Vec3> points, std::size_t first) {
  Position8 p;
  for (std::size_t l = 0; l < kLanes; ++l) {
    const Vec3& point =
        points[std::min(first + l, points.size() - 1)];  // a short last block repeats its last vertex
    p.x[l] = point.x(), p.y[l] = point.y(), p.z[l] = point.z();
  }
  return p;
}

// Stores the bounds along M directions, at most eight. Directions that `out` has
// beyond those are left at zero.
template <std::size_t N, std::size_t M>
void store(const Exact8 (&at_start)[M], const Exact8 (&at_end)[M], std::span<Slabs<N>> out) {
  Float8 rows[2 * N] = {};
  for (std::size_t k = 0; k < M; ++k) {
    rows[k] = rounded_down(lesser(at_start[k], at_end[k]));
    rows[N + k] = rounded_down(lesser(-at_start[k], -at_end[k]));
  }
  const std::size_t count = std::min(kLanes, out.size());
  for (std::size_t l = 0; l < count; ++l)
    for (std::size_t k = 0; k < 2 * N; ++k) out[l].at_least[k] = rows[k][l];
}

}  // namespace

void swept_vertex_bounds(const Motion& motion, std::span<Kdop16> out) {
  for (std::size_t first = 0; first < out.size(); first += kLanes) {
    const Position8 p = load(motion.start(), first), q = load(motion.end(), first);
    const Lane8 none = {};
    const Exact8 at_start[8] = {{p.x, none},   {p.y, none},   {p.z, none},    sum(p.x, p.y),
                                sum(p.x, p.z), sum(p.y, p.z), sum(p.x, -p.y), sum(p.x, -p.z)};
    const Exact8 at_end[8] = {{q.x, none},   {q.y, none},   {q.z, none},    sum(q.x, q.y),
                              sum(q.x, q.z), sum(q.y, q.z), sum(q.x, -q.y), sum(q.x, -q.z)};
    store(at_start, at_end, out.subspan(first));
  }
}

void swept_vertex_bounds(const Motion& motion, std::span<Aabb> out) {
  for (std::size_t first = 0; first < out.size(); first += kLanes) {
    const Position8 p = load(motion.start(), first), q = load(motion.end(), first);
    const Lane8 none = {};
    const Exact8 at_start[3] = {{p.x, none}, {p.y, none}, {p.z, none}};
    const Exact8 at_end[3] = {{q.x, none}, {q.y, none}, {q.z, none}};
    store(at_start, at_end, out.subspan(first));
  }
}

}  // namespace cscd
