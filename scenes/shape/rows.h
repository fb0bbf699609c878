#pragma once

#include <span>
#include <string_view>

#include "scenes/shape/shape.h"

namespace cscd::scenes {

// Every shape that a scene file can name.
std::span<const ShapeRow> shapes();

// Checks the parameters and builds the shape. Throws InputError for an unknown name, listing the known ones,
// and for unusable parameters.
Shape make_shape(std::string_view name, const Parameters& parameters);

// The row of that name. Throws InputError for an unknown name, listing the known ones.
const ShapeRow& shape_row(std::string_view name, const Parameters& parameters);

}  // namespace cscd::scenes
