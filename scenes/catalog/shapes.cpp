#include "scenes/catalog/shapes.h"

#include <string>

#include "core/base/error.h"
#include "scenes/cloth/ball.h"
#include "scenes/cloth/sheet.h"
#include "scenes/cloth/skirt.h"
#include "scenes/shape/box.h"
#include "scenes/shape/limbed_sphere.h"
#include "scenes/shape/tube.h"

namespace cscd::scenes {

std::span<const ShapeRow> shapes() {
  static const ShapeRow rows[] = {tube_row(),  box_row(), limbed_sphere_row(), skirted_limbed_sphere_row(),
                                  sheet_row(), ball_row()};
  return rows;
}

Shape make_shape(std::string_view name, const Parameters& parameters) {
  const ShapeRow& row = shape_row(name, parameters);
  return row.make(checked(parameters, row.parameters));
}

const ShapeRow& shape_row(std::string_view name, const Parameters& parameters) {
  std::string known;
  for (const ShapeRow& row : shapes()) {
    if (row.name == name) return row;
    known += (known.empty() ? "" : ", ") + std::string(row.name);
  }
  throw InputError(parameters.where() + ": unknown shape " + std::string(name) + "; known are: " + known);
}

}  // namespace cscd::scenes
