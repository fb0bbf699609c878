#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/inputs/input.h"

namespace cscd::bench {

// What a user asks to be ignored.
struct IgnoreRequest {
  // Each is "A:B". A and B name bones, parts or meshes, and * in them stands for any letters. Names may hold
  // colons, as long as one way alone to cut the text gives two names that the input has.
  std::vector<std::string> pairs;
  std::optional<int> neighbours;  // bones that are at most so many joints apart
};

// Has the answers about an input ignore what is asked (Input::ignored). A triangle belongs to the bone that
// moves most of its corners, to its part and to its mesh. Two triangles ignore each other if a request names
// a place of the one and a place of the other. A contact is ignored if every pair of triangles that has both
// its features is. Throws InputError for a name that the input does not have, and for neighbours where there
// are no bones.
void ignore(Input& input, const IgnoreRequest& request);

}  // namespace cscd::bench
