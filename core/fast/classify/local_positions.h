#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/thread_pool.h"
#include "core/base/vec3.h"
#include "core/mesh/motion.h"

namespace cscd::fast {

// The positions of one interval as floats. They are shifted by the first vertex and scaled by a power of two
// that makes the reference pose about one unit large. So coordinates far from the origin lose nothing, and
// neither very small nor very large units underflow or overflow. Where the whole surface flies further than
// it is large, the origin flies with it: how places of the surface lie to each other is known as well then
// as where it stays.
class LocalPositions {
 public:
  // One vertex: x, y, z at the start and an unused number, then x, y, z at the end and an unused number.
  struct alignas(32) Record {
    float at[8];
  };

  // `reference`, [vertices], sets the scale and the number of vertices.
  explicit LocalPositions(std::span<const Vec3> reference);

  // Converts the positions of an interval, and finds their error. `off`, in units of the scene, is by how
  // much the coordinates of `motion` may be off themselves.
  void update(const Motion& motion, const ThreadPool& pool = ThreadPool(), double off = 0);
  // Does the same for the beginning of an interval, from t = 0 to `last`, and accounts for what positions at
  // that time are off.
  void update_beginning(const Motion& motion, double last, const ThreadPool& pool = ThreadPool());

  std::span<const Record> records() const { return records_; }
  // Returns where a point of local coordinates lies in the scene, at the start (0) or the end (1).
  Vec3 in_scene(const float (&at)[3], std::size_t end) const {
    return origin_[end] + Vec3(at[0], at[1], at[2]) / scale_;
  }
  // Returns a bound on the coordinates of the scene.
  double largest_in_scene() const;
  // A bound on the error of every coordinate, in local units.
  float error() const { return error_; }
  // The same, if the positions of a part of the motion are off by `off`, in units of the scene, on top.
  float error_beside(double off) const { return error_ + 1.0001F * static_cast<float>(off * scale_); }
  // A length of the scene in local units, rounded up. Where positions are known, any two are less than 4e9
  // apart, and a length that exceeds this may be any other that does.
  float in_local(double length) const {
    constexpr double kMost = 1e10;
    return length > 0 ? 1.000001F * static_cast<float>(std::min(length * scale_, kMost)) + 1e-37F : 0;
  }
  // False where the motion leaves the range in which errors are known. Nothing may be concluded from the
  // positions then.
  bool known() const { return known_; }

 private:
  template <class At>
  void convert_all(const Motion& motion, const ThreadPool& pool, const At& at);
  Vec3 common_way(const Motion& motion) const;
  template <class At>
  std::int32_t convert(const Motion& motion, std::size_t first, std::size_t last, const At& at);
  void add_error(double off);

  double scale_;
  // The first vertex at the start, and where that place is at the end if it flies as the surface does.
  std::array<Vec3, 2> origin_ = {Vec3::Zero(), Vec3::Zero()};
  std::vector<Record> records_;
  std::vector<std::int32_t> largest_;  // [ranges of vertices]: the bits of the largest coordinate
  float error_ = 0;
  bool known_ = false;
};

}  // namespace cscd::fast
