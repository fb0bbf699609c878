#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "core/base/ids.h"
#include "core/base/vec3.h"
#include "core/crossing/sheet_distance.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// The skin of each component that another one has gone through, in one pose: the triangles that meet the
// other one or have a vertex in it, and the flat walls in which these lie. What stands on one triangle of a
// wall is as far from the wall as from the nearest of its triangles.
class Skins {
 public:
  // A triangle within `on_plane` of the plane of one beside it lies in the same wall. Mesh and positions must
  // outlive the object.
  Skins(const TriangleMesh& mesh, std::span<const Vec3> positions, double on_plane)
      : mesh_(mesh), positions_(positions), on_plane_(on_plane) {}

  // Adds a triangle of the component `other` to what `own` has gone through. All are added before spread().
  void add(std::int32_t own, std::int32_t other, TriangleId triangle) {
    triangles_[{own, other}].push_back(triangle);
  }
  void spread();
  // Distances to what `own` has gone through of `other`, of which there must be something.
  const SheetDistance& to(std::int32_t own, std::int32_t other);

 private:
  void spread(std::vector<TriangleId>& triangles) const;

  const TriangleMesh& mesh_;
  std::span<const Vec3> positions_;
  double on_plane_;
  // By both components.
  std::map<std::pair<std::int32_t, std::int32_t>, std::vector<TriangleId>> triangles_;
  std::map<std::pair<std::int32_t, std::int32_t>, SheetDistance> distances_;
};

}  // namespace cscd
