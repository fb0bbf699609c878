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

// A point, or a segment along which the viewing position slides: each point of a triangle is viewed from the
// nearest point of the segment. The ends of the segment move in straight lines.
struct Observer {
  MovingPoint head, tail;
  bool is_segment;

  static Observer point(const MovingPoint& p) { return {p, p, false}; }
  static Observer segment(const MovingPoint& head, const MovingPoint& tail) { return {head, tail, true}; }
};

// The corners that decide how a triangle is seen from a segment. All three are needed (rule three-vertices,
// core/soundness.md). The paper takes one arbitrary corner, which proves nothing; `first_corner` is there to
// measure what that saves and what it loses.
enum class SegmentTest { all_corners, first_corner };

// How the sign of the cubic behind a class is decided. Only a `certain` sign, which exceeds its error bound,
// is used outside of the ablation. The other two are there to measure what certainty costs and what it leaves
// undecided. A `plain` sign ignores the error bound and proves nothing (rule error-bound). A `halved` sign is
// certain: where [0, 1] as a whole gives no sign, the interval is cut once at its middle.
enum class SignTest { certain, plain, halved };

// Returns the class of one triangle, computed in double precision from its three moving corners. The scalar
// twin of OrientationTable.
Orientation orientation(const MovingPoint (&corner)[3], const Observer& observer,
                        SegmentTest test = SegmentTest::all_corners, SignTest sign = SignTest::certain);

// Classifies all triangles of a cluster towards an observer in vector code. Gathers once an interval what the
// classes of every triangle need: the control vectors of its normal, one corner, and a bound of the normal's
// rounding. Triangles stand in blocks of eight lanes, grouped by cluster.
class OrientationTable {
 public:
  // `groups` holds the triangles of each cluster, [clusters][triangles of the cluster].
  OrientationTable(const TriangleMesh& mesh, std::span<const std::vector<TriangleId>> groups,
                   SegmentTest test = SegmentTest::all_corners, SignTest sign = SignTest::certain);

  // Begins an interval. The positions of `motion` must stay in place until the last classification of the
  // interval.
  void update(const Motion& motion);

  // Writes the classes of all triangles of one group to `out`, [triangles of the group].
  void classify(std::size_t group, const Observer& observer, std::span<Orientation> out) const;
  // Returns the class of one triangle; `member` is its index in the group.
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
  std::vector<std::size_t> first_block_;  // [groups + 1]
  std::vector<TriangleLanes> lanes_;      // [blocks]; a block with fewer triangles repeats its last
  std::vector<Block> blocks_;             // [blocks]
  std::optional<Motion> motion_;
};

}  // namespace cscd::radial
