#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace cscd::scenes {

// The names of the axes that may point up in a scene or a file. Where none is said the name is empty.
inline constexpr std::array<std::string_view, 6> kUpAxes = {"x", "y", "z", "-x", "-y", "-z"};

inline bool is_up_axis(std::string_view name) {
  return std::ranges::find(kUpAxes, name) != kUpAxes.end();
}

}  // namespace cscd::scenes
