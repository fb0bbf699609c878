#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/hierarchy/bounds.h"
#include "core/hierarchy/tree.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::scenes {

// Lengths in this file are in mean edge lengths of the reference pose, unless stated otherwise.
//
// Two triangles are *apart on the surface* if every path along edges of the reference pose, from any corner
// of one to any corner of the other, is longer than this. Triangles of different components always are.
// Lengths are used, and not rings of triangles, because many rings fit into a short length on some meshes.
//
// The value is four times kNear: in the reference pose itself, only a fold or a wedge sharper than about 29
// degrees brings two such triangles within kNear of each other; a smooth limb, however thin, does not.
inline constexpr double kApartOnSurface = 8;
// Two triangles that are apart on the surface and closer than this in space are a near-contact.
inline constexpr double kNear = 2;
// Larger distances are not measured. From this distance on, the closest triangles would be
// neighbours on a flat piece of the surface, a little more than kApartOnSurface from each other, and
// they say nothing about contact.
inline constexpr double kFarthest = 4;

// Finds the closest two triangles of a frame among those that are apart on the surface.
class Nearness {
 public:
  // Measures the paths along the surface in the reference pose (`reference`: [vertices]). This takes about 2
  // seconds and 100 MB for a mesh of 48,000 triangles. `mesh` must outlive the object. Throws InputError if
  // all edges of the reference pose have length 0.
  Nearness(const TriangleMesh& mesh, std::span<const Vec3> reference);

  struct Pair {
    TriangleId a, b;
    double distance;  // in mean edge lengths; 0 where they cross
  };
  // Returns the closest two triangles in these positions ([vertices]), or nullopt if no two are closer than
  // kFarthest. The search is branch and bound over the hierarchy.
  std::optional<Pair> closest(std::span<const Vec3> positions);

  // The mean edge length of the reference pose, in lengths of the scene.
  double mean_edge() const { return mean_edge_; }

 private:
  struct Neighbour {  // a vertex within kApartOnSurface, and the length of the path to it
    VertexId vertex;
    float path;
  };
  // Every corner of a node's triangles is within `reach` of `centre` along the surface.
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
  std::vector<Neighbour> neighbours_;  // neighbours with a larger index than the vertex, in ascending order
  std::vector<Extent> extents_;        // [nodes]
  std::optional<Pair> last_;           // the answer for the last frame: a first bound for the next
};

}  // namespace cscd::scenes
