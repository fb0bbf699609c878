#pragma once

#include <array>
#include <cstddef>

#include "core/mesh/triangle_mesh.h"
#include "scenes/shape/shape.h"

namespace cscd::scenes {

// The surface of a box of a x b x c cells, with nodes at whole coordinates and square cells between them. A
// face lies across an axis, at its lower or upper end. On a face, u and v are the other two axes in the
// order x, y, z.
class BoxGrid {
 public:
  using Node = std::array<int, 3>;
  struct Face {
    int axis;    // 0, 1, 2
    bool upper;  // true at the upper end of the axis
    int u() const { return axis == 0 ? 1 : 0; }
    int v() const { return axis == 2 ? 1 : 2; }
  };

  explicit BoxGrid(std::array<int, 3> cells) : cells_(cells) {}

  const std::array<int, 3>& cells() const { return cells_; }
  std::size_t vertex_count() const;  // 2 (ab + bc + ca) + 2
  VertexId at(const Node& node) const;
  static constexpr std::array<Face, 6> faces() {
    return {{{0, false}, {0, true}, {1, false}, {1, true}, {2, false}, {2, true}}};
  }
  // The node at u, v of a face.
  Node node(const Face& face, int u, int v) const;
  // The corners of the cell from (u, v) to (u + 1, v + 1), counter-clockwise seen from outside.
  std::array<VertexId, 4> cell(const Face& face, int u, int v) const;

  // Calls visit(node, vertex) for every node, in order of the vertices.
  template <class Visit>
  void for_each_node(const Visit& visit) const {
    for (int z = 0; z <= cells_[2]; ++z)
      for (int y = 0; y <= cells_[1]; ++y)
        for (int x = 0, step = y > 0 && y < cells_[1] && z > 0 && z < cells_[2] ? cells_[0] : 1;
             x <= cells_[0]; x += step)
          visit(Node{x, y, z}, at({x, y, z}));
  }

 private:
  std::array<int, 3> cells_;
};

// The two triangles of a quad.
inline void append_quad(const std::array<VertexId, 4>& corner, std::vector<Triangle>& triangles) {
  triangles.push_back({corner[0], corner[1], corner[2]});
  triangles.push_back({corner[0], corner[2], corner[3]});
}

// A box with sharp edges and a grid on all faces, on a chain of bones along its z axis.
struct BoxParameters {
  std::array<int, 3> cells = {32, 32, 82};  // along x, y, z, at least 1 each
  Vec3 size = Vec3(4, 4, 10.25);            // the box stands on the xy-plane, centred about the z axis
  int bones = 20;                           // of equal lengths, from the bottom to the top
};

// Builds the box. For a x b x c cells it has 2 (ab + bc + ca) + 2 vertices and 4 (ab + bc + ca) triangles,
// and genus 0. A vertex follows at most three bones, by quadratic B-splines along the axis. Throws
// InputError for sizes without volume and for more than 2^27 vertices.
Shape box(const BoxParameters& parameters);

ShapeRow box_row();

}  // namespace cscd::scenes
