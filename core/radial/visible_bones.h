#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/base/vec3.h"
#include "core/mesh/rig.h"
#include "core/mesh/triangle_mesh.h"
#include "core/radial/distance_field.h"

namespace cscd::radial {

// For each vertex, the bones that heat it and the distance that they have in common. In compressed rows: the
// bones of vertex v are bones[offset[v] .. offset[v + 1]), in ascending order. A vertex that sees no bone has
// an empty row.
struct VisibleBones {
  std::vector<std::int32_t> offset;  // [vertices + 1]
  std::vector<BoneId> bones;
  std::vector<double> distance;  // [vertices]; without meaning for a vertex with an empty row

  std::span<const BoneId> of(std::size_t vertex) const {
    const auto first = static_cast<std::size_t>(offset[vertex]);
    return std::span(bones).subspan(first, static_cast<std::size_t>(offset[vertex + 1]) - first);
  }
};

// Returns the distance from a point to a bone, or the largest double if the distance cannot be computed.
double distance_to(const Bone& bone, const Vec3& point);

// Returns for each vertex the nearest bone that a straight line inside the body reaches from the vertex, and
// all bones that are equally near and reached too. In a connected component of the mesh without any such
// line, every vertex takes its nearest bones, seen or not.
VisibleBones find_visible_bones(const TriangleMesh& mesh, std::span<const Vec3> positions,
                                std::span<const Bone> bones, const DistanceField& field);

}  // namespace cscd::radial
