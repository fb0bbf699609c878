#pragma once

#include <cassert>
#include <cstddef>
#include <span>

#include "core/base/ids.h"
#include "core/base/vec3.h"

namespace cscd {

// A point that moves in a straight line at constant speed: x(t) = (1 - t) start + t end for t in [0, 1].
struct MovingPoint {
  Vec3 start, end;
  Vec3 at(double t) const { return (1 - t) * start + t * end; }
};

// A view of one interval: the positions of all vertices at t = 0 and at t = 1, [vertices] each.
// The caller owns the positions.
class Motion {
 public:
  Motion(std::span<const Vec3> start, std::span<const Vec3> end) : start_(start), end_(end) {
    assert(start.size() == end.size());
  }
  std::size_t vertex_count() const { return start_.size(); }
  std::span<const Vec3> start() const { return start_; }
  std::span<const Vec3> end() const { return end_; }
  MovingPoint operator[](VertexId vertex) const { return {start_[+vertex], end_[+vertex]}; }

 private:
  std::span<const Vec3> start_, end_;
};

}  // namespace cscd
