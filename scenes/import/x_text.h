#pragma once

#include <cstddef>
#include <string_view>

namespace cscd::scenes {

struct CheckedX {
  std::string_view bytes;          // without a byte order mark
  std::size_t loose_vertices = 0;  // vertices of no face, which assimp leaves out
};

// Checks a DirectX X file. Throws InputError, with the line, for words of a text file that stand for no
// number, such as 1.#IND, because assimp takes some of them for 0, and for faces that name a vertex that does
// not exist. Files in other forms than text are returned as they are, and their loose vertices are not
// counted.
CheckedX checked_x(std::string_view bytes);

}  // namespace cscd::scenes
