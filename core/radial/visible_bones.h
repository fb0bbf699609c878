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

// For each vertex the bones that heat it and their common distance. Compressed rows: those of vertex v are
// bones[offset[v] .. offset[v + 1]), in ascending order; none for a vertex that sees no bone.
struct VisibleBones {
  std::vector<std::int32_t> offset;
  std::vector<BoneId> bones;
  std::vector<double> distance;  // one a vertex; meaningless where the row is empty

  std::span<const BoneId> of(std::size_t vertex) const {
    const auto first = static_cast<std::size_t>(offset[vertex]);
    return std::span(bones).subspan(first, static_cast<std::size_t>(offset[vertex + 1]) - first);
  }
};

// The distance from a point to a bone; the largest double where it cannot be computed.
double distance_to(const Bone& bone, const Vec3& point);

// The nearest bone that a straight line inside the body reaches from the vertex, and those equally near. In a
// component of the mesh without any such line, every vertex takes its nearest bones unseen.
VisibleBones find_visible_bones(const TriangleMesh& mesh, std::span<const Vec3> positions,
                                std::span<const Bone> bones, const DistanceField& field);

}  // namespace cscd::radial
