#include "scenes/hard/rows.h"

namespace cscd::scenes::hard {
namespace {

Query make_extreme_scale(Kind kind, Random& random) {
  Query query = crossing(kind, random);
  const bool mixed = flip(random);
  const double all = pick(random, {0x1p-1074, 0x1p-1060, 0x1p-1000, 0x1p-500, 0x1p498, 0x1p990});
  const double x = pick(random, {0x1p-1070, 0x1p-300, 1.0}), z = pick(random, {1.0, 0x1p300, 0x1p990});
  const Vec3 scale = mixed ? Vec3(x, 1, z) : Vec3(all, all, all);
  for (MovingPoint& p : query.points) p = {scale.cwiseProduct(p.start), scale.cwiseProduct(p.end)};
  return query;
}

}  // namespace

const Family kExtremeScale = {"extreme_scale",
                              "From the smallest subnormal numbers to 1e300, and both at once along "
                              "different axes: products of coordinates underflow to zero, which looks like "
                              "touching, or overflow to infinity and NaN, which compare as nothing.",
                              make_extreme_scale};

}  // namespace cscd::scenes::hard
