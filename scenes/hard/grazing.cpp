#include "scenes/hard/rows.h"

namespace cscd::scenes::hard {
namespace {

Query make_grazing(Kind kind, Random& random) {
  // The height of one feature over the other is z0 - 2 r s (x0 + 2 p s) / 8, with s = t - 1/2.
  const double ulp = 0x1p-52;
  const double p = random.integer(1, 6), r = pick(random, {-3, -1, 1, 2, 5});
  const double z0 = pick(random, {0.0, 0.0, ulp, -ulp, 0x1p-30, -0x1p-30}),
               x0 = pick(random, {0.0, 0.0, ulp, -ulp, 0x1p-26});
  const double y = random.integer(-1, 8), at = random.integer(0, 3);
  const MovingPoint tilting{{8 - at, 0, -r}, {8 - at, 0, r}};
  if (kind == Kind::vertex_face) {
    const double back = r * at / (8 - at);  // the plane turns about the line x = 0
    const bool border = flip(random) || at == 0;
    const MovingPoint a = border ? at_rest({0, 0, 0}) : MovingPoint{{-at, 0, back}, {-at, 0, -back}};
    const MovingPoint c = border ? at_rest({0, 8, 0}) : MovingPoint{{-at, 8, back}, {-at, 8, -back}};
    return {
        {MovingPoint{{x0 - p, y, z0}, {x0 + p, y, z0}}, a, MovingPoint{{8 - at, 0, -r}, {8 - at, 0, r}}, c},
        {}};
  }
  const double half = random.integer(0, 4);
  return {{at_rest({0, 0, 0}), tilting, MovingPoint{{x0 - p, -half, z0}, {x0 + p, -half, z0}},
           MovingPoint{{x0 - p, 4, z0}, {x0 + p, 4, z0}}},
          {}};
}

}  // namespace

const Family kGrazing = {"grazing",
                         "The features come to one plane, touch, and part on the side they came from: a "
                         "double root, or two roots as little as one ulp apart, or none by as little. Roots "
                         "of the rounded cubic are wrong by the square root of the rounding.",
                         make_grazing};

}  // namespace cscd::scenes::hard
