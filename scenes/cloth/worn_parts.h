#pragma once

#include <span>
#include <vector>

#include "scenes/shape/shape.h"

namespace cscd::scenes {

// Some components of a shape's surface, whose vertices are numbered anew.
struct SurfacePart {
  std::vector<VertexId> in_shape;   // [vertices]: their numbers in the shape, in ascending order
  std::vector<Triangle> triangles;  // [triangles]

  // The part's entries of a list over all vertices of the shape.
  std::vector<Vec3> of(std::span<const Vec3> all) const;
};

// A shape's cloth, and the body that wears the cloth. Components in which some vertex has no bones are cloth.
// A shape in which every vertex has bones, or none has, is all cloth and has an empty body.
struct WornParts {
  SurfacePart cloth, body;
};
WornParts worn_parts(const Shape& shape);

}  // namespace cscd::scenes
