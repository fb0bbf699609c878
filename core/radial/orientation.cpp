#include "core/radial/orientation.h"

#include <algorithm>
#include <cmath>
#include <limits>

// Idea: towards a point q the orientation of a triangle is the sign of normal(t) . (p(t) - q(t)) for any one
// corner p, a cubic in t whose Bernstein coefficients prove a sign when they exceed their forward error bound
// (trap 4).
//
// Towards a segment the viewing position q(u) slides with the projection u of each point, clamped to [0, 1].
// The dot product is linear in u, and u is monotone in the projection, which over a triangle is extreme at a
// corner. So with [low, high] enclosing the clamped projections of all three corners over the interval, one
// sign at both q(low) and q(high) holds at every viewing position in use (trap 2). Two cubics, instead of the
// paper's rational function of degree five at one arbitrary vertex.
//
// A sign is a proof; `uncertain` is not. About 40 operations a triangle and point observer, vectorised.
namespace cscd::radial {
namespace {

Orientation from_sign(int sign) {
  return sign > 0 ? Orientation::positive : sign < 0 ? Orientation::negative : Orientation::uncertain;
}

MovingVector between(const MovingPoint& from, const MovingPoint& to) {
  return {to.start - from.start, to.end - from.end};
}

// Towards the moving point q, itself known up to `slack` in each coordinate.
Orientation towards_point(const MovingPoint (&corner)[3], const MovingPoint& q, double slack) {
  return from_sign(certain_sign(triple_product(between(corner[0], corner[1]), between(corner[0], corner[2]),
                                               between(q, corner[0]), slack)));
}

struct Range {
  double low, high;
};

// Encloses the clamped projection parameters of corners on the moving segment.
Range viewing_range(std::span<const MovingPoint> corners, const MovingPoint& head, const MovingPoint& tail) {
  const MovingVector d = between(head, tail);
  const double length[3] = {d.start.squaredNorm(), d.start.dot(d.end), d.end.squaredNorm()};
  const double shortest = std::min({length[0], length[1], length[2]});
  const double longest = std::max({length[0], length[1], length[2]});
  // Outside the range of doubles nothing is known; the triple products are as strict.
  if (!(shortest > 0 && longest <= kHugeProduct)) return {0, 1};
  double low = std::numeric_limits<double>::infinity(), high = -low, reach = 0;
  for (const MovingPoint& p : corners) {
    const MovingVector w = between(head, p);
    const double along[3] = {w.start.dot(d.start), (w.start.dot(d.end) + w.end.dot(d.start)) / 2,
                             w.end.dot(d.end)};
    low = std::min({low, along[0], along[1], along[2]});
    high = std::max({high, along[0], along[1], along[2]});
    reach = std::max(reach, w.largest());
  }
  // A dot product of differences is off by at most 6 u times three products; 32 also covers the division.
  const double slack = 32 * kUnitRoundoff * (1 + 3 * reach * d.largest() / shortest);
  const Range range{low / (low < 0 ? shortest : longest) - slack,
                    high / (high < 0 ? longest : shortest) + slack};
  const bool known = range.low <= range.high;  // false for NaN
  return known ? Range{std::clamp(range.low, 0.0, 1.0), std::clamp(range.high, 0.0, 1.0)} : Range{0, 1};
}

Orientation towards_segment(const MovingPoint (&corner)[3], const MovingPoint& head, const MovingPoint& tail,
                            SegmentTest test) {
  const std::span<const MovingPoint> corners(corner);
  const Range range =
      viewing_range(test == SegmentTest::all_corners ? corners : corners.first(1), head, tail);
  // q(u) is rounded in two operations on each coordinate.
  const auto largest = [](const Vec3& v) { return v.cwiseAbs().maxCoeff(); };
  const double slack =
      4 * kUnitRoundoff *
      std::max({largest(head.start), largest(head.end), largest(tail.start), largest(tail.end)});
  const auto at = [&](double u) -> MovingPoint {
    return {(1 - u) * head.start + u * tail.start, (1 - u) * head.end + u * tail.end};
  };
  const Orientation first = towards_point(corner, at(range.low), slack);
  if (first == Orientation::uncertain || range.low == range.high) return first;
  return towards_point(corner, at(range.high), slack) == first ? first : Orientation::uncertain;
}

}  // namespace

Orientation orientation(const MovingPoint (&corner)[3], const Observer& observer, SegmentTest test) {
  if (observer.is_segment) return towards_segment(corner, observer.head, observer.tail, test);
  return towards_point(corner, observer.head, 0);
}

OrientationTable::OrientationTable(const TriangleMesh& mesh, std::span<const std::vector<TriangleId>> groups,
                                   SegmentTest test)
    : mesh_(mesh), test_(test) {
  for (const std::vector<TriangleId>& group : groups) {
    first_block_.push_back(lanes_.size());
    for (std::size_t first = 0; first < group.size(); first += kLanes) {
      TriangleLanes& lanes = lanes_.emplace_back();
      for (std::size_t l = 0; l < kLanes; ++l) {
        const TriangleId triangle = group[std::min(first + l, group.size() - 1)];
        lanes.triangle[l] = triangle;
        for (std::size_t k = 0; k < 3; ++k) lanes.corner[k].set(l, mesh.corners(triangle)[k]);
      }
    }
  }
  first_block_.push_back(lanes_.size());
  blocks_.resize(lanes_.size());
}

void OrientationTable::update(const Motion& motion) {
  motion_ = motion;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const auto& [first, second, third] = lanes_[i].corner;
    const VectorLanes corner = gather(motion, first);
    blocks_[i] = {cross(gather(motion, second) - corner, gather(motion, third) - corner), corner};
  }
}

void OrientationTable::classify(std::size_t group, const Observer& observer,
                                std::span<Orientation> out) const {
  if (observer.is_segment) {
    for (std::size_t member = 0; member < out.size(); ++member)
      out[member] = classify(group, member, observer);
    return;
  }
  VectorLanes viewed_from;
  for (int i = 0; i < 3; ++i) {
    viewed_from.at[0][i] = Lane8{} + observer.head.start[i];
    viewed_from.at[1][i] = Lane8{} + observer.head.end[i];
  }
  for (std::size_t b = first_block_[group], first = 0; first < out.size(); ++b, first += kLanes) {
    const Sign8 signs = certain_signs(blocks_[b].normal, blocks_[b].corner - viewed_from);
    const std::size_t count = std::min(kLanes, out.size() - first);
    for (std::size_t l = 0; l < count; ++l) out[first + l] = from_sign(static_cast<int>(signs[l]));
  }
}

Orientation OrientationTable::classify(std::size_t group, std::size_t member,
                                       const Observer& observer) const {
  const std::size_t block = first_block_[group] + member / kLanes;
  const Triangle& c = mesh_.corners(lanes_[block].triangle[member % kLanes]);
  const Motion& m = *motion_;
  return orientation({m[c[0]], m[c[1]], m[c[2]]}, observer, test_);
}

}  // namespace cscd::radial
