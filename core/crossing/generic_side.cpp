#include "core/crossing/generic_side.h"

#include <cstdint>

#include "core/elementary/exact/static_contact.h"
#include "core/elementary/exact/touch.h"

namespace cscd {
namespace {

// The mixing function of SplitMix64 (Steele et al. 2014).
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

// The point towards which a vertex is moved. Its coordinates have few bits, so that products stay short.
Vec3 target(VertexId vertex) {
  const std::uint64_t bits = mixed(+vertex);
  const auto coordinate = [&](int shift) { return static_cast<double>((bits >> shift) & 0x1fffff) - 0x1p20; };
  return {coordinate(0), coordinate(21), coordinate(42)};
}

}  // namespace

int GenericSides::side(VertexId a, VertexId b, VertexId c, VertexId p) {
  const int certain = certain_side(positions_[+a], positions_[+b], positions_[+c], positions_[+p]);
  if (certain != 0) return certain;
  const auto moved = [&](VertexId v) { return MovingPoint{positions_[+v], target(v)}; };
  const exact::Polynomial volume =
      exact::coplanarity(exact::linear_points({moved(p), moved(a), moved(b), moved(c)}));
  for (int power = 0; power <= volume.degree(); ++power)
    if (const int sign = volume[power].sign(); sign != 0) {
      degenerate_ += power > 0;
      return sign;
    }
  // Even the targets of the four vertices lie in one plane, which no mesh that was tried has shown.
  ++degenerate_;
  return 1;
}

bool GenericSides::passes_inside(const Edge& edge, const Triangle& face) {
  const auto [a, b, c] = face;
  const int turn = side(edge[0], edge[1], a, b);
  return side(edge[0], edge[1], b, c) == turn && side(edge[0], edge[1], c, a) == turn;
}

}  // namespace cscd
