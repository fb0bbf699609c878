#include "scenes/hard/rows.h"

namespace cscd::scenes::hard {
namespace {

Query make_through_border(Kind kind, Random& random) {
  const Vec3 way = lattice_direction(random, 6), drift = lattice_point(random, 2);
  const Vec3 a = lattice_point(random, 8), ab = lattice_direction(random, 4),
             ac = lattice_direction(random, 4);
  const int s = pick(random, {-1, 0, 1, 2, 3, 4, 5});  // quarters along the border; -1 and 5 miss
  if (kind == Kind::vertex_face) {
    const int side = random.integer(0, 2);
    const Vec3 target = side == 0   ? Vec3(a + s * ab)
                        : side == 1 ? Vec3(a + s * ac)
                                    : Vec3(a + s * ab + (4 - s) * ac);
    return {{through(target, way), through(a, drift), through(a + 4 * ab, drift), through(a + 4 * ac, drift)},
            {}};
  }
  const Vec3 target = a + s * ab, second = lattice_direction(random, 6);
  const int end = random.integer(0, 1);
  return {{through(a, drift), through(a + 4 * ab, drift), through(target - 4 * end * second, way),
           through(target + 4 * (1 - end) * second, way)},
          {}};
}

}  // namespace

const Family kThroughBorder = {
    "through_border",
    "A vertex goes exactly through an edge or a corner of the face, an end of an edge through the other edge "
    "or its end. One rounding to the wrong side loses it, here and for the neighbour that shares the border.",
    make_through_border};

}  // namespace cscd::scenes::hard
