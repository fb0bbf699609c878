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

// The bones that heat each vertex, and their common distance, in compressed rows: the bones of vertex v are
// bones[offset[v] .. offset[v + 1]), ascending. A vertex that sees no bone has none.
struct VisibleBones {
  std::vector<std::int32_t> offset;  // [vertices + 1]
  std::vector<BoneId> bones;
  std::vector<double> distance;  // [vertices]; without meaning for a vertex with an empty row

  std::span<const BoneId> of(std::size_t vertex) const {
    const auto first = static_cast<std::size_t>(offset[vertex]);
    return std::span(bones).subspan(first, static_cast<std::size_t>(offset[vertex + 1]) - first);
  }
};

// Returns the distance from a point to a bone, or the largest double where it cannot be computed.
double distance_to(const Bone& bone, const Vec3& point);

// Finds for each vertex the nearest bone that a straight line inside the body reaches, and the bones that are
// equally near. In a component of the mesh without any such line, every vertex takes its nearest bones
// unseen.
VisibleBones find_visible_bones(const TriangleMesh& mesh, std::span<const Vec3> positions,
                                std::span<const Bone> bones, const DistanceField& field);

}  // namespace cscd::radial
