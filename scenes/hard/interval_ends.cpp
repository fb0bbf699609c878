#include "scenes/hard/rows.h"

namespace cscd::scenes::hard {
namespace {

Query make_interval_ends(Kind kind, Random& random) {
  const Query query = crossing(kind, random);
  const bool at_start = flip(random);
  Query cut;
  for (std::size_t k = 0; k < 4; ++k) {
    const MovingPoint& p = query.points[k];
    const Vec3 middle = p.start + (p.end - p.start) / 2;
    cut.points[k] = at_start ? MovingPoint{middle, p.end} : MovingPoint{p.start, middle};
  }
  return cut;
}

}  // namespace

const Family kIntervalEnds = {
    "interval_ends",
    "Contact at t = 0 exactly, on the way apart, or at t = 1 exactly. A root of 1 that is rounded to 1 + "
    "2^-52 is lost here and found in contact in the next interval, at its start.",
    make_interval_ends};

}  // namespace cscd::scenes::hard
