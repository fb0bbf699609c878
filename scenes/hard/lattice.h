#pragma once

#include "scenes/hard/family.h"

// Building blocks of the families.
namespace cscd::scenes::hard {

// A point with integer coordinates in [-reach, reach].
inline Vec3 lattice_point(Random& random, int reach) {
  const auto coordinate = [&] { return static_cast<double>(random.integer(-reach, reach)); };
  const double x = coordinate(), y = coordinate(), z = coordinate();
  return {x, y, z};
}
// The same, but never zero.
inline Vec3 lattice_direction(Random& random, int reach) {
  for (;;)
    if (const Vec3 v = lattice_point(random, reach); v != Vec3::Zero()) return v;
}
inline MovingPoint at_rest(const Vec3& p) {
  return {p, p};
}
// A point that is at x at t = 1/2 and moves by `half_way` in half the interval.
inline MovingPoint through(const Vec3& x, const Vec3& half_way) {
  return {x - half_way, x + half_way};
}
inline MovingPoint moved(const MovingPoint& p, const Vec3& by_start, const Vec3& by_end) {
  return {p.start + by_start, p.end + by_end};
}
inline bool flip(Random& random) {
  return random.integer(0, 1) == 1;
}
template <class T>
T pick(Random& random, std::initializer_list<T> from) {
  return from.begin()[random.integer(0, static_cast<int>(from.size()) - 1)];
}

// Features in general position that touch at t = 1/2 or pass each other by one lattice step. Families of
// place and scale start from them. Coordinates are at most 64.
inline Query crossing(Kind kind, Random& random) {
  const Vec3 away = lattice_direction(random, 6);
  // The touching point, in quarters of the features' size. It is inside, on a border, or one quarter outside.
  const int u = random.integer(-1, 3), v = random.integer(0, 3 - std::max(u, 0));
  if (kind == Kind::vertex_face) {
    const Vec3 a = lattice_point(random, 8), ab = lattice_direction(random, 6),
               ac = lattice_direction(random, 6);
    const auto drift = [&] { return lattice_point(random, 1); };
    return {{through(a + u * ab + v * ac, away), through(a, drift()), through(a + 4 * ab, drift()),
             through(a + 4 * ac, drift())},
            {}};
  }
  const Vec3 x = lattice_point(random, 8), d = lattice_direction(random, 6), e = lattice_direction(random, 6);
  const Vec3 drift = lattice_point(random, 1);
  return {{through(x - u * d, drift), through(x + (4 - u) * d, drift), through(x - v * e, away),
           through(x + (4 - v) * e, away)},
          {}};
}

}  // namespace cscd::scenes::hard
