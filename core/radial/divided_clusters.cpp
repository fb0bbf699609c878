#include "core/radial/divided_clusters.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "core/base/sort_unique.h"

namespace cscd::radial {
namespace {

// The bone that stands for the joint at a bone's head: the first of all bones with the same parent that begin
// at the same point.
std::size_t joint_of(const Rig& rig, std::size_t bone) {
  for (std::size_t other = 0; other < bone; ++other)
    if (rig.parent[other] == rig.parent[bone] && rig.reference[other].head == rig.reference[bone].head)
      return other;
  return bone;
}

// The joints at which each bone meets its parent and its children, as bones that begin there, ascending.
std::vector<std::vector<std::size_t>> joints_of_bones(const Rig& rig) {
  std::vector<std::vector<std::size_t>> joints(rig.parent.size());
  for (std::size_t bone = 0; bone < rig.parent.size(); ++bone) {
    if (rig.parent[bone] == BoneId{-1}) continue;
    const std::size_t joint = joint_of(rig, bone);
    joints[bone].push_back(joint);
    joints[+rig.parent[bone]].push_back(joint);
  }
  for (std::vector<std::size_t>& own : joints) sort_unique(own);
  return joints;
}

}  // namespace

AtomicClusters divided_into_pieces(const TriangleMesh& mesh, const AtomicClusters& clusters) {
  constexpr std::int32_t none = -1;
  std::vector<std::int32_t> piece_of(mesh.triangle_count(), none);
  std::vector<BoneId> bones;
  std::vector<TriangleId> piece;
  for (const AtomicClusters::Cluster& cluster : clusters.clusters)
    for (const TriangleId first : cluster.triangles) {
      if (piece_of[+first] != none) continue;
      const auto label = static_cast<std::int32_t>(bones.size());
      bones.push_back(cluster.bone);
      piece_of[+first] = label;
      piece.assign(1, first);
      for (std::size_t next = 0; next < piece.size(); ++next)
        for (const EdgeId edge : mesh.edges_of(piece[next]))
          for (const TriangleId neighbour : mesh.triangles_at(edge))
            if (piece_of[+neighbour] == none &&
                clusters.of_triangle[+neighbour] == clusters.of_triangle[+first]) {
              piece_of[+neighbour] = label;
              piece.push_back(neighbour);
            }
    }
  return clusters_of_partition(mesh, std::move(piece_of), bones);
}

JointClusters divided_at_joints(const TriangleMesh& mesh, std::span<const Vec3> reference, const Rig& rig,
                                const AtomicClusters& clusters) {
  const std::vector<std::vector<std::size_t>> joints = joints_of_bones(rig);
  using Key = std::tuple<BoneId, bool, std::int32_t>;  // bone, at its joint, component
  std::vector<Key> key_of;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Triangle& corner = mesh.triangles()[t];
    const Vec3 centroid = (reference[+corner[0]] + reference[+corner[1]] + reference[+corner[2]]) / 3;
    const BoneId bone = clusters.clusters[static_cast<std::size_t>(clusters.of_triangle[t])].bone;
    const Bone& own = rig.reference[+bone];
    Key key{bone, false, mesh.component(TriangleId{static_cast<std::int32_t>(t)})};
    double least = (centroid - (own.head / 2 + own.tail / 2)).squaredNorm();
    for (const std::size_t joint : joints[+bone])
      if (const double off = (centroid - rig.reference[joint].head).squaredNorm(); off < least) {
        least = off;
        std::get<0>(key) = BoneId{static_cast<std::int32_t>(joint)};
        std::get<1>(key) = true;
      }
    key_of.push_back(key);
  }

  std::map<Key, std::int32_t> cluster_of;
  for (const Key& key : key_of) cluster_of.try_emplace(key, 0);
  JointClusters divided;
  std::vector<BoneId> bones;
  for (auto& [key, cluster] : cluster_of) {
    cluster = static_cast<std::int32_t>(bones.size());
    bones.push_back(std::get<0>(key));
    divided.at_joint.push_back(std::get<1>(key));
  }
  std::vector<std::int32_t> of_triangle;
  for (const Key& key : key_of) of_triangle.push_back(cluster_of.at(key));
  divided.clusters = clusters_of_partition(mesh, std::move(of_triangle), bones);
  return divided;
}

}  // namespace cscd::radial
