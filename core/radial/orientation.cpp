#include "core/radial/orientation.h"

#include <algorithm>
#include <cmath>
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

Orientation from_sign(int sign) {
  return sign > 0 ? Orientation::positive : sign < 0 ? Orientation::negative : Orientation::uncertain;
}

MovingVector between(const MovingPoint& from, const MovingPoint& to) {
  return {to.start - from.start, to.end - from.end};
}

// Returns the sign of one cubic, or the signs of eight.
//
// Error bound of a half: each half sum rounds once, and a control point of a half is up to three half sums
// deep. That puts it off by at most 3 u times the coefficients. The factor 4 also pays for the roundings of
// the bound.
template <class Cubic>
auto signs_of(Cubic f, SignTest test) {
  if (test == SignTest::plain) f.error -= f.error;  // NaN, thus no sign, where the error is infinite
  const auto whole = certain_sign(f);
  if (test != SignTest::halved) return whole;
  const auto error =
      f.error +
      4 * kUnitRoundoff * (absolute(f.c[0]) + absolute(f.c[1]) + absolute(f.c[2]) + absolute(f.c[3]));
  const auto a = 0.5 * (f.c[0] + f.c[1]), b = 0.5 * (f.c[1] + f.c[2]), c = 0.5 * (f.c[2] + f.c[3]);
  const auto d = 0.5 * (a + b), e = 0.5 * (b + c), middle = 0.5 * (d + e);
  const auto first = certain_sign(Cubic{{f.c[0], a, d, middle}, error}),
             last = certain_sign(Cubic{{middle, e, c, f.c[3]}, error});
  const decltype(whole + 0) none{};
  return select(whole != 0, whole, select(first == last, first, none));
}

// The class of a triangle towards the moving point q, each coordinate of which is known up to `slack`.
Orientation towards_point(const MovingPoint (&corner)[3], const MovingPoint& q, double slack, SignTest sign) {
  return from_sign(signs_of(triple_product(between(corner[0], corner[1]), between(corner[0], corner[2]),
                                           between(q, corner[0]), slack),
                            sign));
}

// A segment as an observer, with the numbers that are the same for all triangles.
struct MovingSegment {
  MovingPoint head, tail;
  MovingVector way;          // from head to tail
  double shortest, longest;  // bounds of the squared length
  double slack;              // error of a viewing position, which rounds in two operations on each coordinate

  explicit MovingSegment(const Observer& observer)
      : head(observer.head), tail(observer.tail), way(between(head, tail)) {
    const double length[3] = {way.start.squaredNorm(), way.start.dot(way.end), way.end.squaredNorm()};
    shortest = std::min({length[0], length[1], length[2]});
    longest = std::max({length[0], length[1], length[2]});
    const auto largest = [](const Vec3& v) { return v.cwiseAbs().maxCoeff(); };
    slack = 4 * kUnitRoundoff *
            std::max({largest(head.start), largest(head.end), largest(tail.start), largest(tail.end)});
  }
  // False if the squared length may leave the range of doubles, so that nothing is known of projections.
  // Triple products have limits as strict.
  bool projects() const { return shortest > 0 && longest <= kHugeProduct; }
  MovingPoint at(double u) const {
    return {(1 - u) * head.start + u * tail.start, (1 - u) * head.end + u * tail.end};
  }
};

// A dot product of differences is off by at most 6 u times three products. The factor 32 also covers the
// division.
constexpr double kProjectionError = 32 * kUnitRoundoff;

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

// Returns the corners that the test takes into account.
template <class Corner>
std::span<const Corner> looked_at(const Corner (&corner)[3], SegmentTest test) {
  return std::span<const Corner>(corner).first(test == SegmentTest::all_corners ? 3 : 1);
}

Orientation towards_segment(const MovingPoint (&corner)[3], const MovingSegment& segment, SegmentTest test,
                            SignTest sign) {
  const Range range = viewing_range(looked_at(corner, test), segment);
  const Orientation first = towards_point(corner, segment.at(range.low), segment.slack, sign);
  if (first == Orientation::uncertain || range.low == range.high) return first;
  const Orientation last = towards_point(corner, segment.at(range.high), segment.slack, sign);
  return last == first ? first : Orientation::uncertain;
}

// The rest repeats the functions above for eight triangles side by side, operation for operation.

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
                            const MovingSegment& segment, SegmentTest test, SignTest sign) {
  const RangeLanes range = viewing_range(looked_at(corner, test), segment);
  const auto signs = [&](Lane8 u) {
    return signs_of(triple_products(normal, corner[0] - viewing_positions(segment, u), segment.slack), sign);
  };
  const Sign8 first = signs(range.low), last = signs(range.high);
  return select(first == last, first, Sign8{});
}

}  // namespace

Orientation orientation(const MovingPoint (&corner)[3], const Observer& observer, SegmentTest test,
                        SignTest sign) {
  if (observer.is_segment) return towards_segment(corner, MovingSegment(observer), test, sign);
  return towards_point(corner, observer.head, 0, sign);
}

OrientationTable::OrientationTable(const TriangleMesh& mesh, std::span<const std::vector<TriangleId>> groups,
                                   SegmentTest test, SignTest sign)
    : test_(test), sign_(sign) {
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

// Calls `use` with a function that takes the number of a block and returns the signs of its eight triangles
// towards the observer.
template <class Use>
void OrientationTable::with_signs(const Observer& observer, Use use) const {
  if (observer.is_segment) {
    const MovingSegment segment(observer);
    use([&](std::size_t b) {
      const auto& [first, second, third] = lanes_[b].corner;
      const VectorLanes corner[3] = {blocks_[b].corner, gather(*motion_, second), gather(*motion_, third)};
      return signs_towards_segment(blocks_[b].normal, corner, segment, test_, sign_);
    });
  } else {
    const VectorLanes viewed_from = in_all_lanes(observer.head.start, observer.head.end);
    use([&](std::size_t b) {
      return signs_of(triple_products(blocks_[b].normal, blocks_[b].corner - viewed_from), sign_);
    });
  }
}

void OrientationTable::classify(std::size_t group, const Observer& observer,
                                std::span<Orientation> out) const {
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
  with_signs(observer, [&](const auto& block_signs) {
    const Sign8 signs = block_signs(first_block_[group] + member / kLanes);
    found = from_sign(static_cast<int>(signs[member % kLanes]));
  });
  return found;
}

}  // namespace cscd::radial
