#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/geometry/bernstein.h"
#include "core/geometry/simd_doubles.h"
#include "core/mesh/motion.h"

// Eight triple products side by side. They do, operation for operation, what triple_product and certain_sign
// do, which are the scalar twins: equal bits, equal signs.
namespace cscd {

// Eight moving vectors: [end][axis].
struct VectorLanes {
  Lane8 at[2][3];

  Lane8 largest_component() const {
    const auto largest = [this](int end) {
      return larger(larger(absolute(at[end][0]), absolute(at[end][1])), absolute(at[end][2]));
    };
    return larger(largest(0), largest(1));
  }
};

// Eight vertices, each stored as the offset of its x coordinate in an array of positions.
struct VertexLanes {
  std::array<std::int32_t, kLanes> offset;
  void set(std::size_t lane, VertexId vertex) { offset[lane] = 3 * static_cast<std::int32_t>(vertex); }

  Lane8 gather(const double* x) const {
    const auto& o = offset;
    return Lane8{x[o[0]], x[o[1]], x[o[2]], x[o[3]], x[o[4]], x[o[5]], x[o[6]], x[o[7]]};
  }
};

inline VectorLanes gather(const Motion& motion, const VertexLanes& vertex) {
  const double* const ends[2] = {motion.start().data()->data(), motion.end().data()->data()};
  VectorLanes out;
  for (int end = 0; end < 2; ++end)
    for (int i = 0; i < 3; ++i) out.at[end][i] = vertex.gather(ends[end] + i);
  return out;
}

inline VectorLanes operator-(const VectorLanes& to, const VectorLanes& from) {
  VectorLanes out;
  for (int end = 0; end < 2; ++end)
    for (int i = 0; i < 3; ++i) out.at[end][i] = to.at[end][i] - from.at[end][i];
  return out;
}

// a(t) x b(t) for eight pairs of vectors: the control vectors n0, 2 n1 and n2, and the product of the largest
// components of a and b, which scales the rounding.
struct NormalLanes {
  Lane8 control[3][3];
  Lane8 area;
};

// Takes that product as `area`.
inline NormalLanes cross(const VectorLanes& a, const VectorLanes& b, Lane8 area) {
  NormalLanes normal;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    normal.control[0][i] = a.at[0][j] * b.at[0][k] - a.at[0][k] * b.at[0][j];
    normal.control[1][i] = (a.at[0][j] * b.at[1][k] - a.at[0][k] * b.at[1][j]) +
                           (a.at[1][j] * b.at[0][k] - a.at[1][k] * b.at[0][j]);
    normal.control[2][i] = a.at[1][j] * b.at[1][k] - a.at[1][k] * b.at[1][j];
  }
  normal.area = area;
  return normal;
}
inline NormalLanes cross(const VectorLanes& a, const VectorLanes& b) {
  return cross(a, b, a.largest_component() * b.largest_component());
}

using BernsteinLanes = BernsteinCubicOf<Lane8>;

// Returns the cubics (a x b) . c. The components of c may be off by `c_slack`, an absolute bound.
inline BernsteinLanes triple_products(const NormalLanes& normal, const VectorLanes& c, double c_slack = 0) {
  const auto dot = [&](int n, int end) {
    return normal.control[n][0] * c.at[end][0] + normal.control[n][1] * c.at[end][1] +
           normal.control[n][2] * c.at[end][2];
  };
  const Lane8 volume = normal.area * c.largest_component();
  const Sign8 known = (normal.area >= kTinyProduct) & (normal.area <= kHugeProduct) &
                      (volume >= kTinyProduct) & (volume <= kHugeProduct);
  const Lane8 unknown = Lane8{} + std::numeric_limits<double>::infinity();
  return {{dot(0, 0), (dot(1, 0) + dot(0, 1)) / 3, (dot(1, 1) + dot(2, 0)) / 3, dot(2, 1)},
          select(known, kTripleProductError * volume + 7 * normal.area * c_slack, unknown)};
}

// Returns, for each lane, +1 or -1 if the cubic certainly has that sign for every t in [0, 1], else 0.
inline Sign8 certain_sign(const BernsteinLanes& f) {
  const Lane8 error = f.error;
  // A true comparison is -1 in its lane. Every coefficient is compared by itself,
  // because a minimum may lose a NaN.
  const Sign8 positive = (f.c[0] > error) & (f.c[1] > error) & (f.c[2] > error) & (f.c[3] > error);
  const Sign8 negative = (f.c[0] < -error) & (f.c[1] < -error) & (f.c[2] < -error) & (f.c[3] < -error);
  return negative - positive;
}
inline Sign8 certain_signs(const NormalLanes& normal, const VectorLanes& c, double c_slack = 0) {
  return certain_sign(triple_products(normal, c, c_slack));
}

}  // namespace cscd
