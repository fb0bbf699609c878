// Orientation classes against exact arithmetic: a triangle with a sign has it at every moment that is looked
// at.
#include "core/radial/orientation.h"

#include <gmpxx.h>

#include "fuzz/numbers.h"

namespace cscd::fuzz {
namespace {

constexpr int kMoments = 8;  // the interval is cut into so many parts

struct Exact {
  mpq_class at[3];
};
Exact exact_at(const MovingPoint& point, int moment) {
  const mpq_class t(moment, kMoments);
  Exact out;
  for (int k = 0; k < 3; ++k) out.at[k] = (1 - t) * mpq_class(point.start[k]) + t * mpq_class(point.end[k]);
  return out;
}
Exact operator-(const Exact& a, const Exact& b) {
  return {{a.at[0] - b.at[0], a.at[1] - b.at[1], a.at[2] - b.at[2]}};
}
int sign_of_product(const Exact& a, const Exact& b, const Exact& c) {
  const mpq_class product = a.at[0] * (b.at[1] * c.at[2] - b.at[2] * c.at[1]) +
                            a.at[1] * (b.at[2] * c.at[0] - b.at[0] * c.at[2]) +
                            a.at[2] * (b.at[0] * c.at[1] - b.at[1] * c.at[0]);
  return sgn(product);
}

}  // namespace

void target(Bytes bytes) {
  Numbers numbers(bytes);
  MovingPoint corner[3], observer;
  for (MovingPoint& point : corner) point = {numbers.point(), numbers.point()};
  observer = {numbers.point(), numbers.point()};
  const auto seen = radial::orientation(corner, radial::Observer::point(observer));
  if (seen == radial::Orientation::uncertain) return;
  const int wanted = seen == radial::Orientation::positive ? 1 : -1;
  for (int moment = 0; moment <= kMoments; ++moment) {
    const Exact from = exact_at(observer, moment);
    Exact to[3];
    for (int k = 0; k < 3; ++k) to[k] = exact_at(corner[k], moment);
    if (sign_of_product(to[0] - from, to[1] - to[0], to[2] - to[0]) != wanted)
      broken("a triangle is classified " + std::string(wanted > 0 ? "positive" : "negative") + " and is not");
  }
}

}  // namespace cscd::fuzz
