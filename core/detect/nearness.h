#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/hierarchy/bounds.h"
#include "core/hierarchy/tree.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// Lengths below are in mean edge lengths of the reference pose.
//
// Two triangles count as apart on the surface when every path along edges of the reference pose, from any
// corner of one to any of the other, is longer than this; triangles of different components always do. Not
// counted in rings, as those stand close on some meshes. Four times kNear: on the reference pose itself only
// a fold or a wedge sharper than about 29 degrees brings two such triangles that near, never one smooth limb,
// however thin.
inline constexpr double kApartOnSurface = 8;
// Closer than this is a near-contact.
inline constexpr double kNear = 2;
// Larger distances are not told apart: from here on, triangles a little more than kApartOnSurface from each
// other on flat surface begin to be the closest ones, and say nothing.
inline constexpr double kFarthest = 4;

// Finds the closest two triangles of a frame that are apart on the surface.
class Nearness {
 public:
  // Throws InputError if all edges of the reference pose have length 0. About 2 s and 100 MB at 48,000
  // triangles.
  Nearness(const TriangleMesh& mesh, std::span<const Vec3> reference);

  struct Pair {
    TriangleId a, b;
    double distance;  // in mean edge lengths; 0 where they cross
  };
  // Nothing if no two are closer than kFarthest. Branch and bound over the hierarchy.
  std::optional<Pair> closest(std::span<const Vec3> positions);

  double mean_edge() const { return mean_edge_; }

 private:
  struct Neighbour {  // a vertex within kApartOnSurface, and the path to it
    VertexId vertex;
    float path;
  };
  // Any corner of the node's triangles is within `reach` of `centre` along the surface.
  struct Extent {
    VertexId centre{0};
    float reach;
  };
  void find_neighbours(std::span<const Vec3> reference);
  void find_extents(std::span<const Vec3> reference);
  float path(VertexId a, VertexId b) const;
  bool wholly_adjacent(NodeIndex a, NodeIndex b) const;
  bool adjacent(TriangleId a, TriangleId b) const;
  struct Search;

  const TriangleMesh& mesh_;
  Tree tree_;
  SweptBounds bounds_;
  double mean_edge_ = 0;
  std::vector<std::size_t> first_neighbour_;  // of vertex v: neighbours_[first[v] .. first[v + 1])
  std::vector<Neighbour> neighbours_;         // of larger index, in order
  std::vector<Extent> extents_;               // of each node
  std::optional<Pair> last_;                  // of the frame before: a first bound for the next
};

}  // namespace cscd
