#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::scenes {

// One connected component of a surface as a mesh of its own.
struct Piece {
  std::vector<TriangleId> triangles;  // of the whole
  std::vector<VertexId> vertices;     // of the whole, by the piece's own numbers
  TriangleMesh mesh;
};

// In the order of TriangleMesh::component.
std::vector<Piece> pieces_of(const TriangleMesh& whole);

// The volume that a closed, consistently oriented piece encloses: positive if it faces outward. `positions`
// are those of the whole.
double signed_volume(const Piece& piece, std::span<const Vec3> positions);

// Which components to use: "auto" is the closed, consistently oriented one with the most triangles, or the
// one with the most where none is closed; "largest" the one with the most; "all"; or a number. Throws
// InputError for anything else, and for a component that does not exist.
std::vector<std::size_t> choose_pieces(std::span<const Piece> pieces, const std::string& which);

}  // namespace cscd::scenes
