#pragma once

#include <string>

#include "scenes/catalog/scene.h"

namespace cscd::scenes {

// The text of a scene file with another `expected`, which names all four values. Everything else stays as it
// is written, white space included. Throws InputError if `text` is no JSON object.
std::string with_expected(const std::string& text, const Expected& expected, const std::string& where);

}  // namespace cscd::scenes
