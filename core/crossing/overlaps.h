#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/base/vec3.h"
#include "core/crossing/curves.h"
#include "core/crossing/fragments.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// What is nearer to a sheet than this share of the largest coordinate may lie on it, but for rounding.
inline constexpr double kOnSheet = 1e-12;

// How deep a region lies beyond the other sheet.
struct CrossingDepth {
  // The largest distance to the other sheet, up to rounding, of a vertex or of a point between two piercings
  // of an edge; and what no point of the region exceeds.
  double lower = 0, upper = 0;
  Vec3 point = Vec3::Zero();  // the deepest such point
  VertexId vertex{-1};        // -1 between two piercings
  TriangleId nearest{-1};  // the triangle of the other sheet that is nearest to it; -1 where nothing is known
  Vec3 out = Vec3::Zero();  // the way from the point to the nearest point of that triangle
};

// What crossing curves cut off one sheet: vertices that lie on the other side of the other sheet.
//
// A curve lies on the two sheets that cross in it. Its course on one of them is an *image* of the curve:
// image 2 c + s is that of curve c on sheet s, which is 0 or 1. Each vertex belongs to the image that is
// nearest along edges. Its depth is the distance to the skin that was gone through: to all triangles of the
// other component that meet this one or have a vertex in it, and to the flat walls in which these lie. Within
// one component, it is the distance to what the vertex's own curve cuts off: to all triangles that have a
// vertex there, or that the curve runs through. A component that lies in another one altogether, and touches
// its wall, has no curve.
struct CrossingRegion {
  std::int32_t own = 0, other = 0;  // the components of this sheet and of the other
  // On which side of the curves the region lies. Behind the faces of the other sheet, inside a closed body;
  // where one closed surface crosses itself, it winds once or more around what is just before the region's
  // faces. Before them, where that surface is turned inside out and winds -1 times or less, or where all
  // faces of a closed component look inward. The smaller side, where the other sheet is open, or where it
  // cannot be decided how often the surface winds around the region.
  enum class Side : std::uint8_t { behind, before, smaller };
  Side side = Side::behind;
  // What the curves cut off the other sheet is not bounded: a curve ends on it, or has no vertex of it
  // beyond. The distance is then that to the other component, or within one component to the curves'
  // triangles alone; there the depth is an upper bound, and `lower` is 0.
  bool other_is_open = false;
  std::vector<std::int32_t> images;  // that bound it; sorted
  std::vector<VertexId> vertices;    // from the curves inwards
  std::vector<std::int32_t> image;   // [vertices]
  std::vector<Vec3> way;  // [vertices], from each to the nearest point of the other sheet; if asked for
  double area = 0;        // a third of each triangle for each of its corners here
  CrossingDepth depth;
};

// Curves and the regions that they cut off, as far as they hang together: two pieces of the surface that lie
// in each other.
struct Overlap {
  std::vector<std::int32_t> curves;
  // Without a curve: the pairs of triangles, one of each piece, in which one piece touches the wall of the
  // other from within.
  std::vector<std::array<TriangleId, 2>> touching;
  std::vector<CrossingRegion> regions;  // deepest first
  CrossingDepth depth;  // of the deepest region, or of an edge where no vertex lies in the other sheet
};

struct Overlaps {
  CrossingCurves crossing;
  std::vector<Overlap> overlaps;  // deepest first
};

// Calls take(segment) for each pair of triangles, one of each sheet, through which the curves of an overlap
// run, or in which its pieces touch.
template <class Take>
void for_each_segment(const CrossingCurves& all, const Overlap& overlap, const Take& take) {
  for (const std::int32_t curve : overlap.curves)
    for (const auto& segment : all.curves[static_cast<std::size_t>(curve)].segments) take(segment);
  for (const auto& segment : overlap.touching) take(segment);
}

// Finds what lies in what, one pose after another of one mesh. Where nothing crosses, a call does nothing.
class OverlapFinder {
 public:
  explicit OverlapFinder(const TriangleMesh& mesh) : mesh_(mesh), marks_(mesh) {}  // `mesh` must outlive it

  // `pairs` are all pairs of triangles that meet in the pose, sorted. With `each_way` every vertex of every
  // region gets its way out. The answer does not depend on the unit of length: where all coordinates are
  // multiplied by a power of two, lengths are multiplied by the same power to the last digit. Where they
  // become subnormal they are rounded, and CrossingDepth::upper is rounded up.
  Overlaps find(std::span<const Vec3> positions, std::span<const CrossingPair> pairs, bool each_way = false);

 private:
  friend class PoseOverlaps;
  const TriangleMesh& mesh_;
  CurveMarks marks_;
  std::vector<std::uint32_t> listed_, visited_;  // [triangles], [vertices], in which list last
  std::uint32_t lists_ = 0;
};

}  // namespace cscd
