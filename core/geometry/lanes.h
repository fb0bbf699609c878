#pragma once

#include <cstddef>
#include <cstdint>

namespace cscd {

// Eight numbers side by side, in the vector types that gcc and clang share: one AVX-512 register, or several
// smaller ones. Comparisons give -1 for true and 0 for false in each lane, and `mask ? a : b` selects lane by
// lane.
inline constexpr std::size_t kLanes = 8;
using Lane8 = double __attribute__((vector_size(kLanes * sizeof(double))));
using Sign8 = std::int64_t __attribute__((vector_size(kLanes * sizeof(std::int64_t))));

inline Lane8 smaller(Lane8 a, Lane8 b) {
  return a < b ? a : b;
}
inline Lane8 larger(Lane8 a, Lane8 b) {
  return a < b ? b : a;
}
inline Lane8 absolute(Lane8 a) {
  return a < 0 ? -a : a;
}

// The same of one number, for code that is written once for both.
inline double smaller(double a, double b) {
  return a < b ? a : b;
}
inline double larger(double a, double b) {
  return a < b ? b : a;
}
inline double absolute(double a) {
  return a < 0 ? -a : a;
}

}  // namespace cscd
