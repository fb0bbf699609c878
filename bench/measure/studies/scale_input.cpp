#include "bench/measure/studies/scale_input.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

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

// The bones at all frames that the subject needs.
std::vector<scenes::BonePose> poses_of(const scenes::Scene& scene, const ScaleSubject& subject) {
  std::set<std::size_t> frames;
  for (const std::size_t start : subject.starts) {
    frames.insert(start);
    for (const ScaleStep& step : subject.steps) frames.insert(last_frame(start, step.frames));
  }
  return scenes::poses_at(scene, std::vector<std::size_t>(frames.begin(), frames.end()));
}

struct Moments {
  std::vector<Moment> moments;
  std::vector<MomentSource::Pair> intervals;
};

Moments posed_moments(const scenes::Scene& scene, const scenes::Shape& shape, const ScaleSubject& subject) {
  const std::vector<scenes::BonePose> poses = poses_of(scene, subject);
  Moments out;
  std::map<std::size_t, std::size_t> moment_at;  // by frame
  const auto moment = [&](std::size_t frame) {
    const auto [place, added] = moment_at.try_emplace(frame, out.moments.size());
    if (added) {
      const auto pose = std::ranges::find(poses, frame, &scenes::BonePose::frame);
      out.moments.push_back({scenes::carried(scene, shape, *pose),
                             subject.bones > 0 ? resampled_chain(pose->bones, subject.bones) : pose->bones});
    }
    return place->second;
  };
  for (const ScaleStep& step : subject.steps)
    for (const std::size_t start : subject.starts) {
      const std::size_t first = moment(start);
      std::size_t last = moment(last_frame(start, step.frames));
      if (step.frames < 1) {
        out.moments.push_back(between(out.moments[first], out.moments[last], step.frames));
        last = out.moments.size() - 1;
      }
      out.intervals.push_back({first, last});
    }
  return out;
}

Moments recorded_moments(const ScaleSubject& subject) {
  Moments out;
  const auto keep = [&](std::span<const Vec3> positions, std::span<const Bone> bones) {
    out.moments.push_back({{positions.begin(), positions.end()}, {bones.begin(), bones.end()}});
  };
  std::map<std::string, std::size_t> first_interval;  // by scene: steps of one scene share its moments
  for (const ScaleStep& step : subject.steps) {
    const auto [known, fresh] = first_interval.try_emplace(step.scene, out.intervals.size());
    if (!fresh) {
      for (std::size_t i = 0; i < subject.starts.size(); ++i)
        out.intervals.push_back(out.intervals[known->second + i]);
      continue;
    }
    const Input recorded = open_input(step.scene);
    for (const std::size_t start : subject.starts) {
      const scenes::ClipInterval interval = recorded.clip->load(start);
      const Rig::Interval bones = interval.bones.value_or(Rig::Interval{});
      keep(interval.motion.start(), bones.start);
      keep(interval.motion.end(), bones.end);
      out.intervals.push_back({out.moments.size() - 2, out.moments.size() - 1});
    }
  }
  return out;
}

}  // namespace

ScaleInput scale_input(const ScaleSubject& subject) {
  const Stopwatch building;
  if (is_point_cache(subject.scene)) {
    Input input = open_input(subject.scene);
    Moments moments = recorded_moments(subject);
    const scenes::ClipHeader& header = input.clip->header();
    input.clip = std::make_unique<MomentSource>(
        scenes::ClipHeader{header.triangles, header.vertex_count, header.bone_parent, false, header.rest},
        std::move(moments.moments), std::move(moments.intervals));
    input.threads = subject.threads;
    return {std::move(input), building.milliseconds()};
  }
  const scenes::Scene scene = scenes::load_scene(subject.scene);
  scenes::Shape shape =
      scenes::resized_shape(scene, subject.triangles > 0 ? subject.triangles : scenes::triangle_count(scene));
  if (subject.bones > 0 && !is_chain(shape.rig))
    throw InputError("scene " + scene.name + ": its bones form no chain; vary the bones of another scene");

  Moments moments = subject.recorded ? recorded_moments(subject) : posed_moments(scene, shape, subject);
  Rig rig = shape.rig;
  if (subject.bones > 0) {
    rig.reference = resampled_chain(rig.reference, subject.bones);
    rig.parent.clear();
    for (std::size_t i = 0; i < subject.bones; ++i) rig.parent.push_back(BoneId{static_cast<int>(i) - 1});
  }
  TriangleMesh mesh(shape.triangles, shape.positions.size(), scene.name);
  auto clip = std::make_unique<MomentSource>(
      scenes::ClipHeader{std::move(shape.triangles), shape.positions.size(), rig.parent, false},
      std::move(moments.moments), std::move(moments.intervals));
  std::optional<Rig> bones;  // cloth has none
  if (!rig.parent.empty()) bones = std::move(rig);
  Input input{scene.name, std::move(clip), std::move(mesh), std::move(shape.positions), std::move(bones)};
  input.threads = subject.threads;
  return {std::move(input), building.milliseconds()};
}

std::vector<std::size_t> spread_starts(std::size_t frames, std::size_t count, double longest_step) {
  const std::size_t reach = last_frame(0, longest_step);
  if (frames < reach + 1 + count)
    throw InputError("a step of " + std::to_string(reach) + " frames from " + std::to_string(count) +
                     " places does not fit into " + std::to_string(frames) +
                     " frames; take shorter steps or fewer intervals");
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < count; ++i) starts.push_back((2 * i + 1) * (frames - 1 - reach) / (2 * count));
  return starts;
}

}  // namespace cscd::bench
