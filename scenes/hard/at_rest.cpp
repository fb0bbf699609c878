#include "scenes/hard/rows.h"

namespace cscd::scenes::hard {
namespace {

Query make_at_rest(Kind kind, Random& random) {
  Query query = crossing(kind, random);
  const bool in_plane = random.integer(0, 3) != 0;
  for (MovingPoint& p : query.points) p = at_rest(in_plane ? Vec3(p.start + (p.end - p.start) / 2) : p.start);
  return query;
}

}  // namespace

const Family kAtRest = {"at_rest",
                        "Nothing moves. In contact all the time or never; every coefficient of the cubic is "
                        "the same number, often zero.",
                        make_at_rest};

}  // namespace cscd::scenes::hard
