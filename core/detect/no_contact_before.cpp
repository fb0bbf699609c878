#include <algorithm>

#include "core/base/rounding.h"
#include "core/detect/filter_block.h"
#include "core/geometry/triple_product16.h"

namespace cscd {
namespace {

// Sixteen triangle pairs: the corners of the first triangles, then those of the second. At each end of the
// interval, positions are taken relative to the first triangle's first corner.
struct PairCorners {
  VectorLanes16 corner[6];
};

using Rows = std::array<Float4, kLanes16>;  // x, y, z and 0 of each triangle pair

void transpose(const Rows& rows, Float16 (&out)[3]) {
  Float16 four[4];  // four triangle pairs each
  for (std::size_t i = 0; i < 4; ++i) four[i] = loaded<Float16>(reinterpret_cast<const float*>(&rows[4 * i]));
  const auto both = [](Float16 a, Float16 b) {  // x of eight triangle pairs, then y
    return shuffled<0, 4, 8, 12, 16, 20, 24, 28, 1, 5, 9, 13, 17, 21, 25, 29>(a, b);
  };
  const auto last = [](Float16 a, Float16 b) {
    return shuffled<2, 6, 10, 14, 18, 22, 26, 30, 2, 6, 10, 14, 18, 22, 26, 30>(a, b);
  };
  const Float16 low = both(four[0], four[1]), high = both(four[2], four[3]);
  out[0] = shuffled<0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23>(low, high);
  out[1] = shuffled<8, 9, 10, 11, 12, 13, 14, 15, 24, 25, 26, 27, 28, 29, 30, 31>(low, high);
  out[2] = shuffled<0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23>(last(four[0], four[1]),
                                                                            last(four[2], four[3]));
}

PairCorners corners_of(const TriangleMesh& mesh, const Motion& motion, std::span<const TrianglePair> pairs) {
  Rows rows[2][6] = {};
  const std::span<const Vec3> ends[2] = {motion.start(), motion.end()};
  for (std::size_t l = 0; l < pairs.size(); ++l) {
    const Triangle &a = mesh.corners(pairs[l].a), &b = mesh.corners(pairs[l].b);
    for (std::size_t end = 0; end < 2; ++end) {
      const auto at = [&](VertexId v) { return row_of(ends[end][+v]); };
      const Double4 from = at(a[0]);
      for (std::size_t k = 0; k < 3; ++k) {
        rows[end][k][l] = converted<Float4>(at(a[k]) - from);
        rows[end][3 + k][l] = converted<Float4>(at(b[k]) - from);
      }
    }
  }
  PairCorners out;
  for (std::size_t end = 0; end < 2; ++end)
    for (std::size_t k = 0; k < 6; ++k) transpose(rows[end][k], out.corner[k].at[end]);
  return out;
}

// Returns the time at which the straight line from `start` to `end` falls to 0: a little less than that time,
// 2 if the line stays above 0, and 0 if it starts at 0 or below.
Float16 meets_zero(Float16 start, Float16 end) {
  const Float16 share = (1 - 0x1p-20F) * (start / (start - end)), zero = {}, never = all_lanes(2);
  return select(start > 0, select(end > 0, never, share), zero);
}

// Returns a time before which the triangles of each pair certainly do not touch, judged along one direction.
// No coordinate exceeds `reach`.
//
// Rounding. Let u = 2^-24 and M = `reach`. Coordinates are off by at most d = 1.01 u M: by u times
// themselves, and by the rounding of the difference in doubles. The direction counts as exact; let N be its
// largest component. A projection is off by 3 d N, and by 9 u M N for its own roundings. The gap between two
// projections is off by twice that and 6 u M N. That is less than 31 u M N; the factor 32 also pays for the
// roundings of this bound. Below kTiny products might underflow and above kHuge they might overflow, and
// nothing is known. The time is then computed from numbers that count as exact, with few roundings.
//
// The length of the direction, for a distance above 0, is computed from components that are divided by the
// largest, so that no square vanishes; where all are 0 it is no number, and nothing is known.
Float16 no_contact_before(const PairCorners& pairs, const Float16 (&direction)[3], Float16 reach,
                          float distance) {
  constexpr float kTiny = 1e-30F, kHuge = 1e30F;
  const Float16 error =
      (32 * 0x1p-24F) * reach * larger_size(larger_size(direction[0], direction[1]), direction[2]);
  Float16 over[2], under[2], least = error;
  if (distance > 0) {
    const Float16 largest = larger_size(larger_size(direction[0], direction[1]), direction[2]);
    Float16 squares = {};
    for (const Float16& component : direction)
      squares = product_plus(component / largest, component / largest, squares);
    least = product_plus(all_lanes(distance) * largest, (1 + 0x1p-20F) * square_root(squares), error);
  }
  for (int end = 0; end < 2; ++end) {
    const auto along = [&](int k) {
      const Float16(&x)[3] = pairs.corner[k].at[end];
      return product_plus(direction[2], x[2], product_plus(direction[1], x[1], direction[0] * x[0]));
    };
    const Float16 zero = {}, a = along(1), b = along(2), c = along(3), d = along(4), e = along(5);
    over[end] = smaller(smaller(c, d), e) - larger(larger(zero, a), b) - least;
    under[end] = smaller(smaller(zero, a), b) - larger(larger(c, d), e) - least;
  }
  const Float16 before = larger(meets_zero(over[0], over[1]), meets_zero(under[0], under[1])), zero = {};
  return select((error > kTiny) & (error < kHuge), before, zero);
}

}  // namespace

std::array<float, kLanes16> no_contact_before(const TriangleMesh& mesh, const Motion& motion,
                                              std::span<const TrianglePair> pairs, double distance) {
  const float not_below = float_not_below(distance);
  const PairCorners corners = corners_of(mesh, motion, pairs);
  const VectorLanes16(&p)[6] = corners.corner;
  Float16 reach = {}, before = {};
  for (const VectorLanes16& corner : p) reach = larger(reach, largest_component(corner));
  const auto take = [&](const Float16(&direction)[3]) {
    before = larger(before, no_contact_before(corners, direction, reach, not_below));
  };
  const Float16 zero = {}, one = all_lanes(1);
  take({one, zero, zero}), take({zero, one, zero}), take({zero, zero, one});
  Float16 way[3] = {};
  for (int end = 0; end < 2; ++end) {
    for (int triangle = 0; triangle < 6; triangle += 3) {
      Float16 a[3], b[3], normal[3];
      for (int i = 0; i < 3; ++i) {
        a[i] = p[triangle + 1].at[end][i] - p[triangle].at[end][i];
        b[i] = p[triangle + 2].at[end][i] - p[triangle].at[end][i];
        way[i] += (triangle == 0 ? -1.0F : 1.0F) *
                  (p[triangle].at[end][i] + p[triangle + 1].at[end][i] + p[triangle + 2].at[end][i]);
      }
      for (int i = 0; i < 3; ++i)
        normal[i] = product_minus(a[(i + 1) % 3], b[(i + 2) % 3], a[(i + 2) % 3] * b[(i + 1) % 3]);
      take(normal);
    }
  }
  take(way);
  std::array<float, kLanes16> out;
  store(before, out.data());
  return out;
}

}  // namespace cscd
