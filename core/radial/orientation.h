#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/base/pipeline.h"
#include "core/base/vec3.h"
#include "core/geometry/triple_product_lanes.h"
#include "core/mesh/motion.h"
#include "core/mesh/triangle_mesh.h"
#include "core/radial/orientation_class.h"

// Orientation of moving triangles towards a moving observer (Wong et al. 2013; section 3.1 of the 2014
// paper).
namespace cscd::radial {

// Classifies one triangle in double precision, straight from its vertices. This is the scalar twin of
// OrientationTable.
Orientation orientation(const MovingPoint (&corner)[3], const Observer& observer,
                        SegmentTest test = SegmentTest::all_corners, SignTest sign = SignTest::certain);

// Everything that the orientation of a triangle needs, gathered once an interval: the control vectors of its
// normal, one corner, and a bound on the rounding of the normal. Triangles are grouped by cluster in blocks
// of eight lanes, so that an observer is tried on a whole cluster in vector code.
class OrientationTable {
 public:
  // `groups` are the triangles of each cluster. In the pipeline `published`, one triangle is classified after
  // the other by the scalar twin. The classes are the same. The mesh must outlive the table.
  OrientationTable(const TriangleMesh& mesh, std::span<const std::vector<TriangleId>> groups,
                   SegmentTest test = SegmentTest::all_corners, SignTest sign = SignTest::certain,
                   Pipeline pipeline = Pipeline::today);

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
  SignTest sign_;
  Pipeline pipeline_;
  std::vector<TriangleId> triangles_;        // of all groups
  std::vector<MovingNormal> normals_;        // [triangles], in the pipeline `published`
  std::vector<std::size_t> first_triangle_;  // [groups + 1]: where the triangles of a group begin
  std::vector<std::size_t> first_block_;     // [groups + 1]: where the blocks of a group begin
  std::vector<TriangleLanes> lanes_;         // [blocks]; a block with fewer triangles repeats its last one
  std::vector<Block> blocks_;
  std::optional<Motion> motion_;
};

}  // namespace cscd::radial
