#include "scenes/hard/rows.h"

namespace cscd::scenes::hard {
namespace {

Query make_parallel(Kind kind, Random& random) {
  const Vec3 d = lattice_direction(random, 3), a = lattice_point(random, 8);
  const int length = random.integer(1, 6), from = random.integer(-8, 8), other = random.integer(-6, 6);
  // The motion of the second feature relative to the line of the first: across the line, along the line, or
  // none.
  const Vec3 way = pick<Vec3>(random, {lattice_direction(random, 4), 2 * d, Vec3::Zero()});
  if (kind == Kind::vertex_face) {
    const Vec3 c = a + lattice_direction(random, 6);
    return {{through(a + from * d, way), at_rest(a), at_rest(a + length * d), at_rest(c)}, {}};
  }
  const Vec3 turn = flip(random) ? lattice_point(random, 2) : Vec3::Zero();
  return {{at_rest(a), at_rest(a + length * d), through(a + from * d, way),
           through(a + (from + other) * d, way + turn)},
          {}};
}

}  // namespace

const Family kParallel = {
    "parallel",
    "Edges that are parallel, or on one line, when they meet: the normal of the two is zero where it is "
    "needed. For a vertex and a face: a path along the line of one of its edges.",
    make_parallel};

}  // namespace cscd::scenes::hard
