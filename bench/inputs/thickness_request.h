#pragma once

#include <memory>
#include <string>

#include "core/detect/exclusions.h"
#include "core/detect/thickness.h"

namespace cscd::bench {

// A length as users write it: "0.01" in the units of the positions, or "0.2e" in mean edges of the pose at
// rest.
struct WrittenLength {
  std::string text = {};  // empty where nothing was written
  double number = 0;      // finite, at least 0
  bool in_edges = false;

  double length(double mean_edge) const { return in_edges ? number * mean_edge : number; }
};

// Reads a length. Throws InputError, naming the option, for a text that is none, and for a number that is
// negative or not finite.
WrittenLength parse_length(const std::string& option, const std::string& text);

// How near features may come before they count, and which pairs are left out because they are near by
// construction: as a user asks for it.
struct ThicknessRequest {
  WrittenLength thickness = {};
  int rings = 0;                 // vertices that so many edges join do not collide
  WrittenLength near_rest = {};  // nor do vertices that are nearer than this at rest

  bool leaves_out() const { return rings > 0 || near_rest.number > 0; }
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
