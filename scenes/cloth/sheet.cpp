#include "scenes/cloth/sheet.h"

#include <cmath>

#include "core/base/error.h"

namespace cscd::scenes {

Shape sheet(const SheetParameters& p) {
  if (p.cells < 1 || p.strips < 2 || p.strips % 2 != 0 || !(p.edge > 0))
    throw InputError("sheet: needs a cell, an even number of strips and a positive edge");
  if (static_cast<double>(p.cells) * p.strips > 1 << 26)
    throw InputError("sheet: more than 2^26 cells; lower the cells or the strips");
  const double length = p.u.norm(), area = p.u.cross(p.v).norm();
  if (length == 0 || !(area > 0)) throw InputError("sheet: u and v must span a plane");
  const Vec3 along = p.u / length;
  const Vec3 side = p.v - p.v.dot(along) * along;
  const Vec3 across = side / side.norm();
  const double height = std::sqrt(0.75) * p.edge;

  Shape shape;
  std::vector<int> first;  // [strips + 1]: first vertex of each row
  for (int row = 0; row <= p.strips; ++row) {
    first.push_back(static_cast<int>(shape.positions.size()));
    // Rows with an odd number begin and end with half an edge, so they have one vertex more.
    const int last = p.cells + row % 2;
    for (int i = 0; i <= last; ++i) {
      double at = i;
      if (row % 2 == 1) at = i == 0 ? 0 : i == last ? p.cells : i - 0.5;
      shape.positions.push_back(p.centre + (at - 0.5 * p.cells) * p.edge * along +
                                (row - 0.5 * p.strips) * height * across);
    }
  }
  for (int strip = 0; strip < p.strips; ++strip) {
    // The row with more vertices lies below the other in every second strip.
    const bool more_below = strip % 2 == 1;
    const int more = first[static_cast<std::size_t>(strip + (more_below ? 0 : 1))];
    const int fewer = first[static_cast<std::size_t>(strip + (more_below ? 1 : 0))];
    const auto add = [&](int a, int b, int c) {
      if (more_below) std::swap(b, c);
      shape.triangles.push_back({VertexId{a}, VertexId{b}, VertexId{c}});
    };
    for (int i = 0; i <= p.cells; ++i) {
      add(fewer + i, more + i + 1, more + i);
      if (i < p.cells) add(fewer + i, fewer + i + 1, more + i + 1);
    }
  }
  shape.weights.resize(shape.positions.size());
  return shape;
}

ShapeRow sheet_row() {
  static const ParameterRow rows[] = {
      integer_row("cells", "", "edges of a row", {1, 1e5}),
      integer_row("strips", "", "strips of triangles, an even number", {2, 1e5}),
      number_row("edge", "length", "length of an edge", {1e-9, 1e9}),
      vector_row("centre", "length", "middle of the sheet"),
      vector_row("u", "", "direction of the rows"),
      vector_row("v", "", "side to which the rows follow each other"),
  };
  return {
      "sheet", "flat sheet of equilateral triangles, open and without bones", rows,
      [](const Parameters& parameters) {
        return sheet({parameters.integer("cells"), parameters.integer("strips"), parameters.number("edge"),
                      parameters.vector("centre"), parameters.vector("u"), parameters.vector("v")});
      },
      [](const Parameters& parameters, double factor) {
        const double strips = 2 * scaled_count(parameters.integer("strips") / 2, factor, 1);
        return parameters.with("cells", scaled_count(parameters.integer("cells"), factor, 1))
            .with("strips", strips)
            .with("edge", parameters.number("edge") / factor);
      }};
}

}  // namespace cscd::scenes
