#include "scenes/hard/rows.h"

namespace cscd::scenes::hard {
namespace {

Query make_collapsed(Kind kind, Random& random) {
  const Vec3 a = lattice_point(random, 6), d = lattice_direction(random, 3),
             way = lattice_direction(random, 5);
  const int s = random.integer(-1, 5), b = random.integer(0, 4), c = random.integer(0, 4);
  // If true, the features are collapsed for one instant only: the corners spread as time goes away from 1/2.
  const bool instant = flip(random);
  const auto spread = [&](const Vec3& p) {
    return through(p, instant ? lattice_point(random, 3) : Vec3(Vec3::Zero()));
  };
  if (kind == Kind::vertex_face) {
    const MovingPoint p = spread(a), q = spread(a + b * d), r = spread(a + c * d);
    return {{through(a + s * d, way), p, q, r}, {}};
  }
  const MovingPoint p = spread(a + s * d), q = spread(a + s * d);
  return {{at_rest(a), at_rest(a + 4 * d), moved(p, -way, way), moved(q, -way, way)}, {}};
}

}  // namespace

const Family kCollapsed = {"collapsed",
                           "Triangles without area, edges without length, from the start, throughout, or for "
                           "one instant: nothing has a normal, and a division by its length is one by zero.",
                           make_collapsed};

}  // namespace cscd::scenes::hard
