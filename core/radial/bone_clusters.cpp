#include "core/radial/bone_clusters.h"

#include <algorithm>
#include <numbers>

#include "core/radial/bone_observer.h"
#include "core/radial/distance_field.h"
#include "core/radial/segmentation.h"

namespace cscd::radial {

namespace {

constexpr std::int32_t kUnassigned = -1;

// Grows all clusters at once over shared edges. A triangle without a cluster joins the first cluster that
// reaches it and that `may_join` allows.
template <class MayJoin>
void grow(const TriangleMesh& mesh, std::vector<std::int32_t>& cluster_of, const MayJoin& may_join) {
  std::vector<TriangleId> front;
  for (std::size_t t = 0; t < cluster_of.size(); ++t)
    if (cluster_of[t] != kUnassigned) front.push_back(TriangleId{static_cast<std::int32_t>(t)});
  for (std::size_t next = 0; next < front.size(); ++next) {
    const std::int32_t cluster = cluster_of[+front[next]];
    for (const EdgeId edge : mesh.edges_of(front[next]))
      for (const TriangleId neighbour : mesh.triangles_at(edge))
        if (cluster_of[+neighbour] == kUnassigned && may_join(neighbour, cluster)) {
          cluster_of[+neighbour] = cluster;
          front.push_back(neighbour);
        }
  }
}

}  // namespace

std::vector<BoneId> refine_by_orientation(const TriangleMesh& mesh, std::span<const Vec3> reference,
                                          const Rig& rig, const AtomicClusters& clusters,
                                          std::span<const ObserverKind> kinds) {
  const auto positive = [&](TriangleId triangle, std::int32_t cluster) {
    const auto c = static_cast<std::size_t>(cluster);
    const Bone& bone = rig.reference[+clusters.clusters[c].bone];
    const Triangle& corner = mesh.corners(triangle);
    const auto at_rest = [&](VertexId v) { return MovingPoint{reference[+v], reference[+v]}; };
    return orientation({at_rest(corner[0]), at_rest(corner[1]), at_rest(corner[2])},
                       observer(kinds[c], bone, bone)) == Orientation::positive;
  };

  std::vector<std::int32_t> cluster_of = clusters.of_triangle;
  for (std::size_t t = 0; t < cluster_of.size(); ++t)
    if (!positive(TriangleId{static_cast<std::int32_t>(t)}, cluster_of[t])) cluster_of[t] = kUnassigned;
  grow(mesh, cluster_of, positive);
  grow(mesh, cluster_of, [](TriangleId, std::int32_t) { return true; });

  // Triangles that no cluster has reached return to their given clusters. They form pieces of the surface on
  // which no triangle is positive.
  std::vector<BoneId> bone_of(cluster_of.size());
  for (std::size_t t = 0; t < bone_of.size(); ++t) {
    const std::int32_t c = cluster_of[t] == kUnassigned ? clusters.of_triangle[t] : cluster_of[t];
    bone_of[t] = clusters.clusters[static_cast<std::size_t>(c)].bone;
  }
  return bone_of;
}

double BoneClusterOptions::theta() const {
  return theta_degrees * std::numbers::pi / 180;
}

std::vector<BoneId> bones_of_triangles(const StrategyInput& setup, const BoneClusterOptions& options,
                                       StageClock& clock) {
  clock.enter(Stage::distance_and_heat);
  const int full = resolution_of_mean_edge(setup.mesh, setup.reference);
  std::vector<BoneId> bone_of =
      nearest_bone_by_heat(setup.mesh, setup.reference, *setup.rig,
                           {std::max(1, full / options.coarsening), options.smoothing_passes});
  clock.enter(Stage::decomposition);
  if (!options.refinement) return bone_of;
  const AtomicClusters clusters = make_atomic_clusters(setup.mesh, bone_of);
  const std::vector<ObserverKind> kinds =
      choose_by_rotation_trial(setup.mesh, setup.reference, *setup.rig, clusters, options.theta());
  return refine_by_orientation(setup.mesh, setup.reference, *setup.rig, clusters, kinds);
}

}  // namespace cscd::radial
