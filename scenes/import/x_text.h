#pragma once

#include <string_view>

namespace cscd::scenes {

// Returns the bytes of a DirectX X file without a byte order mark. Throws InputError, with the line, for
// words of a text file that stand for no number, such as 1.#IND: assimp takes some of them for 0. Files in
// other forms than text are returned as they are.
std::string_view checked_x(std::string_view bytes);

}  // namespace cscd::scenes
