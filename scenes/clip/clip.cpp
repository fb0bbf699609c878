#include "scenes/clip/clip.h"

#include <string>

#include "core/base/error.h"

namespace cscd::scenes {
namespace {

void check_part(const ClipHeader& header, const std::string& where, const FrameView& frame) {
  if (frame.positions.size() != header.vertex_count)
    throw InputError(where + ": " + std::to_string(frame.positions.size()) + " positions for " +
                     std::to_string(header.vertex_count) + " vertices; give one each");
  if (frame.bones.size() != header.bone_parent.size())
    throw InputError(where + ": " + std::to_string(frame.bones.size()) + " bones for a rig of " +
                     std::to_string(header.bone_parent.size()) + "; give one each");
  for (std::size_t i = 0; i < frame.positions.size(); ++i)
    if (!frame.positions[i].allFinite())
      throw InputError(where + ", vertex " + std::to_string(i) +
                       ": position is not finite; repair the animation");
  for (std::size_t i = 0; i < frame.bones.size(); ++i)
    if (!frame.bones[i].head.allFinite() || !frame.bones[i].tail.allFinite())
      throw InputError(where + ", bone " + std::to_string(i) + ": joint is not finite; repair the animation");
}

}  // namespace

void check_frame(const ClipHeader& header, std::size_t index, const FrameView& frame,
                 const FrameView* predicted) {
  const std::string where = "frame " + std::to_string(index);
  check_part(header, where, frame);
  if ((predicted != nullptr) != (header.predicted && index > 0))
    throw InputError(where + (predicted
                                  ? ": a prediction that the clip does not announce"
                                  : ": the prediction is missing; give one for every frame but the first"));
  if (predicted) check_part(header, "prediction of " + where, *predicted);
}

void Clip::Frames::append(const FrameView& frame) {
  positions.insert(positions.end(), frame.positions.begin(), frame.positions.end());
  bones.insert(bones.end(), frame.bones.begin(), frame.bones.end());
  ++count;
}

FrameView Clip::Frames::view(std::size_t frame, const ClipHeader& header) const {
  return {std::span(positions).subspan(frame * header.vertex_count, header.vertex_count),
          std::span(bones).subspan(frame * header.bone_parent.size(), header.bone_parent.size())};
}

void Clip::append(const FrameView& frame, const FrameView* predicted) {
  check_frame(header_, frames_.count, frame, predicted);
  frames_.append(frame);
  if (predicted) predicted_.append(*predicted);
}

ClipInterval Clip::interval(std::size_t i) const {
  const FrameView start = frames_.view(i, header_);
  const FrameView end = header_.predicted ? predicted_.view(i, header_) : frames_.view(i + 1, header_);
  ClipInterval interval{Motion(start.positions, end.positions), std::nullopt};
  if (!header_.bone_parent.empty()) interval.bones = Rig::Interval{start.bones, end.bones};
  return interval;
}

std::optional<Rig> rig_of(const ClipHeader& header, const FrameView& first) {
  if (header.bone_parent.empty()) return std::nullopt;
  return Rig{header.bone_parent, {first.bones.begin(), first.bones.end()}};
}

std::optional<Rig> rig_of(ClipSource& source) {
  return rig_of(source.header(), source.load_frame(0));
}

void copy_frames(ClipSource& source, FrameSink& sink, const std::function<void(std::size_t)>& progress) {
  std::vector<Vec3> positions;
  std::vector<Bone> bones;
  for (std::size_t frame = 0; frame < source.frame_count(); ++frame) {
    FrameView predicted;
    const bool has_prediction = source.header().predicted && frame > 0;
    if (has_prediction) {
      const ClipInterval interval = source.load(frame - 1);
      positions.assign(interval.motion.end().begin(), interval.motion.end().end());
      bones.clear();
      if (interval.bones) bones.assign(interval.bones->end.begin(), interval.bones->end.end());
      predicted = {positions, bones};
    }
    sink.append(source.load_frame(frame), has_prediction ? &predicted : nullptr);
    if (progress) progress(frame + 1);
  }
}

}  // namespace cscd::scenes
