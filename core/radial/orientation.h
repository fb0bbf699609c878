#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/geometry/bernstein.h"
#include "core/mesh/motion.h"
#include "core/mesh/triangle_mesh.h"

// Orientation of moving triangles towards a moving observer (Wong et al. 2013; section 3.1 of the paper).
//
// positive: the normal makes a positive dot product with the ray through every point of the triangle at every
// t in [0, 1]; negative likewise; uncertain: anything that is not proven. Bits, so that a set of classes is a
// mask.
namespace cscd::radial {

enum class Orientation : std::uint8_t { positive = 1, negative = 2, uncertain = 4 };

// A point, or a segment along which the viewing position slides; the ends move in straight lines.
struct Observer {
  MovingPoint head, tail;
  bool is_segment;

  static Observer point(const MovingPoint& p) { return {p, p, false}; }
  static Observer segment(const MovingPoint& head, const MovingPoint& tail) { return {head, tail, true}; }
};

// One triangle in double precision, straight from the vertices: the scalar twin of OrientationTable.
Orientation orientation(const MovingPoint (&corner)[3], const Observer& observer);

// What the orientation of every triangle needs, gathered once an interval: control vectors of the normal, one
// corner, and a bound of the normal's rounding. Triangles stand grouped by cluster in blocks of eight lanes,
// so that an observer is tried on a whole cluster in vector code.
class OrientationTable {
 public:
  static constexpr std::size_t kLanes = 8;

  // `groups`: the triangles of each cluster.
  OrientationTable(const TriangleMesh& mesh, std::span<const std::vector<TriangleId>> groups);

  // The vertices of `motion` must stay in place until the last classification of the interval.
  void update(const Motion& motion);

  // Classes of all triangles of one group, in the group's order.
  void classify(std::size_t group, const Observer& observer, std::span<Orientation> out) const;
  // The class of one triangle: `member` is its place in the group.
  Orientation classify(std::size_t group, std::size_t member, const Observer& observer) const;

 private:
  using Row = std::array<double, kLanes>;
  struct alignas(64) Block {
    Row normal[3][3];  // Bernstein control vectors n0, 2 n1, n2 of the normal, by component
    Row corner[2][3];  // the first corner at both ends
    Row area;          // product of the largest edge components: scale of the error bound
  };
  const TriangleMesh& mesh_;
  std::vector<std::size_t> first_block_;  // of each group, one more at the end
  std::vector<std::array<std::int32_t, kLanes>>
      lanes_;  // triangles of each block; a short one repeats its last
  std::vector<Block> blocks_;
  std::optional<Motion> motion_;
};

}  // namespace cscd::radial
