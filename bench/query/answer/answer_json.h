#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>

#include "bench/query/answer/answer.h"
#include "bench/query/answer/surface_names.h"
#include "bench/query/input/input.h"

// Answers as JSON. Every field is described in query.schema.json.
namespace cscd::bench {

// A moment of a clip: inside interval `interval`, at the share `time` of it.
struct ClipMoment {
  std::size_t interval = 0;
  double time = 0;
};
// In frames, and in seconds where the input tells its rate. Of a model file frames are those of the file's
// time line (frame_at), and seconds count from the clip's start; of other inputs frames count from frame 0.
double frame_of(const Input& input, const ClipMoment& moment);
std::optional<double> second_of(const Input& input, const ClipMoment& moment);
nlohmann::json moment_json(const Input& input, const ClipMoment& moment);

// One interval; up to `most_start_pairs` of the pairs that cross at its start are listed.
nlohmann::json interval_json(const Input& input, const SurfaceNames& names, const IntervalAnswer& answer,
                             const Motion& motion, std::size_t most_start_pairs);

// Lists the triangles that cross at rest by the parts of the surface that they belong to.
nlohmann::json rest_json(const Input& input, const SurfaceNames& names, const Crossings& rest, bool left_out);

// What was asked to be ignored; null for nothing.
nlohmann::json ignored_json(const Input& input);

}  // namespace cscd::bench
