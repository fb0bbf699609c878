#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/vec3.h"
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

// How the sign of the cubic behind a class is told. `certain` is the proof; the others are there to measure
// what certainty costs and what it leaves undecided. A plain sign, without its error bound, proves nothing
// (rule error-bound, core/soundness.md). `halved` cuts [0, 1] once where the whole is not certain.
enum class SignTest { certain, plain, halved };

// Classifies one triangle in double precision, straight from its vertices. This is the scalar twin of
// OrientationTable.
Orientation orientation(const MovingPoint (&corner)[3], const Observer& observer,
                        SegmentTest test = SegmentTest::all_corners, SignTest sign = SignTest::certain);

// Everything that the orientation of a triangle needs, gathered once an interval: the control vectors of its
// normal, one corner, and a bound on the rounding of the normal. Triangles are grouped by cluster in blocks
// of eight lanes, so that an observer is tried on a whole cluster in vector code.
class OrientationTable {
 public:
  // `groups` are the triangles of each cluster.
  OrientationTable(const TriangleMesh& mesh, std::span<const std::vector<TriangleId>> groups,
                   SegmentTest test = SegmentTest::all_corners, SignTest sign = SignTest::certain);

  // Begins an interval. The positions of `motion` must stay in place until the last classification of the
  // interval.
  void update(const Motion& motion);

  // Classifies all triangles of one group, in the group's order.
  void classify(std::size_t group, const Observer& observer, std::span<Orientation> out) const;
  // Classifies one triangle; `member` is its place in the group.
  Orientation classify(std::size_t group, std::size_t member, const Observer& observer) const;

 private:
  struct TriangleLanes {
    std::array<TriangleId, kLanes> triangle;
    std::array<VertexLanes, 3> corner;
  };
  struct Block {
    NormalLanes normal;
    VectorLanes corner;  // the first corner
  };
  template <class Use>
  void with_signs(const Observer& observer, Use use) const;

  SegmentTest test_;
  SignTest sign_;
  std::vector<std::size_t> first_block_;  // [groups + 1]: where the blocks of a group begin
  std::vector<TriangleLanes> lanes_;      // [blocks]; a block with fewer triangles repeats its last one
  std::vector<Block> blocks_;
  std::optional<Motion> motion_;
};

}  // namespace cscd::radial
