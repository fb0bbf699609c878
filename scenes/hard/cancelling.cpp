#include "scenes/hard/rows.h"

namespace cscd::scenes::hard {
namespace {

Query make_cancelling(Kind, Random& random) {
  const Vec3 e1 = lattice_direction(random, 1 << 10), e2 = lattice_direction(random, 1 << 10);
  Query query;
  for (MovingPoint& p : query.points) {
    const auto in_plane = [&] {
      const int i = random.integer(-1 << 9, 1 << 9), j = random.integer(-1 << 9, 1 << 9);
      return Vec3(i * e1 + j * e2);
    };
    const Vec3 step = lattice_point(random, 1), start = in_plane();
    const Vec3 end = flip(random) ? in_plane() : start;
    p = {start - step, end + step};
  }
  return query;
}

}  // namespace

const Family kCancelling = {
    "cancelling",
    "Within a lattice step of one plane throughout, with coordinates of a million: the cubic is a sum of "
    "products of 1e18 that cancel to a number of a few digits, or to none.",
    make_cancelling};

}  // namespace cscd::scenes::hard
