#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstring>
#include <span>

#ifndef EIGEN_VECTORIZE
// Eigen adds three numbers as x + (y + z) where it has no vector instructions, as on WebAssembly, and as
// (x + y) + z where it has. Here it does the latter everywhere, so that answers are the same to the last bit.
template <class Operation, class Expression>
struct Eigen::internal::redux_novec_unroller<Operation, Expression, 0, 3> {
  static auto run(const Expression& v, const Operation& add) {
    return add(add(redux_novec_unroller<Operation, Expression, 0, 1>::run(v, add),
                   redux_novec_unroller<Operation, Expression, 1, 1>::run(v, add)),
               redux_novec_unroller<Operation, Expression, 2, 1>::run(v, add));
  }
};
#endif

namespace cscd {

// A point or a vector in space, in lengths of the scene. An array of n Vec3 is a
// tightly packed array of 3 n doubles.
using Vec3 = Eigen::Vector3d;
static_assert(sizeof(Vec3) == 3 * sizeof(double));

// Returns whether two lists hold the same points, bit for bit; so 0 and -0 differ.
inline bool same_bits(std::span<const Vec3> a, std::span<const Vec3> b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

}  // namespace cscd
