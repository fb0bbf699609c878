#pragma once

#include <string_view>

namespace cscd {

// How the work around a culling method is programmed. `vectorised` is vector code and this project's filters.
// `published` is what the paper of 2014 measured with, so that its times can be compared: bounds refitted and
// triangles classified one at a time by scalar code, feature pairs filtered one by one, and by the published
// filter alone. Both find the same triangle pairs with the same counters. The published filter has no bound
// of the rounding (rule certain-sign, core/soundness.md), so that in the pipeline `published` the promise of
// a strategy is held by verification, not by proof.
enum class Pipeline { vectorised, published };

// Returns the name by which options and records know the pipeline: `vectorised` is `today` there.
constexpr std::string_view to_string(Pipeline pipeline) {
  return pipeline == Pipeline::published ? "published" : "today";
}
// Throws InputError that lists the names.
Pipeline pipeline_named(std::string_view name);

}  // namespace cscd
