#include "scenes/shape/box.h"

#include <algorithm>

#include "core/base/error.h"
#include "scenes/shape/bone_chain.h"

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

Shape box(const BoxParameters& p) {
  const auto [a, b, c] = p.cells;
  if (a < 1 || b < 1 || c < 1 || p.bones < 1 || !(p.size.minCoeff() > 0))
    throw InputError("box: needs at least one cell along each axis, a positive size and a bone");
  if (2.0 * (static_cast<double>(a) * b + static_cast<double>(b) * c + static_cast<double>(c) * a) > 1 << 27)
    throw InputError("box: more than 2^27 vertices; lower the cells");

  const BoxGrid grid(p.cells);
  Shape shape;
  shape.positions.reserve(grid.vertex_count());
  grid.for_each_node([&](const BoxGrid::Node& node, VertexId) {
    const auto share = [&](std::size_t axis) { return static_cast<double>(node[axis]) / p.cells[axis]; };
    shape.positions.push_back(
        {p.size.x() * (share(0) - 0.5), p.size.y() * (share(1) - 0.5), p.size.z() * share(2)});
    shape.weights.push_back(spline_weights(p.bones * share(2), p.bones));
  });
  for (const BoxGrid::Face& face : BoxGrid::faces())
    for (int v = 0; v < p.cells[static_cast<std::size_t>(face.v())]; ++v)
      for (int u = 0; u < p.cells[static_cast<std::size_t>(face.u())]; ++u)
        append_quad(grid.cell(face, u, v), shape.triangles);

  std::vector<Vec3> joints;
  for (int i = 0; i <= p.bones; ++i) joints.push_back(Vec3(0, 0, p.size.z() * i / p.bones));
  append_chain(joints, shape);
  return shape;
}

ShapeRow box_row() {
  static const ParameterRow rows[] = {
      integer_row("cells_x", "", "cells along x", {1, 1e5}),
      integer_row("cells_y", "", "cells along y", {1, 1e5}),
      integer_row("cells_z", "", "cells along z, the axis of the bones", {1, 1e5}),
      vector_row("size", "length", "lengths along x, y, z"),
      integer_row("bones", "", "bones of the chain on the axis", {1, 1e5}),
  };
  return {"box", "sharp-edged box on a chain of bones along z, gridded on all faces", rows,
          [](const Parameters& parameters) {
            BoxParameters p;
            p.cells = {parameters.integer("cells_x"), parameters.integer("cells_y"),
                       parameters.integer("cells_z")};
            p.size = parameters.vector("size");
            p.bones = parameters.integer("bones");
            return box(p);
          },
          [](const Parameters& parameters, double factor) {
            Parameters scaled = parameters;
            for (const char* cells : {"cells_x", "cells_y", "cells_z"})
              scaled = scaled.with(cells, scaled_count(parameters.integer(cells), factor, 1));
            return scaled;
          }};
}

}  // namespace cscd::scenes
