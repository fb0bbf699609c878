#include "scenes/hard/rows.h"

namespace cscd::scenes::hard {
namespace {

Query make_folded_neighbours(Kind kind, Random& random) {
  const Vec3 p = lattice_point(random, 6), pq = lattice_direction(random, 4),
             pr = lattice_direction(random, 4);
  const Vec3 normal = pq.cross(pr);
  const int u = random.integer(-1, 4), v = random.integer(0, 4);
  const Vec3 shut = p + u * pq + v * pr;  // the place of the other apex when the triangles are shut
  const double beyond = pick(random, {0, 0, 1, -1});
  const MovingPoint apex{shut + normal, shut - beyond * normal};
  const Vec3 q = p + 4 * pq, r = p + 4 * pr;
  if (kind == Kind::vertex_face) return {{apex, at_rest(p), at_rest(q), at_rest(r)}, {}};
  return {{at_rest(p), at_rest(r), at_rest(q), apex}, {}};
}

}  // namespace

const Family kFoldedNeighbours = {
    "folded_neighbours",
    "Two triangles with a common edge that fold shut to exact coplanarity, or through each other. What is "
    "tested are the features that they do not share; they start and stay next to each other.",
    make_folded_neighbours};

}  // namespace cscd::scenes::hard
