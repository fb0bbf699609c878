#pragma once

#include <memory>
#include <span>
#include <string>

#include "core/detect/exclusions.h"
#include "core/detect/strategy.h"
#include "core/detect/thickness.h"

namespace cscd::bench {

struct Input;

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

// Returns the mean length of a surface's edges in a pose; 0 without edges.
double mean_edge(const TriangleMesh& mesh, std::span<const Vec3> pose);

// Sets Input::thickness. Whoever leaves out what the input ignores before it is tested says so by
// `with_ignored`. Throws InputError where a length overflows.
void set_thickness(Input& input, const ThicknessRequest& request, bool with_ignored = false);

// Throws InputError, naming those that can, where a strategy or an elementary test cannot answer the request:
// because it knows no distance, or cannot leave pairs out.
void require_fit(const ThicknessRequest& request, const Strategy& strategy);
void require_fit(const ThicknessRequest& request, const ElementaryTest& elementary);
// Says what a strategy lacks for the request; empty where it lacks nothing.
std::string why_not_within(const ThicknessRequest& request, const Strategy& strategy);

// The feature pairs that are close in the pose at rest, whether left out or not, sorted; by the complete
// reference and an exact test.
ContactSet close_at_rest(const Input& input);

}  // namespace cscd::bench
