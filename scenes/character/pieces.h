#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::scenes {

// One connected component of a surface, as a mesh of its own. The surface that it is taken
// from is called the whole.
struct Piece {
  std::vector<TriangleId> triangles;  // numbers in the whole
  std::vector<VertexId> vertices;     // [vertices of `mesh`]; their numbers in the whole
  TriangleMesh mesh;
};

// Returns all components of a surface, in the order of TriangleMesh::component.
std::vector<Piece> pieces_of(const TriangleMesh& whole);

// Returns the volume that a closed, consistently oriented piece encloses, in cubic lengths of the scene:
// positive if the piece faces outward. `positions` holds the positions of the whole's vertices.
double signed_volume(const Piece& piece, std::span<const Vec3> positions);

// Returns the numbers of the components to use. "all" chooses every component, "largest" the component with
// the most triangles, and "auto" the closed, consistently oriented component with the most triangles; where
// no component is closed, "auto" chooses the largest. A number chooses that component. Throws InputError
// for any other word and for the number of a component that does not exist.
std::vector<std::size_t> choose_pieces(std::span<const Piece> pieces, const std::string& which);

}  // namespace cscd::scenes
