#include "bench/measure/studies/small_steps.h"

#include <algorithm>
#include <memory>

#include "bench/harness/contestant.h"
#include "bench/harness/interval_source.h"
#include "bench/measure/studies/scaling.h"
#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/mesh/mean_edge.h"

namespace cscd::bench {
namespace {

// Of a series: as many lead up to the last one as to an interval of a clip.
constexpr std::size_t kSteps = kLead + 1;
constexpr double kShorter = 0.9;  // an iteration than the one before

// Steps of a clip between any two times, in frames. Between frames, the surface moves on straight lines.
class DividedClip {
 public:
  DividedClip(std::shared_ptr<scenes::ClipSource> clip, std::vector<SmallStep> steps)
      : clip_(std::move(clip)), steps_(std::move(steps)) {}

  scenes::ClipInterval operator()(std::size_t number) {
    start_ = at(steps_[number].start);
    end_ = at(steps_[number].end);
    return {Motion(start_.positions, end_.positions), std::nullopt};
  }

 private:
  Moment frame(std::size_t number) {
    const std::span<const Vec3> positions = clip_->load_frame(number).positions;
    return {{positions.begin(), positions.end()}, {}};
  }
  Moment at(double time) {
    const std::size_t before = std::min(static_cast<std::size_t>(time), clip_->frame_count() - 2);
    return between(frame(before), frame(before + 1), time - static_cast<double>(before));
  }

  std::shared_ptr<scenes::ClipSource> clip_;
  std::vector<SmallStep> steps_;
  Moment start_, end_;
};

double longest_displacement(const Motion& motion) {
  double longest = 0;
  for (std::size_t v = 0; v < motion.start().size(); ++v)
    longest = std::max(longest, (motion.end()[v] - motion.start()[v]).norm());
  return longest;
}

}  // namespace

std::vector<SmallStep> series_of_steps(const std::string& name, double start, double length) {
  std::vector<SmallStep> out;
  const std::size_t trials = name == "trials" ? 3 : 0;
  if (trials == 0 && name != "substeps" && name != "iterations")
    throw InputError("series " + name + ": is not known; name substeps, trials or iterations");
  double at = start;
  while (out.size() + trials < kSteps) {
    out.push_back({at, at + length});
    at += length;
    if (name == "iterations") length *= kShorter;
  }
  for (double trial = length; out.size() < kSteps; trial /= 2) out.push_back({at, at + trial});
  return out;
}

ScaleInput small_steps_input(const ScaleSubject& subject) {
  const Stopwatch building;
  Input input = open_input(subject.scene);
  input.rig.reset();  // what lies between frames is on straight lines, which bones do not follow
  const double edge = mean_edge(input.mesh, input.rest());
  std::vector<SmallStep> measured, before;
  std::vector<IntervalRange> leads;
  const std::size_t count = subject.steps.size() * subject.starts.size();
  for (const ScaleStep& step : subject.steps)
    for (std::size_t first = 0; first < subject.starts.size(); first += kMeasuredSteps) {
      const std::size_t start = subject.starts[first];
      const double longest = longest_displacement(input.clip->load(start).motion);
      if (!(longest > 0))
        throw InputError("interval " + std::to_string(start) + " of " + subject.scene +
                         ": nothing moves; name other intervals");
      // Where the clip is too short for a series, steps are shorter.
      const auto room = static_cast<double>(input.clip->frame_count() - 1 - start);
      const double length = std::min(step.moves * edge / longest, room / static_cast<double>(kSteps));
      const std::vector<SmallStep> series = series_of_steps(step.series, static_cast<double>(start), length);
      for (std::size_t i = 0; i < kMeasuredSteps; ++i) {
        const std::size_t number = kSteps - 1 - i * (kSteps / kMeasuredSteps);
        measured.push_back(series[number]);
        leads.push_back({count + before.size(), count + before.size() + number});
      }
      before.insert(before.end(), series.begin(), series.end() - 1);
    }
  measured.insert(measured.end(), before.begin(), before.end());
  const scenes::ClipHeader& header = input.clip->header();
  scenes::ClipHeader own{header.triangles, header.vertex_count, {}, false, header.rest};
  input.clip = std::make_unique<IntervalSource>(
      std::move(own), count, DividedClip(std::shared_ptr(std::move(input.clip)), std::move(measured)));
  input.threads = subject.threads;
  return {std::move(input), std::move(leads), building.milliseconds()};
}

}  // namespace cscd::bench
