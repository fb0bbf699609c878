#pragma once

#include <string_view>

namespace cscd {

// What is known of an interval: of straight lines, or of the true paths of a span of time (core/soundness.md,
// "The true motion"). Pages of the viewer know verdicts by their numbers (page/src/words.js).
enum class IntervalVerdict {
  clear,  // nothing crosses at the start, and nothing touches
  // Nothing crosses at the start, and something touches, at the start or later. Of true paths it is proven by
  // an edge that pierces a face at one moment and is apart from it at another, or by triangles that touch at
  // the start or after a jump.
  touches,
  intersects_at_start,  // triangles cross at the start, or of true paths, after a jump within the span
  // Nothing crosses, and it cannot be told whether something touches: by an inexact elementary test, or by
  // the bounds on true paths.
  undecided,
  // Nothing crosses or touches, and something comes within the thickness. Of true paths: two features come
  // within a distance, and what they do there cannot be told apart.
  close
};
std::string_view to_string(IntervalVerdict verdict);

}  // namespace cscd
