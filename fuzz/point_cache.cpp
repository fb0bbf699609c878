// Point caches: whatever is read has finite positions and indices in range.
#include "scenes/clip/point_cache.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/mesh/triangle_mesh.h"
#include "fuzz/target.h"
#include "scenes/clip/test_hdf5_leaks.h"

namespace cscd::fuzz {

constexpr std::size_t kMostFrames = 16;  // that are looked at

void target(Bytes bytes) {
  const InputFile file(bytes);
  try {
    scenes::PointCacheReader reader(file.path());
    const TriangleMesh mesh(reader.header().triangles, reader.header().vertex_count);
    for (std::size_t i = 0; i < std::min(kMostFrames, reader.frame_count()); ++i) {
      const scenes::FrameView frame = reader.load_frame(i);
      if (frame.positions.size() != reader.header().vertex_count) broken("a frame lacks vertices");
      for (const Vec3& p : frame.positions)
        if (!p.allFinite()) broken("a position is not finite");
    }
  } catch (const InputError&) {
  }
}

}  // namespace cscd::fuzz
