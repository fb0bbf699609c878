#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/pipeline.h"
#include "core/base/vec3.h"
#include "core/geometry/bernstein.h"
#include "core/geometry/triple_product_lanes.h"
#include "core/mesh/motion.h"
#include "core/mesh/triangle_mesh.h"

// Orientation of moving triangles towards a moving observer (Wong et al. 2013; section 3.1 of the 2014
// paper).
namespace cscd::radial {

// A triangle is *positive* if its normal makes a positive dot product with the ray from the observer through
// every point of the triangle at every t in [0, 1]. It is *negative* if all these products are negative. It
// is *uncertain* if neither is proven. The values are bits, so that a set of classes is a mask.
enum class Orientation : std::uint8_t { positive = 1, negative = 2, uncertain = 4 };

// An observer is a point, or a segment along which the viewing position slides. Its ends move in straight
// lines.
struct Observer {
  MovingPoint head, tail;
  bool is_segment;

  static Observer point(const MovingPoint& p) { return {p, p, false}; }
  static Observer segment(const MovingPoint& head, const MovingPoint& tail) { return {head, tail, true}; }
};

// Which corners decide how a triangle is seen from a segment. The paper looks at one arbitrary corner, which
// proves nothing (rule three-vertices, core/soundness.md); it is here to count what that costs and loses.
enum class SegmentTest { all_corners, first_corner };

// Classifies one triangle in double precision, straight from its vertices. This is the scalar twin of
// OrientationTable.
Orientation orientation(const MovingPoint (&corner)[3], const Observer& observer,
                        SegmentTest test = SegmentTest::all_corners);

// Whether the plane of a triangle is certainly farther from a moving point than a distance, at every t.
bool plane_is_distant(const MovingPoint (&corner)[3], const MovingPoint& from, double distance);

// Everything that the orientation of a triangle needs, gathered once an interval: the control vectors of its
// normal, one corner, and a bound on the rounding of the normal. Triangles are grouped by cluster in blocks
// of eight lanes, so that an observer is tried on a whole cluster in vector code.
class OrientationTable {
 public:
  // `groups` are the triangles of each cluster. In the pipeline `published`, one triangle is classified after
  // the other by the scalar twin. The classes are the same. The mesh must outlive the table.
  OrientationTable(const TriangleMesh& mesh, std::span<const std::vector<TriangleId>> groups,
                   SegmentTest test = SegmentTest::all_corners, Pipeline pipeline = Pipeline::vectorised);

  // Begins an interval. The positions of `motion` must stay in place until the last classification of the
  // interval.
  void update(const Motion& motion);

  // Classifies all triangles of one group, in the group's order.
  void classify(std::size_t group, const Observer& observer, std::span<Orientation> out) const;
  // Classifies one triangle; `member` is its place in the group.
  Orientation classify(std::size_t group, std::size_t member, const Observer& observer) const;

 private:
  struct TriangleLanes {
    std::array<VertexLanes, 3> corner;
  };
  struct Block {
    NormalLanes normal;
    VectorLanes corner;  // the first corner
  };
  template <class Use>
  void with_signs(const Observer& observer, Use use) const;
  void update_one_by_one();
  // Classifies the triangles from number `first` in triangles_ on.
  void classify_one_by_one(std::size_t first, const Observer& observer, std::span<Orientation> out) const;

  const TriangleMesh& mesh_;
  SegmentTest test_;
  Pipeline pipeline_;
  std::vector<TriangleId> triangles_;        // of all groups
  std::vector<MovingNormal> normals_;        // [triangles], in the pipeline `published`
  std::vector<std::size_t> first_triangle_;  // [groups + 1]: where the triangles of a group begin
  std::vector<std::size_t> first_block_;     // [groups + 1]: where the blocks of a group begin
  std::vector<TriangleLanes> lanes_;         // [blocks]; a block with fewer triangles repeats its last one
  std::vector<Block> blocks_;
  std::optional<Motion> motion_;
};

// The rest is what scalar and vector code have in common, and private to them.

inline Orientation from_sign(int sign) {
  return sign > 0 ? Orientation::positive : sign < 0 ? Orientation::negative : Orientation::uncertain;
}

inline MovingVector between(const MovingPoint& from, const MovingPoint& to) {
  return {to.start - from.start, to.end - from.end};
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
inline constexpr double kProjectionError = 32 * kUnitRoundoff;

// Returns the corners that the test takes into account.
template <class Corner>
std::span<const Corner> looked_at(const Corner (&corner)[3], SegmentTest test) {
  return std::span<const Corner>(corner).first(test == SegmentTest::all_corners ? 3 : 1);
}

}  // namespace cscd::radial
