#include "scenes/shape/box_grid.h"

#include <algorithm>

namespace cscd::scenes {

std::size_t BoxGrid::vertex_count() const {
  const auto a = static_cast<std::size_t>(cells_[0]), b = static_cast<std::size_t>(cells_[1]),
             c = static_cast<std::size_t>(cells_[2]);
  return 2 * (a * b + b * c + c * a) + 2;
}

VertexId BoxGrid::at(const Node& node) const {
  const auto [x, y, z] = node;
  const auto [a, b, c] = cells_;
  const int layer = (a + 1) * (b + 1), rim = 2 * (a + b);  // nodes of an end layer, of a layer between
  if (z == 0 || z == c) return VertexId{(z == 0 ? 0 : layer + (c - 1) * rim) + y * (a + 1) + x};
  const int first = layer + (z - 1) * rim;
  if (y == 0) return VertexId{first + x};
  if (y == b) return VertexId{first + rim - (a + 1) + x};
  return VertexId{first + (a + 1) + 2 * (y - 1) + (x == a ? 1 : 0)};
}

BoxGrid::Node BoxGrid::node(const Face& face, int u, int v) const {
  Node node{};
  const auto set = [&](int axis, int value) { node[static_cast<std::size_t>(axis)] = value; };
  set(face.axis, face.upper ? cells_[static_cast<std::size_t>(face.axis)] : 0);
  set(face.u(), u);
  set(face.v(), v);
  return node;
}

std::array<VertexId, 4> BoxGrid::cell(const Face& face, int u, int v) const {
  std::array<VertexId, 4> corner = {at(node(face, u, v)), at(node(face, u + 1, v)),
                                    at(node(face, u + 1, v + 1)), at(node(face, u, v + 1))};
  // The cross product of the axes u and v points along x or z, but against y.
  if (face.upper == (face.axis == 1)) std::swap(corner[1], corner[3]);
  return corner;
}

}  // namespace cscd::scenes
