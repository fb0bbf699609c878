#include "scenes/hard/rows.h"

namespace cscd::scenes::hard {
namespace {

Query make_small_integers(Kind, Random& random) {
  Query query;
  for (MovingPoint& p : query.points) {
    const Vec3 start = lattice_point(random, 2);
    p = {start, lattice_point(random, 2)};
  }
  return query;
}

}  // namespace

const Family kSmallIntegers = {
    "small_integers",
    "Coordinates of 0, 1 and 2, at random: every degeneracy comes up by chance, several at once.",
    make_small_integers};

}  // namespace cscd::scenes::hard
