#include "scenes/hard/rows.h"

namespace cscd::scenes::hard {
namespace {

Query make_symmetric(Kind, Random& random) {
  const int half = random.integer(1, 4), motion = random.integer(0, 3);
  const auto corner = [&] {
    const double x = flip(random) ? half : -half, y = flip(random) ? half : -half,
                 z = flip(random) ? half : -half;
    return Vec3(x, y, z);
  };
  const bool hollow = flip(random);  // points are middles of the cube's edges, else corners
  Query query;
  for (MovingPoint& p : query.points) {
    Vec3 start = corner();
    if (hollow) start[random.integer(0, 2)] = 0;
    const Vec3 ends[] = {-start,
                         {start.y(), start.z(), start.x()},
                         {-start.x(), start.y(), start.z()},
                         {-start.y(), start.x(), start.z()}};
    p = {start, ends[motion]};
  }
  return query;
}

}  // namespace

const Family kSymmetric = {
    "symmetric",
    "Corners of a cube that turn inside out, mirror or rotate: several pairs of features touch at one "
    "instant, at one point, and which is first must not depend on who is asked first.",
    make_symmetric};

}  // namespace cscd::scenes::hard
