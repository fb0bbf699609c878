#pragma once

#include <memory>
#include <optional>

#include "bench/command_line/written_length.h"
#include "core/detect/exclusions.h"
#include "core/detect/thickness.h"

namespace cscd::bench {

// How near features may come before they count, and which pairs are left out because they are near by
// construction: as a user asks for it.
struct ThicknessRequest {
  WrittenLength thickness = {};
  std::optional<int> rings = {};  // vertices that at most so many edges join do not collide
  WrittenLength near_rest = {};   // nor do vertices that are nearer than this at rest

  bool leaves_out() const { return rings.value_or(0) > 0 || near_rest.number > 0; }
};

// The same for one input.
struct InputThickness {
  ThicknessRequest asked = {};
  double edge = 0;                                       // mean length of an edge at rest
  double length = 0;                                     // of the thickness; 0 where touching alone counts
  std::shared_ptr<const Exclusions> left_out = nullptr;  // null where nothing is

  Thickness thickness() const { return Thickness(length); }
};

}  // namespace cscd::bench
