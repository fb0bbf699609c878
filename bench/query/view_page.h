#pragma once

#include <string>

#include "bench/answer/answer_request.h"

namespace cscd::bench {

// What a page of the viewer shows: an input, and how strategies answer its intervals.
struct ViewRequest : AnswerRequest {
  std::string up;            // one of scenes::kUpAxes; empty for what the input says
  bool with_engine = false;  // the page can answer again by itself
};

// Answers all intervals and returns the page. Says on standard output what was read and answered. Throws
// InputError for a request that cannot be met.
std::string view_page(ViewRequest request);

}  // namespace cscd::bench
