#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/team.h"
#include "core/base/vec3.h"
#include "core/mesh/motion.h"

namespace cscd::fast {

// The positions of one interval in float: shifted by the first vertex, scaled by a power of two that makes
// the reference pose about one unit large. So coordinates far from the origin lose nothing, and neither very
// small nor very large units underflow or overflow.
class LocalPositions {
 public:
  // One vertex: x, y, z at the start, nothing, x, y, z at the end, nothing.
  struct alignas(32) Record {
    float at[8];
  };

  explicit LocalPositions(std::span<const Vec3> reference);

  void update(const Motion& motion, const Team& team = Team());

  std::span<const Record> records() const { return records_; }
  // Every coordinate is off by at most this much.
  float error() const { return error_; }
  // False where the motion leaves the range in which errors are known: nothing may be concluded then.
  bool known() const { return known_; }

 private:
  std::int32_t convert(const Motion& motion, std::size_t first, std::size_t last);

  double scale_;
  std::vector<Record> records_;
  std::vector<std::int32_t> largest_;  // of each range
  float error_ = 0;
  bool known_ = false;
};

}  // namespace cscd::fast
