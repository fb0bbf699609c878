#include "core/radial/orientation.h"

#include <algorithm>
#include <limits>

// Towards a point q, the orientation of a triangle is the sign of normal(t) . (p(t) - q(t)) for any one
// corner p. That is a cubic in t. Its Bernstein coefficients prove a sign if they exceed their forward error
// bound (rule error-bound).
//
// Towards a segment, each point of the triangle is viewed from a position q(u) of its own, where u is the
// projection of the point onto the segment, clamped to [0, 1]. The dot product is linear in u. The clamped u
// is monotone in the projection, and over a triangle the projection is extreme at a corner. Let [low, high]
// enclose the clamped projections of all three corners over the interval. If the signs at q(low) and at
// q(high) are the same, that sign holds at every viewing position in use (rule three-vertices). This takes
// two cubics, instead of the paper's rational function of degree five at one arbitrary vertex.
//
// A sign is a proof, `uncertain` proves nothing. One triangle and one point observer take about 40
// operations, vectorised.
namespace cscd::radial {
namespace {

// These repeat the functions of scalar_orientation.cpp for eight triangles side by side, operation for
// operation.

VectorLanes in_all_lanes(const Vec3& start, const Vec3& end) {
  VectorLanes out;
  for (int i = 0; i < 3; ++i) {
    out.at[0][i] = Lane8{} + start[i];
    out.at[1][i] = Lane8{} + end[i];
  }
  return out;
}

struct RangeLanes {
  Lane8 low, high;
};

RangeLanes viewing_range(std::span<const VectorLanes> corners, const MovingSegment& segment) {
  const Lane8 zero = {}, one = zero + 1;
  if (!segment.projects()) return {zero, one};
  const auto& [head, tail, d, shortest, longest, unused] = segment;
  const VectorLanes from = in_all_lanes(head.start, head.end);
  const auto dot = [](const Lane8(&a)[3], const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
  const auto lesser = [](Lane8 a, Lane8 b) { return select(b < a, b, a); };
  Lane8 low = zero + std::numeric_limits<double>::infinity(), high = -low, reach = zero;
  for (const VectorLanes& p : corners) {
    const VectorLanes w = p - from;
    const Lane8 along[3] = {dot(w.at[0], d.start), (dot(w.at[0], d.end) + dot(w.at[1], d.start)) / 2,
                            dot(w.at[1], d.end)};
    low = lesser(lesser(lesser(low, along[0]), along[1]), along[2]);
    high = larger(larger(larger(high, along[0]), along[1]), along[2]);
    reach = larger(reach, w.largest_component());
  }
  const Lane8 slack = kProjectionError * (1 + 3 * reach * d.largest() / shortest);
  low = low / select(low < 0, zero + shortest, zero + longest) - slack;
  high = high / select(high < 0, zero + longest, zero + shortest) + slack;
  const Sign8 known = low <= high;
  const auto clamped = [&](Lane8 u) { return select(u < 0, zero, select(u > 1, one, u)); };
  return {select(known, clamped(low), zero), select(known, clamped(high), one)};
}

// Returns the viewing positions of eight triangles.
VectorLanes viewing_positions(const MovingSegment& segment, Lane8 u) {
  VectorLanes out;
  for (int i = 0; i < 3; ++i) {
    out.at[0][i] = (1 - u) * segment.head.start[i] + u * segment.tail.start[i];
    out.at[1][i] = (1 - u) * segment.head.end[i] + u * segment.tail.end[i];
  }
  return out;
}

Sign8 signs_towards_segment(const NormalLanes& normal, const VectorLanes (&corner)[3],
                            const MovingSegment& segment, SegmentTest test) {
  const RangeLanes range = viewing_range(looked_at(corner, test), segment);
  const auto signs = [&](Lane8 u) {
    return certain_sign(triple_products(normal, corner[0] - viewing_positions(segment, u), segment.slack));
  };
  const Sign8 first = signs(range.low), last = signs(range.high);
  return select(first == last, first, Sign8{});
}

}  // namespace

OrientationTable::OrientationTable(const TriangleMesh& mesh, std::span<const std::vector<TriangleId>> groups,
                                   SegmentTest test, Pipeline pipeline)
    : mesh_(mesh), test_(test), pipeline_(pipeline) {
  for (const std::vector<TriangleId>& group : groups) {
    first_triangle_.push_back(triangles_.size());
    triangles_.insert(triangles_.end(), group.begin(), group.end());
    first_block_.push_back(lanes_.size());
    for (std::size_t first = 0; first < group.size(); first += kLanes) {
      TriangleLanes& lanes = lanes_.emplace_back();
      for (std::size_t l = 0; l < kLanes; ++l) {
        const TriangleId triangle = group[std::min(first + l, group.size() - 1)];
        for (std::size_t k = 0; k < 3; ++k) lanes.corner[k].set(l, mesh.corners(triangle)[k]);
      }
    }
  }
  first_triangle_.push_back(triangles_.size());
  first_block_.push_back(lanes_.size());
  blocks_.resize(lanes_.size());
}

void OrientationTable::update(const Motion& motion) {
  motion_ = motion;
  if (pipeline_ == Pipeline::published) return update_one_by_one();
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const auto& [first, second, third] = lanes_[i].corner;
    const VectorLanes corner = gather(motion, first);
    blocks_[i] = {cross(gather(motion, second) - corner, gather(motion, third) - corner), corner};
  }
}

// Calls `use` with a function that takes the number of a block and returns the signs of its eight triangles
// towards the observer.
template <class Use>
void OrientationTable::with_signs(const Observer& observer, Use use) const {
  if (observer.is_segment) {
    const MovingSegment segment(observer);
    use([&](std::size_t b) {
      const auto& [first, second, third] = lanes_[b].corner;
      const VectorLanes corner[3] = {blocks_[b].corner, gather(*motion_, second), gather(*motion_, third)};
      return signs_towards_segment(blocks_[b].normal, corner, segment, test_);
    });
  } else {
    const VectorLanes viewed_from = in_all_lanes(observer.head.start, observer.head.end);
    use([&](std::size_t b) {
      return certain_sign(triple_products(blocks_[b].normal, blocks_[b].corner - viewed_from));
    });
  }
}

void OrientationTable::classify(std::size_t group, const Observer& observer,
                                std::span<Orientation> out) const {
  if (pipeline_ == Pipeline::published) return classify_one_by_one(first_triangle_[group], observer, out);
  with_signs(observer, [&](const auto& block_signs) {
    for (std::size_t b = first_block_[group], first = 0; first < out.size(); ++b, first += kLanes) {
      const Sign8 signs = block_signs(b);
      const std::size_t count = std::min(kLanes, out.size() - first);
      for (std::size_t l = 0; l < count; ++l) out[first + l] = from_sign(static_cast<int>(signs[l]));
    }
  });
}

Orientation OrientationTable::classify(std::size_t group, std::size_t member,
                                       const Observer& observer) const {
  Orientation found;
  if (pipeline_ == Pipeline::published) {
    classify_one_by_one(first_triangle_[group] + member, observer, {&found, 1});
    return found;
  }
  with_signs(observer, [&](const auto& block_signs) {
    const Sign8 signs = block_signs(first_block_[group] + member / kLanes);
    found = from_sign(static_cast<int>(signs[member % kLanes]));
  });
  return found;
}

}  // namespace cscd::radial
