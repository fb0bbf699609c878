#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/motion.h"
#include "core/mesh/rig.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::scenes {

// What all frames of an animated surface share.
struct ClipHeader {
  std::vector<Triangle> triangles;
  std::size_t vertex_count = 0;
  std::vector<BoneId> bone_parent;  // empty without bones
  bool predicted = false;           // intervals end where a simulator predicted, not at the next frame
  // Positions [vertices] in the pose at rest: what crosses in it is how the surface is made, and no
  // collision. Empty where that is frame 0.
  std::vector<Vec3> rest = {};
};

// One moment: positions [vertices] and bones [bones].
struct FrameView {
  std::span<const Vec3> positions;
  std::span<const Bone> bones;
};

// One interval as views into its clip. `bones` is absent without a rig.
struct ClipInterval {
  Motion motion;
  std::optional<Rig::Interval> bones;
};

// Where intervals come from: memory, or a file that is larger than memory.
class ClipSource {
 public:
  virtual ~ClipSource() = default;
  virtual const ClipHeader& header() const = 0;
  virtual std::size_t frame_count() const = 0;  // at least 2
  // Views that hold until the next load of the same source. Throws InputError for a frame that cannot be read
  // or holds a number that is not finite.
  virtual ClipInterval load(std::size_t interval) = 0;
  virtual FrameView load_frame(std::size_t frame) = 0;

  std::size_t interval_count() const { return frame_count() - 1; }
};

// Takes frames one after the other.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  // `predicted` is where the interval from the frame before was predicted to end: present for every frame but
  // the first if the header says so, and never else. Throws InputError for sizes that do not fit the header.
  virtual void append(const FrameView& frame, const FrameView* predicted) = 0;
};

// An animated surface in memory. Owns its frames; intervals are views.
class Clip final : public ClipSource, public FrameSink {
 public:
  explicit Clip(ClipHeader header) : header_(std::move(header)) {}

  void append(const FrameView& frame, const FrameView* predicted = nullptr) override;

  const ClipHeader& header() const override { return header_; }
  std::size_t frame_count() const override { return frames_.count; }
  FrameView frame(std::size_t frame) const { return frames_.view(frame, header_); }
  // From frame i to where it ends: frame i + 1, or the prediction. Holds as long as nothing is appended.
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

// Throws InputError unless the frame has the header's sizes and is finite, and a prediction is there exactly
// where the header promises one. `index` is the frame's number.
void check_frame(const ClipHeader& header, std::size_t index, const FrameView& frame,
                 const FrameView* predicted);

// The skeleton in the pose of frame 0; absent without bones. Loads frame 0.
std::optional<Rig> rig_of(ClipSource& source);

// Hands all frames of a source to a sink of the same header, at most two at a time in memory beside the
// source's. `progress` is called with the number of frames done.
void copy_frames(ClipSource& source, FrameSink& sink, const std::function<void(std::size_t)>& progress = {});

}  // namespace cscd::scenes
