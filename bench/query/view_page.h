#pragma once

#include <string>
#include <vector>

#include "bench/answer/options/answer_options.h"

namespace cscd::bench {

// What a page of the viewer shows: an input, and how strategies answer its intervals.
struct ViewRequest : AnswerRequest {
  std::vector<std::string> strategies;  // none for the best that the input allows
  std::string up;                       // one of scenes::kUpAxes; empty for what the input says
};

// Answers all intervals and returns the page. Says on standard output what was read and answered. Throws
// InputError for a request that cannot be met.
std::string view_page(ViewRequest request);

}  // namespace cscd::bench
