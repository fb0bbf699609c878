#include "scenes/hard/rows.h"

namespace cscd::scenes::hard {
namespace {

Query make_coplanar_sliding(Kind, Random& random) {
  const Vec3 o = lattice_point(random, 8), e1 = lattice_direction(random, 3),
             e2 = lattice_direction(random, 3);
  const Vec3 drift = flip(random) ? lattice_point(random, 4) : Vec3::Zero();
  const auto in_plane = [&] {
    const int i = random.integer(-8, 8), j = random.integer(-8, 8);
    return Vec3(o + i * e1 + j * e2);
  };
  Query query;
  for (MovingPoint& p : query.points) {
    const Vec3 start = in_plane();
    p = {start, in_plane() + drift};
  }
  return query;
}

}  // namespace

const Family kCoplanarSliding = {
    "coplanar_sliding",
    "All four points stay in one plane, which may move. The coplanarity cubic is zero throughout, so tests "
    "that look for its roots find none, or all times. Contact is a question of two dimensions.",
    make_coplanar_sliding};

}  // namespace cscd::scenes::hard
