#include "core/radial/segmentation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "core/base/error.h"
#include "core/radial/distance_field.h"
#include "core/radial/heat_weights.h"
#include "core/radial/visible_bones.h"

// Each triangle goes to the bone that heats it most (Wong, Lin, Wang, Hung, Huang, "Dynamic Radial View Based
// Culling for Continuous Self-Collision Detection", I3D 2014, section 4.1, which takes this from Wong et al.,
// "Radial View Based Culling", SIGGRAPH 2013). Neither paper prints the diffusion. This is the bone heat of
// Baran and Popovic 2007 that both build upon (heat_weights.cpp). The method of 2014 differs from the method
// of 2013 in its options alone: it smooths first and takes a coarser grid.
//
// The cost is that of distance_field.cpp, visible_bones.cpp and heat_weights.cpp. Memory does not grow with
// vertices x bones.
namespace cscd::radial {

std::vector<Vec3> smoothed(const TriangleMesh& mesh, std::span<const Vec3> positions, int passes) {
  std::vector<Vec3> current(positions.begin(), positions.end());
  std::vector<int> neighbours(current.size(), 0);
  for (const Edge& e : mesh.edges()) {
    ++neighbours[+e[0]];
    ++neighbours[+e[1]];
  }
  std::vector<Vec3> sum(current.size());
  for (int pass = 0; pass < passes; ++pass) {
    std::fill(sum.begin(), sum.end(), Vec3::Zero());
    for (const Edge& e : mesh.edges()) {
      sum[+e[0]] += current[+e[1]];
      sum[+e[1]] += current[+e[0]];
    }
    for (std::size_t v = 0; v < current.size(); ++v)
      if (neighbours[v] > 0) current[v] = (current[v] + sum[v] / neighbours[v]) / 2;
  }
  return current;
}

namespace {

// Sums of three weights that differ by less than this are equal. The number is some hundred times the
// rounding of the solver, so that a symmetric mesh gets the same answer from every compiler.
constexpr double kTie = 1e-9;

// The surface and the bones, shifted and scaled so that the surface's box has its middle at the origin and a
// longest side of 1. This keeps all lengths in the range in which distances and heat can be computed.
struct Scene {
  std::vector<Vec3> positions;
  std::vector<Bone> bones;
};

Scene normalised(const TriangleMesh& mesh, std::span<const Vec3> positions, std::span<const Bone> bones) {
  const Eigen::AlignedBox3d box = surface_box(mesh, positions);
  const Vec3 middle = box.min() + box.sizes() / 2;
  const double longest = box.sizes().maxCoeff();
  if (!std::isfinite(longest))
    throw InputError("reference pose: positions are too far apart for double precision; use a larger unit");
  const double unit = longest > 0 ? longest : 1;
  const auto map = [&](const Vec3& p) { return Vec3((p - middle) / unit); };
  Scene scene;
  scene.positions.reserve(positions.size());
  for (const Vec3& p : positions) scene.positions.push_back(map(p));
  for (const Bone& b : bones) scene.bones.push_back({map(b.head), map(b.tail)});
  return scene;
}

BoneId nearest_by_distance(const Triangle& triangle, const Scene& scene) {
  const Vec3 centroid =
      (scene.positions[+triangle[0]] + scene.positions[+triangle[1]] + scene.positions[+triangle[2]]) / 3;
  BoneId nearest{0};
  double least = distance_to(scene.bones[0], centroid);
  for (std::size_t b = 1; b < scene.bones.size(); ++b)
    if (const double d = distance_to(scene.bones[b], centroid); d < least) {
      least = d;
      nearest = BoneId{static_cast<std::int32_t>(b)};
    }
  return nearest;
}

}  // namespace

std::vector<BoneId> nearest_bone_by_heat(const TriangleMesh& mesh, std::span<const Vec3> reference,
                                         const Rig& rig, const HeatOptions& options) {
  assert(reference.size() == mesh.vertex_count());
  if (rig.reference.empty())
    throw InputError("segmentation by bones needs at least one bone; give the mesh a rig");

  require_finite(reference, "reference pose");

  Scene scene = normalised(mesh, reference, rig.reference);
  scene.positions = smoothed(mesh, scene.positions, options.smoothing_passes);
  const DistanceField field = make_distance_field(mesh, scene.positions, options.grid_resolution);
  const VisibleBones visible = find_visible_bones(mesh, scene.positions, scene.bones, field);

  constexpr BoneId none{-1};
  std::vector<BoneId> bone_of(mesh.triangle_count(), none);
  std::vector<double> most(mesh.triangle_count(), 0);
  const auto keep_the_most = [&](BoneId bone, const Eigen::Ref<const Eigen::VectorXd>& weights) {
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      const Triangle& c = mesh.triangles()[t];
      const double sum = weights[static_cast<Eigen::Index>(c[0])] + weights[static_cast<Eigen::Index>(c[1])] +
                         weights[static_cast<Eigen::Index>(c[2])];
      if (!std::isfinite(sum) || sum <= most[t] + kTie) continue;
      most[t] = sum;
      bone_of[t] = bone;
    }
  };
  if (!diffuse_heat(mesh, scene.positions, visible, keep_the_most))
    bone_of.assign(mesh.triangle_count(), none);

  // A triangle without usable heat goes to the nearest bone.
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    if (bone_of[t] == none) bone_of[t] = nearest_by_distance(mesh.triangles()[t], scene);
  return bone_of;
}

}  // namespace cscd::radial
