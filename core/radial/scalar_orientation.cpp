#include <algorithm>
#include <limits>

#include "core/radial/orientation.h"

// Orientation classes of one triangle at a time, as the pipeline `published` makes them. This file is
// compiled without automatic vectorisation (CMakeLists.txt).
namespace cscd::radial {
namespace {

MovingNormal normal_of(const MovingPoint (&corner)[3]) {
  return moving_cross(between(corner[0], corner[1]), between(corner[0], corner[2]));
}

// The class of a triangle towards the moving point q, each coordinate of which is known up to `slack`.
Orientation towards_point(const MovingNormal& normal, const MovingPoint& corner, const MovingPoint& q,
                          double slack) {
  return from_sign(certain_sign(triple_product(normal, between(q, corner), slack)));
}

struct Range {
  double low, high;
};

// Returns a range that encloses the clamped projection parameters of the corners on the moving segment.
Range viewing_range(std::span<const MovingPoint> corners, const MovingSegment& segment) {
  if (!segment.projects()) return {0, 1};
  const auto& [head, tail, d, shortest, longest, unused] = segment;
  double low = std::numeric_limits<double>::infinity(), high = -low, reach = 0;
  for (const MovingPoint& p : corners) {
    const MovingVector w = between(head, p);
    const double along[3] = {w.start.dot(d.start), (w.start.dot(d.end) + w.end.dot(d.start)) / 2,
                             w.end.dot(d.end)};
    low = std::min({low, along[0], along[1], along[2]});
    high = std::max({high, along[0], along[1], along[2]});
    reach = std::max(reach, w.largest());
  }
  const double slack = kProjectionError * (1 + 3 * reach * d.largest() / shortest);
  const Range range{low / (low < 0 ? shortest : longest) - slack,
                    high / (high < 0 ? longest : shortest) + slack};
  const bool known = range.low <= range.high;  // false for NaN
  return known ? Range{std::clamp(range.low, 0.0, 1.0), std::clamp(range.high, 0.0, 1.0)} : Range{0, 1};
}

Orientation towards_segment(const MovingNormal& normal, const MovingPoint (&corner)[3],
                            const MovingSegment& segment, SegmentTest test) {
  const Range range = viewing_range(looked_at(corner, test), segment);
  const Orientation first = towards_point(normal, corner[0], segment.at(range.low), segment.slack);
  if (first == Orientation::uncertain || range.low == range.high) return first;
  const Orientation last = towards_point(normal, corner[0], segment.at(range.high), segment.slack);
  return last == first ? first : Orientation::uncertain;
}

}  // namespace

Orientation orientation(const MovingPoint (&corner)[3], const Observer& observer, SegmentTest test) {
  const MovingNormal normal = normal_of(corner);
  if (observer.is_segment) return towards_segment(normal, corner, MovingSegment(observer), test);
  return towards_point(normal, corner[0], observer.head, 0);
}

void OrientationTable::update_one_by_one() {
  normals_.resize(triangles_.size());
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const auto [p, q, r] = mesh_.corners(triangles_[i]);
    normals_[i] = normal_of({(*motion_)[p], (*motion_)[q], (*motion_)[r]});
  }
}

void OrientationTable::classify_one_by_one(std::size_t first, const Observer& observer,
                                           std::span<Orientation> out) const {
  if (observer.is_segment) {
    const MovingSegment segment(observer);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const auto [p, q, r] = mesh_.corners(triangles_[first + i]);
      out[i] =
          towards_segment(normals_[first + i], {(*motion_)[p], (*motion_)[q], (*motion_)[r]}, segment, test_);
    }
  } else {
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = towards_point(normals_[first + i], (*motion_)[mesh_.corners(triangles_[first + i])[0]],
                             observer.head, 0);
  }
}

// The normal is at most as long as the square of the longest edge, at every t.
bool plane_is_distant(const MovingPoint (&corner)[3], const MovingPoint& from, double distance) {
  const BernsteinCubic volume = triple_product(normal_of(corner), between(from, corner[0]));
  const int sign = certain_sign(volume);
  double longest = 0;
  for (int k = 0; k < 3; ++k) {
    const MovingVector edge = between(corner[k], corner[(k + 1) % 3]);
    longest = std::max({longest, edge.start.squaredNorm(), edge.end.squaredNorm()});
  }
  const double least = volume.error + (1 + 1e-9) * distance * longest;
  return sign != 0 && std::ranges::all_of(volume.c, [&](double c) { return sign * c > least; });
}

}  // namespace cscd::radial
