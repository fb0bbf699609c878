#pragma once

#include <filesystem>
#include <memory>

#include "scenes/clip/clip.h"

namespace cscd::scenes {

// A point cache is an HDF5 file with these datasets:
//   /positions            float64 [frames, vertices, 3], frame 0 the reference pose
//   /triangles            int32   [triangles, 3], counter-clockwise seen from outside
//   /rest                 float64 [vertices, 3]: the pose at rest, frame 0 without it (optional)
//   /bones/parent         int32   [bones], -1 for a root                            (optional)
//   /bones/head, tail     float64 [frames, bones, 3]                                 (with parent)
//   /predicted            float64 [frames - 1, vertices, 3]: ends of the intervals   (optional)
//   /bones/predicted_head, predicted_tail float64 [frames - 1, bones, 3]         (with predicted and parent)
//   attribute up of /     text, "x" to "z" or "-x" to "-z": the axis that points up (optional)
// Positions are used exactly as stored. All errors are InputError and name the file, the dataset and the
// element.

// Streams a point cache. At most three frames are in memory, whatever the length of the file. float32
// positions are accepted too, and so are wider integers whose values fit.
class PointCacheReader final : public ClipSource {
 public:
  explicit PointCacheReader(const std::filesystem::path& path);
  ~PointCacheReader() override;
  PointCacheReader(PointCacheReader&&) noexcept;
  PointCacheReader& operator=(PointCacheReader&&) noexcept;

  const ClipHeader& header() const override;
  std::size_t frame_count() const override;
  ClipInterval load(std::size_t interval) override;
  FrameView load_frame(std::size_t frame) override;

 private:
  struct File;
  std::unique_ptr<File> file_;
};

// Writes a point cache frame by frame, under a temporary name in the same folder; `finish` gives the file
// its name. Equal frames give equal bytes. Throws InputError if the file cannot be written.
class PointCacheWriter final : public FrameSink {
 public:
  // Throws InputError if the path exists and `force` is false.
  PointCacheWriter(std::filesystem::path path, ClipHeader header, bool force);
  ~PointCacheWriter() override;  // removes the temporary file if `finish` was not called
  PointCacheWriter(PointCacheWriter&&) noexcept;
  PointCacheWriter& operator=(PointCacheWriter&&) noexcept;

  void append(const FrameView& frame, const FrameView* predicted = nullptr) override;
  void finish();  // throws InputError if fewer than two frames were appended

 private:
  struct File;
  std::unique_ptr<File> file_;
};

// Reads a whole point cache into memory. Throws InputError if it does not fit.
Clip read_clip(const std::filesystem::path& path);

}  // namespace cscd::scenes
