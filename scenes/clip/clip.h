#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/motion.h"
#include "core/mesh/rig.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::scenes {

// The data that all frames of an animated surface share.
struct ClipHeader {
  std::vector<Triangle> triangles;  // [triangles]
  std::size_t vertex_count = 0;
  std::vector<BoneId> bone_parent;  // [bones]; empty without bones
  bool predicted = false;           // intervals end at predictions of a simulator, not at the next frame
  // [vertices]: the positions in the pose at rest. Triangles that cross in that pose cross because the
  // surface is made so, and are no collision. Empty if the pose at rest is frame 0.
  std::vector<Vec3> rest = {};
  std::string up = {};  // the axis that points up, for whoever looks at it (up_axis.h); empty if nothing says
};

// One frame: positions [vertices] and bones [bones].
struct FrameView {
  std::span<const Vec3> positions;
  std::span<const Bone> bones;
};

// One interval as views into its clip. `bones` is absent without a rig.
struct ClipInterval {
  Motion motion;
  std::optional<Rig::Interval> bones;
};

// A source of intervals: memory, or a file that may be larger than memory.
class ClipSource {
 public:
  virtual ~ClipSource() = default;
  virtual const ClipHeader& header() const = 0;
  virtual std::size_t frame_count() const = 0;  // at least 2
  // Return views that are valid until the next load from the same source. They throw InputError for a frame
  // that does not exist, cannot be read, or holds a number that is not finite.
  virtual ClipInterval load(std::size_t interval) = 0;
  virtual FrameView load_frame(std::size_t frame) = 0;

  std::size_t interval_count() const { return frame_count() - 1; }
};

// A receiver of frames, one after the other.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  // `predicted` is the predicted end of the interval that starts at the previous frame. It is present for
  // every frame but the first if the header announces predictions, and null otherwise. Throws InputError if
  // the frame does not fit the header (check_frame).
  virtual void append(const FrameView& frame, const FrameView* predicted) = 0;
};

// An animated surface in memory. It owns its frames, and intervals are views of them.
class Clip final : public ClipSource, public FrameSink {
 public:
  explicit Clip(ClipHeader header) : header_(std::move(header)) {}

  void append(const FrameView& frame, const FrameView* predicted = nullptr) override;

  const ClipHeader& header() const override { return header_; }
  std::size_t frame_count() const override { return frames_.count; }
  FrameView frame(std::size_t frame) const { return frames_.view(frame, header_); }
  // The interval from frame i to its end, which is frame i + 1 or the prediction. The views are valid until
  // the next append.
  ClipInterval interval(std::size_t i) const;
  ClipInterval load(std::size_t i) override { return interval(i); }
  FrameView load_frame(std::size_t i) override { return frame(i); }

 private:
  struct Frames {
    std::vector<Vec3> positions;  // [count, vertices]
    std::vector<Bone> bones;      // [count, bones]
    std::size_t count = 0;
    void append(const FrameView& frame);
    FrameView view(std::size_t frame, const ClipHeader& header) const;
  };
  ClipHeader header_;
  Frames frames_, predicted_;
};

// Throws InputError if the frame or its prediction has other sizes than the header or holds a number that
// is not finite, or if a prediction is missing or present against the header. `index` is the number of the
// frame.
void check_frame(const ClipHeader& header, std::size_t index, const FrameView& frame,
                 const FrameView* predicted);

// The skeleton in the pose of frame 0, or nullopt if the source has no bones.
std::optional<Rig> rig_of(const ClipHeader& header, const FrameView& first);
std::optional<Rig> rig_of(ClipSource& source);  // loads frame 0

// Hands all frames of a source to a sink with the same header. It holds at most one frame in memory beside
// the frames of the source. After each frame `progress` is called with the number of frames done.
void copy_frames(ClipSource& source, FrameSink& sink, const std::function<void(std::size_t)>& progress = {});

}  // namespace cscd::scenes
