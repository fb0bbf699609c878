#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/team.h"
#include "core/base/vec3.h"
#include "core/mesh/motion.h"

namespace cscd::fast {

// The positions of one interval in local coordinates: floats, relative to the first vertex at the start of
// the interval, and scaled by a power of two that makes the reference pose about one unit large. So a surface
// far from the origin loses no precision, and a scene in very small or very large units neither underflows
// nor overflows.
class LocalPositions {
 public:
  // One vertex: x, y, z at the start, a number without meaning, x, y, z at the end, a number without meaning.
  struct alignas(32) Record {
    float at[8];
  };

  // `reference`, [vertices], sets the scale and the number of vertices.
  explicit LocalPositions(std::span<const Vec3> reference);

  // Converts the positions of an interval, and finds their error.
  void update(const Motion& motion, const Team& team = Team());

  std::span<const Record> records() const { return records_; }
  // No coordinate is off by more than this, in local units.
  float error() const { return error_; }
  // False if the motion leaves the range in which errors are known. Nothing may be concluded from the
  // positions then.
  bool known() const { return known_; }

 private:
  std::int32_t convert(const Motion& motion, std::size_t first, std::size_t last);

  double scale_;
  std::vector<Record> records_;
  std::vector<std::int32_t> largest_;  // [ranges of vertices]; as returned by convert()
  float error_ = 0;
  bool known_ = false;
};

}  // namespace cscd::fast
