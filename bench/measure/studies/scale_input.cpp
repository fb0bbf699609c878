#include "bench/measure/studies/scale_input.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <memory>
#include <numeric>

#include "bench/harness/contestant.h"
#include "bench/harness/interval_choice.h"
#include "bench/harness/interval_source.h"
#include "bench/measure/studies/scaling.h"
#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "scenes/catalog/resized.h"

namespace cscd::bench {
namespace {

// Frames between which a step from one frame lies.
std::size_t last_frame(std::size_t start, double step) {
  return start + static_cast<std::size_t>(std::ceil(step));
}

// Intervals that lead up to one of the study of thickness, whose queries may take seconds each.
constexpr std::size_t kThickLead = 4;

// Intervals of a motion by the time, in frames, at which each starts, and those that lead up to them.
struct Timetable {
  std::vector<double> starts;        // of the subject's intervals, then of those that lead up to them
  std::vector<ScaleStep> steps;      // the same
  std::vector<IntervalRange> leads;  // of the subject's intervals

  explicit Timetable(const ScaleSubject& subject) {
    const auto add = [&](double start, const ScaleStep& step) {
      starts.push_back(start);
      steps.push_back(step);
    };
    for (const ScaleStep& step : subject.steps)
      for (const std::size_t start : subject.starts) add(static_cast<double>(start), step);
    const bool is_thick = std::ranges::any_of(subject.steps, [](const ScaleStep& s) { return s.edges > 0; });
    for (std::size_t i = 0, count = starts.size(); i < count; ++i) {
      const ScaleStep step = steps[i];
      const auto room = static_cast<std::size_t>(starts[i] / step.frames);
      const std::size_t lead = std::min(is_thick ? kThickLead : kLead, room);
      leads.push_back({starts.size(), starts.size() + lead});
      for (std::size_t k = lead; k > 0; --k) add(starts[i] - static_cast<double>(k) * step.frames, step);
    }
  }
};

// Poses a surface anew, and keeps no more poses than an interval needs.
class PosedMotion {
 public:
  PosedMotion(const scenes::Scene& scene, const scenes::Shape& shape, const ScaleSubject& subject,
              Timetable times)
      : scene_(scene), shape_(shape), bones_(subject.bones), times_(std::move(times)) {
    double last = 0;
    for (std::size_t i = 0; i < times_.starts.size(); ++i)
      last = std::max(last, times_.starts[i] + times_.steps[i].frames);
    std::vector<std::size_t> frames(last_frame(0, last) + 1);
    std::iota(frames.begin(), frames.end(), std::size_t{0});
    poses_ = scenes::poses_at(scene_, frames);
  }

  scenes::ClipInterval operator()(std::size_t interval) {
    const double start = times_.starts[interval];
    moment(start, start_);
    moment(start + times_.steps[interval].frames, end_);
    scenes::ClipInterval out{Motion(start_.positions, end_.positions), std::nullopt};
    if (!start_.bones.empty()) out.bones = Rig::Interval{start_.bones, end_.bones};
    return out;
  }

 private:
  const Moment& frame(std::size_t number) {
    const auto known = std::ranges::find(frames_, number, &std::pair<std::size_t, Moment>::first);
    if (known != frames_.end()) return known->second;
    if (frames_.size() == kKept) frames_.pop_front();
    const scenes::BonePose& pose = poses_[number];
    return frames_
        .emplace_back(number, Moment{scenes::carried(scene_, shape_, pose),
                                     bones_ > 0 ? resampled_chain(pose.bones, bones_) : pose.bones})
        .second;
  }
  void moment(double time, Moment& out) {
    const auto first = static_cast<std::size_t>(time);
    const double share = time - static_cast<double>(first);
    if (share == 0) {
      out = frame(first);
    } else {
      const Moment from = frame(first);  // a copy, which stays when the next frame takes its place
      out = between(from, frame(first + 1), share);
    }
  }

  static constexpr std::size_t kKept = 4;  // frames; both ends of an interval may lie between two
  scenes::Scene scene_;
  scenes::Shape shape_;
  std::size_t bones_;
  Timetable times_;
  std::vector<scenes::BonePose> poses_;                // [frames]
  std::deque<std::pair<std::size_t, Moment>> frames_;  // the last ones that were asked for
  Moment start_, end_;
};

// Intervals as the clips of the steps' scenes hold them.
class RecordedMotion {
 public:
  explicit RecordedMotion(Timetable times) : times_(std::move(times)) {
    for (const ScaleStep& step : times_.steps)
      if (!clips_.contains(step.scene)) clips_.emplace(step.scene, open_input(step.scene).clip);
  }
  scenes::ClipInterval operator()(std::size_t interval) {
    return clips_.at(times_.steps[interval].scene)->load(static_cast<std::size_t>(times_.starts[interval]));
  }

 private:
  Timetable times_;
  std::map<std::string, std::shared_ptr<scenes::ClipSource>> clips_;
};

}  // namespace

ScaleInput scale_input(const ScaleSubject& subject) {
  const Stopwatch building;
  const Timetable times(subject);
  const auto source = [&](scenes::ClipHeader header, IntervalSource::Load load) {
    return std::make_unique<IntervalSource>(std::move(header), times.leads.size(), std::move(load));
  };
  if (is_point_cache(subject.scene)) {
    Input input = open_input(subject.scene);
    const scenes::ClipHeader& header = input.clip->header();
    input.clip = source({header.triangles, header.vertex_count, header.bone_parent, false, header.rest},
                        RecordedMotion(times));
    input.threads = subject.threads;
    return {std::move(input), times.leads, building.milliseconds()};
  }
  const scenes::Scene scene = scenes::load_scene(subject.scene);
  scenes::Shape shape =
      scenes::resized_shape(scene, subject.triangles > 0 ? subject.triangles : scenes::triangle_count(scene));
  if (subject.bones > 0 && !is_chain(shape.rig))
    throw InputError("scene " + scene.name + ": its bones form no chain; vary the bones of another scene");
  Rig rig = shape.rig;
  if (subject.bones > 0) {
    rig.reference = resampled_chain(rig.reference, subject.bones);
    rig.parent.clear();
    for (std::size_t i = 0; i < subject.bones; ++i) rig.parent.push_back(BoneId{static_cast<int>(i) - 1});
  }
  IntervalSource::Load load = subject.recorded
                                  ? IntervalSource::Load(RecordedMotion(times))
                                  : IntervalSource::Load(PosedMotion(scene, shape, subject, times));
  TriangleMesh mesh(shape.triangles, shape.positions.size(), scene.name);
  auto clip =
      source({std::move(shape.triangles), shape.positions.size(), rig.parent, false}, std::move(load));
  std::optional<Rig> bones;  // cloth has none
  if (!rig.parent.empty()) bones = std::move(rig);
  Input input{scene.name, std::move(clip), std::move(mesh), std::move(shape.positions), std::move(bones)};
  input.threads = subject.threads;
  return {std::move(input), times.leads, building.milliseconds()};
}

std::vector<std::size_t> spread_starts(std::size_t frames, std::size_t count, double longest_step) {
  const std::size_t reach = last_frame(0, longest_step);
  if (frames < reach + 1 + count)
    throw InputError("a step of " + std::to_string(reach) + " frames from " + std::to_string(count) +
                     " places does not fit into " + std::to_string(frames) +
                     " frames; take shorter steps or fewer intervals");
  return spread(count, frames - 1 - reach);
}

}  // namespace cscd::bench
