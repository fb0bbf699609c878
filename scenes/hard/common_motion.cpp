#include "scenes/hard/rows.h"

namespace cscd::scenes::hard {
namespace {

Query make_common_motion(Kind kind, Random& random) {
  Query query = crossing(kind, random);
  const Vec3 common = 0x1p24 * lattice_direction(random, 4);
  for (MovingPoint& p : query.points) p.end += common;
  return query;
}

}  // namespace

const Family kCommonMotion = {
    "common_motion",
    "Everything moves together by a million times its size while it crosses by its size: the swept bounds "
    "are all of space, and the digits of the relative motion are the last of the absolute one.",
    make_common_motion};

}  // namespace cscd::scenes::hard
