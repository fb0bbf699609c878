#pragma once

#include <string>
#include <vector>

#include "bench/answer/clip_answer.h"

// Answers as text.
namespace cscd::bench {

// "horse.glb, clip 'Walk' (14th of 14 clips), component 2 of 5 alone": what exactly a verdict is about.
std::string subject_text(const Input& input);

// Says what was asked about and, in this order, what lies deepest in the surface, what only touches, how
// often it touches or crosses itself, and when first: one to three sentences. Texts, pages and JSON all show
// these.
std::vector<std::string> verdict_sentences(const ClipAnswer& answer);
// The same as one text.
std::string verdict_text(const ClipAnswer& answer);

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

// Says of so many triangles (identical_triangles) what is not said of them.
std::string identical_text(std::size_t triangles);

// What clip_text() says below the verdict as one paragraph, for a page that lists by itself what met.
std::string details_text(const ClipAnswer& answer);

}  // namespace cscd::bench
