#include "scenes/hard/rows.h"

namespace cscd::scenes::hard {
namespace {

Query make_needles(Kind kind, Random& random) {
  const double length = 0x1p26, x = random.integer(1, (1 << 26) - 1);
  const auto height = [&] {
    const int middle = random.integer(0, 1), half = random.integer(1, 3);
    return through(Vec3(0, 0, middle), Vec3(0, 0, half));
  };
  const auto at = [&](double px, double py) {
    const MovingPoint z = height();
    return moved(z, {px, py, 0}, {px, py, 0});
  };
  if (kind == Kind::vertex_face) {
    const bool sliver = flip(random);  // the third corner is between the others, else beside the first
    const double y = random.integer(-1, 2);
    return {{at(sliver ? length / 2 : x, y), at_rest({0, 0, 0}), at_rest({length, 0, 0}),
             at_rest({sliver ? length / 2 : 0, 1, 0})},
            {}};
  }
  const double y = random.integer(-2, 1);
  const MovingPoint z = height();
  return {{at_rest({0, 0, 0}), at_rest({length, 0, 0}), moved(z, {x - length, y, 0}, {x - length, y, 0}),
           moved(z, {x, y + 1, 0}, {x, y + 1, 0})},
          {}};
}

}  // namespace

const Family kNeedles = {
    "needles",
    "Triangles and pairs of edges with an aspect of a hundred million: the normal is small beside the edges "
    "that it is made of, and barycentric coordinates divide by its square.",
    make_needles};

}  // namespace cscd::scenes::hard
