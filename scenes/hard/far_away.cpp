#include "scenes/hard/rows.h"

namespace cscd::scenes::hard {
namespace {

Query make_far_away(Kind kind, Random& random) {
  Query query = crossing(kind, random);
  const double distance = pick(random, {0x1p10, 0x1p20, 0x1p30, 0x1p40, 0x1p44});
  const Vec3 offset = distance * lattice_direction(random, 4);
  for (MovingPoint& p : query.points) p = moved(p, offset, offset);
  return query;
}

}  // namespace

const Family kFarAway = {
    "far_away",
    "Far from the origin: coordinates leave few digits, or a single one, to the features themselves. Bounds "
    "on rounding that do not grow with the coordinates miss contacts here.",
    make_far_away};

}  // namespace cscd::scenes::hard
