#pragma once

#include <span>

#include "core/base/ids.h"
#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// Sides of planes, +1 or -1, that are never 0. Every vertex v stands for x_v + t (r_v - x_v) with an
// infinitely small t > 0, where r_v is a fixed point that depends on the number of v alone. So an edge that
// touches a face, or lies in the face's plane, either passes through or does not, and all answers about one
// pose agree with each other: they are those about one surface in general position (simulation of simplicity,
// Edelsbrunner and Muecke 1990, with a perturbation that is drawn).
class GenericSides {
 public:
  explicit GenericSides(std::span<const Vec3> positions) : positions_(positions) {}

  // The side of the plane a, b, c on which p lies: +1 behind, so that a, b and c run clockwise seen from p.
  // The four vertices must differ.
  int side(VertexId a, VertexId b, VertexId c, VertexId p);
  // Whether the edge passes through the face, if its ends are known to lie on two sides of the face's plane.
  // The two must share no vertex.
  bool passes_inside(const Edge& edge, const Triangle& face);

  // How often floating point could not tell, and how often the exact answer for t = 0 was "in the plane".
  std::size_t degenerate() const { return degenerate_; }

 private:
  std::span<const Vec3> positions_;
  std::size_t degenerate_ = 0;
};

}  // namespace cscd
