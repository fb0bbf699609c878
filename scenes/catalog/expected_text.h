#pragma once

#include <string>

#include "scenes/catalog/scene.h"

namespace cscd::scenes {

// Returns the text of a scene file with `expected` replaced or added; all four values of `expected` must be
// set. The rest of the text stays as it is written, white space included. `where` begins error texts.
// Throws InputError if `text` is no JSON object.
std::string with_expected(const std::string& text, const Expected& expected, const std::string& where);

}  // namespace cscd::scenes
