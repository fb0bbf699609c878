#pragma once

#include <filesystem>
#include <memory>

#include "scenes/clip/clip.h"

namespace cscd::scenes {

// Point caches: HDF5 files of
//   /positions            float64 [frames, vertices, 3], frame 0 the reference pose
//   /triangles            int32   [triangles, 3], counter-clockwise seen from outside
//   /rest                 float64 [vertices, 3]: the pose at rest, frame 0 without it (optional)
//   /bones/parent         int32   [bones], -1 for a root                            (optional)
//   /bones/head, tail     float64 [frames, bones, 3]                                 (with parent)
//   /predicted            float64 [frames - 1, vertices, 3]: ends of the intervals   (optional)
//   /bones/predicted_head, predicted_tail float64 [frames - 1, bones, 3]             (with predicted and
//   parent)
// Positions are used exactly as stored. All errors are InputError and name the file, the dataset and the
// element.

// Streams a point cache: three frames are in memory at most, whatever the length. float32 positions and wider
// integers are accepted where nothing is lost.
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

// Writes a point cache frame by frame under a temporary name in the same folder; `finish` gives it its name.
// The same frames give the same bytes.
class PointCacheWriter final : public FrameSink {
 public:
  // Refuses a path that exists unless `force`.
  PointCacheWriter(std::filesystem::path path, ClipHeader header, bool force);
  ~PointCacheWriter() override;  // without finish, leaves nothing behind
  PointCacheWriter(PointCacheWriter&&) noexcept;
  PointCacheWriter& operator=(PointCacheWriter&&) noexcept;

  void append(const FrameView& frame, const FrameView* predicted = nullptr) override;
  void finish();  // at least two frames

 private:
  struct File;
  std::unique_ptr<File> file_;
};

// Reads a whole point cache into memory.
Clip read_clip(const std::filesystem::path& path);

}  // namespace cscd::scenes
