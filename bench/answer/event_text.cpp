#include "bench/answer/event_text.h"

#include <cmath>

#include "bench/answer/verdicts.h"
#include "bench/inputs/input_options.h"
#include "bench/inputs/thickness.h"
#include "core/base/number_text.h"

namespace cscd::bench {
namespace {

std::string frame_of_start(const Input& input, std::size_t interval) {
  return frame_text(input, {interval, 0});
}

std::string frames_of(const Input& input, const OverlapEvent& event) {
  return "frames " + frame_of_start(input, event.first) + " to " + frame_of_start(input, event.last);
}

std::string other_of(const NamePair& both) {
  return both.first == both.second ? "itself" : both.second;
}

std::string at_rest_text(const Input& input, const OverlapEvent& event) {
  return event.at_rest ? ", deeper than at rest (" + distance_text(input, *event.at_rest) + ")" : "";
}

}  // namespace

// Frames of a long clip keep their hundredths.
std::string frame_text(const Input& input, const ClipMoment& moment) {
  return exact_text(std::round(100 * frame_of(input, moment)) / 100);
}

std::string moment_text(const Input& input, const ClipMoment& moment) {
  const std::optional<double> seconds = second_of(input, moment);
  std::string text = "frame " + frame_text(input, moment);
  // Seconds count from the start of the clip, and frames from the start of the file's time line.
  const bool late = input.import && frame_at(*input.import, 0) != 0;
  if (seconds) text += " (" + short_text(*seconds) + (late ? " s into the clip)" : " s)");
  return text;
}

std::string event_text(const Input& input, const OverlapEvent& event) {
  std::string out = event.names.first + (event.crosses ? " in " : " touches ") + other_of(event.names);
  const std::string most = "at most " + distance_text(input, event.depth.upper);
  if (is_known(event.depth))
    out += ": " + distance_text(input, event.depth.lower) + " deep (" + most + ")";
  else if (event.crosses)
    out += ": " + most + " deep, depth not known";
  out += at_rest_text(input, event);
  if (event.vertices > 0) out += ", " + many(event.vertices, "vertex");
  if (event.first == event.last) return out + ", frame " + frame_of_start(input, event.first);
  return out + ", " + frames_of(input, event) + ", deepest at " + frame_of_start(input, event.deepest);
}

std::optional<std::size_t> worst_event(const ClipAnswer& answer) {
  if (!collides(answer.verdict()) || answer.summary.with_old > 0) return std::nullopt;
  std::optional<std::size_t> worst;
  const auto excess = [&](std::size_t i) {
    const OverlapEvent& event = answer.events[i];
    return event.depth.lower - event.at_rest.value_or(0);
  };
  for (std::size_t i = 0; i < answer.events.size(); ++i)
    if (is_known(answer.events[i].depth) && !answer.joints.fold(answer.events[i]) &&
        (!worst || excess(i) > excess(*worst)))
      worst = i;
  return worst;
}

std::string worst_text(const Input& input, const OverlapEvent& event) {
  const std::string out = event.names.first + " is " + distance_text(input, event.depth.lower) + " deep in " +
                          other_of(event.names) + at_rest_text(input, event);
  if (input.is_one_pose) return out;
  const std::string frame = " at frame " + frame_of_start(input, event.deepest);
  return out + (event.first == event.last ? "," + frame + " alone"
                                          : ", deepest" + frame + " (" + frames_of(input, event) + ")");
}

}  // namespace cscd::bench
