#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/detect/exclusions.h"

namespace cscd::bench {

// What the user ignores in the answers about an input.
struct Ignored {
  std::vector<std::pair<std::string, std::string>>
      names;                      // of places that ignore each other, with * for any letters
  std::optional<int> neighbours;  // bones that are at most so many joints apart ignore each other
  Exclusions triangles;           // the pairs of triangles that these two come to
};

}  // namespace cscd::bench
