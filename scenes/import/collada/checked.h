#pragma once

#include <string>
#include <vector>

// Reads Collada files ahead of assimp.
namespace cscd::scenes {

struct CheckedCollada {
  std::string xml;  // in UTF-8
  // Vertices of no face and of no line, which assimp leaves out.
  std::size_t loose_vertices = 0;
  std::vector<std::string> notes;
};

// Checks a Collada file and puts it into the form that assimp reads rightly: a skin without bind_shape_matrix
// gets the identity, and the joint -1, which stands for the bind shape, becomes a joint of its own that does
// not move. Throws InputError, by the name of the element, for what assimp would take for something else:
// - text where a number has to be, numbers that are not finite, and arrays that are shorter than is said;
// - indices of vertices, joints and weights that do not exist, and weights below 0;
// - channels whose target does not exist, or is of a mesh itself; those of cameras and the like get a note;
// - morphs, holes in polygons, fans of triangles, and skewed nodes;
// - joints whose name fits several nodes, of which assimp takes the first;
// - keys more than 1/60 s apart that are not joined by straight lines, which assimp makes of all keys; those
//   that are nearer get a note.
CheckedCollada checked_collada(const std::string& bytes);

}  // namespace cscd::scenes
