#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/base/vec3.h"
#include "core/detect/step.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// An edge that passes through a face: where a crossing curve goes from one pair of triangles to the next.
struct Piercing {
  EdgeId edge;
  TriangleId face;
  VertexId behind, before;  // the ends of the edge: behind the face, and before it
  Vec3 point;               // rounded
  bool tied;  // it depends on how ties are broken (GenericSides): it may pass through by nothing measurable
};

// A curve in which a surface crosses itself. It runs on two *sheets* at once: segment i is where the
// triangles segments[i][0] and segments[i][1] cross, and neighbouring segments have neighbouring triangles,
// so all triangles [0] are one sheet along the curve, and all triangles [1] the other.
struct CrossingCurve {
  // How a curve ends: nowhere; at the border of a sheet; at a vertex that both sheets share, where the
  // surface turns inside out; at an edge of three or more triangles.
  enum class End : std::uint8_t { closed, border, vertex, branch };
  struct Node {
    std::int32_t piercing;    // its index, or -1 at a shared vertex
    std::uint8_t edge_sheet;  // which sheet the piercing edge belongs to
    VertexId vertex;          // the shared vertex, or -1
  };

  std::vector<std::array<TriangleId, 2>> segments;
  std::vector<Node>
      nodes;  // the ends of segments in their order: one more than segments, or as many if closed
  End first = End::closed, last = End::closed;

  bool closed() const { return first == End::closed; }
};

struct CrossingCurves {
  std::vector<Piercing> piercings;
  std::vector<CrossingCurve> curves;
  // Pairs of triangles that meet without passing through each other: they touch. They are part of no curve.
  std::size_t touching = 0;
  // Sides that are decided by the infinitely small motion of GenericSides: vertices that lie exactly in the
  // plane of a face, and edges that meet. Where this is not 0, curves are those of a surface moved by nothing
  // that can be measured.
  std::size_t degenerate = 0;

  // Where a node of a curve lies, rounded.
  Vec3 point(const CrossingCurve::Node& node, std::span<const Vec3> positions) const {
    return node.piercing >= 0 ? piercings[static_cast<std::size_t>(node.piercing)].point
                              : positions[+node.vertex];
  }
};

// Joins the pairs of triangles that cross in a pose to curves. `pairs` are all of them, sorted. Which pair
// follows which is exact. Points are rounded, and are computed from `scaled`: the positions in a scale in
// which products of four lengths neither overflow nor vanish (OverlapFinder::find). The points are in that
// scale, too.
CrossingCurves find_curves(const TriangleMesh& mesh, std::span<const Vec3> positions,
                           std::span<const CrossingPair> pairs, std::span<const Vec3> scaled);

}  // namespace cscd
