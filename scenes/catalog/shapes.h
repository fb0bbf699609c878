#pragma once

#include <span>
#include <string_view>

#include "scenes/shape/shape.h"

namespace cscd::scenes {

// All shapes that a scene file can name.
std::span<const ShapeRow> shapes();

// Checks the parameters and builds the shape. Throws InputError for an unknown name, with a list of the
// known names, and for unusable parameters.
Shape make_shape(std::string_view name, const Parameters& parameters);

// The row of that name. Throws InputError for an unknown name, with a list of the known names.
const ShapeRow& shape_row(std::string_view name, const Parameters& parameters);

}  // namespace cscd::scenes
