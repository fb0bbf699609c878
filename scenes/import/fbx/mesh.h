#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scenes/character/character.h"
#include "scenes/import/fbx/objects.h"

namespace cscd::scenes::fbx {

// The surface of a Geometry object. Its vertices are the file's control points.
struct Mesh {
  std::vector<Vec3> positions;
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::size_t lines = 0;        // polygons of fewer than three corners, which are left out
  std::size_t overlapping = 0;  // flat polygons that overlap themselves
};

// Reads a Geometry object and cuts its polygons into triangles. Throws InputError for damage, for polygons
// that cannot be cut, and for counts above the limits.
Mesh read_mesh(const Object& geometry, const CharacterLimits& limits);

// Returns a list of points or of displacements: an array with three numbers for each.
std::vector<Vec3> read_points(const Element& element, std::size_t most, const std::string& what);

}  // namespace cscd::scenes::fbx
