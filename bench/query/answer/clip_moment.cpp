#include "bench/query/answer/clip_moment.h"

namespace cscd::bench {

std::optional<double> second_of(const Input& input, const ClipMoment& moment) {
  if (!input.import) return std::nullopt;
  const std::size_t frames = input.clip->frame_count();
  const double from = second_of_frame(*input.import, moment.interval, frames);
  const double to = second_of_frame(*input.import, moment.interval + 1, frames);
  return (1 - moment.time) * from + moment.time * to;
}

double frame_of(const Input& input, const ClipMoment& moment) {
  const std::optional<double> seconds = second_of(input, moment);
  return seconds ? frame_at(*input.import, *seconds) : static_cast<double>(moment.interval) + moment.time;
}

}  // namespace cscd::bench
