#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/vec3.h"

// The positions of all vertices over time, beside a file that holds the faces: what Blender's Mesh Cache
// modifier and Maya read. Both formats keep single precision.
namespace cscd::scenes {

enum class MeshCacheFormat { pc2, mdd };

// Writes the head of a cache, before the positions of frame after frame. PC2 keeps a constant frame rate; MDD
// keeps the second of every frame. `first_frame` is the number of the first frame, whose frame 0 is at 0
// seconds. Throws InputError for more frames or vertices than the format can count.
std::string mesh_cache_head(MeshCacheFormat format, std::size_t vertices, std::size_t frames, double fps,
                            double first_frame);
std::string mesh_cache_frame(MeshCacheFormat format, std::span<const Vec3> positions);

// A cache over the bytes of a file, which must outlive it.
class MeshCache {
 public:
  // Throws InputError for bytes that are no such cache, are too few or too many for what its head says, or
  // hold no frame, for a PC2 cache whose samples are not one frame apart, and for an MDD cache whose times
  // fall.
  MeshCache(MeshCacheFormat format, std::string_view bytes);

  std::size_t vertices() const { return vertices_; }
  std::size_t frames() const { return frames_; }
  // The number of the first frame: what PC2 says, and in MDD its second times the rate; 0 where neither says.
  double first_frame() const { return first_frame_; }
  // Frames a second: of MDD, if they are evenly spaced. PC2 does not say.
  std::optional<double> fps() const { return fps_; }
  void read_frame(std::size_t frame, std::vector<Vec3>& positions) const;

 private:
  void read_times(std::string_view bytes);

  MeshCacheFormat format_;
  std::string_view body_;
  std::size_t vertices_ = 0, frames_ = 0;
  double first_frame_ = 0;
  std::optional<double> fps_;
};

}  // namespace cscd::scenes
