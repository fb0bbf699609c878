#pragma once

#include <string>
#include <vector>

#include "bench/answer/clip_answer.h"

// Answers as text.
namespace cscd::bench {

// One sentence that says what was asked about, does it touch or cross itself, how often, and when first.
// Texts, pages and JSON all show this sentence.
std::string verdict_sentence(const ClipAnswer& answer);

// Several lines, the verdict first.
std::string clip_text(const ClipAnswer& answer);
// A few lines for each of several clips: the verdict, what it leaves out, and what lies deepest in the
// surface.
std::string brief_clip_text(const ClipAnswer& answer);

// Of what a verdict does not speak: "what crosses at rest", "what is ignored".
std::vector<std::string> verdict_exceptions(const ClipAnswer& answer);

// What --fail-deeper-than finds. It fails where something certainly lies deeper than the length, where
// a depth of which only a bound is known may be larger, and where a start was not measured; the text says
// why, or what is not known.
struct DepthCheck {
  bool fails;
  std::string text;
};
DepthCheck check_depth(const ClipAnswer& answer, const WrittenLength& most);

// "hand_l in thigh_l: 1.2 cm deep (at most 1.9 cm), 38 vertices, frames 12 to 31, deepest at 20".
std::string event_text(const Input& input, const OverlapEvent& event);

// Says of so many triangles (identical_triangles) what is not said of them.
std::string identical_text(std::size_t triangles);

// What clip_text() says below the verdict as one paragraph, for a page that lists by itself what met.
std::string details_text(const ClipAnswer& answer);

}  // namespace cscd::bench
