#include "scenes/cloth/worn_parts.h"

#include <algorithm>

namespace cscd::scenes {
namespace {

// The vertices and triangles of all triangles for which `wanted` is true.
template <class Wanted>
SurfacePart part(const TriangleMesh& mesh, const Wanted& wanted) {
  std::vector<bool> taken(mesh.vertex_count(), false);
  SurfacePart out;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const TriangleId triangle{static_cast<int>(t)};
    if (!wanted(triangle)) continue;
    out.triangles.push_back(mesh.corners(triangle));
    for (const VertexId corner : mesh.corners(triangle)) taken[+corner] = true;
  }
  std::vector<VertexId> number(mesh.vertex_count(), VertexId{-1});
  for (std::size_t v = 0; v < taken.size(); ++v) {
    if (!taken[v]) continue;
    number[v] = VertexId{static_cast<int>(out.in_shape.size())};
    out.in_shape.push_back(VertexId{static_cast<int>(v)});
  }
  for (Triangle& triangle : out.triangles)
    for (VertexId& corner : triangle) corner = number[+corner];
  return out;
}

}  // namespace

std::vector<Vec3> SurfacePart::of(std::span<const Vec3> all) const {
  std::vector<Vec3> own;
  own.reserve(in_shape.size());
  for (const VertexId v : in_shape) own.push_back(all[+v]);
  return own;
}

WornParts worn_parts(const Shape& shape) {
  const TriangleMesh mesh(shape.triangles, shape.positions.size());
  std::vector<bool> is_cloth(static_cast<std::size_t>(mesh.component_count()),
                             std::ranges::all_of(shape.weights, &JointWeights::has_bones));
  const auto component = [&](TriangleId t) { return static_cast<std::size_t>(mesh.component(t)); };
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    for (const VertexId corner : shape.triangles[t])
      if (!shape.weights[+corner].has_bones()) is_cloth[component(TriangleId{static_cast<int>(t)})] = true;
  return {part(mesh, [&](TriangleId t) { return is_cloth[component(t)]; }),
          part(mesh, [&](TriangleId t) { return !is_cloth[component(t)]; })};
}

}  // namespace cscd::scenes
