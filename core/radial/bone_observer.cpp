#include "core/radial/bone_observer.h"

#include <Eigen/Geometry>
#include <array>

namespace cscd::radial {
namespace {

Vec3 centre(const Bone& bone) {
  return bone.head / 2 + bone.tail / 2;
}

// Counts the positive triangles of one cluster in an interval in which every vertex moves from its reference
// position x to moved(x).
template <class Moved>
std::size_t count_positive(const TriangleMesh& mesh, std::span<const Vec3> reference,
                           std::span<const TriangleId> triangles, const Observer& from, const Moved& moved) {
  std::size_t positive = 0;
  for (const TriangleId triangle : triangles) {
    MovingPoint corner[3];
    for (int i = 0; i < 3; ++i) {
      const Vec3& x = reference[+mesh.corners(triangle)[static_cast<std::size_t>(i)]];
      corner[i] = {x, moved(x)};
    }
    positive += orientation(corner, from) == Orientation::positive;
  }
  return positive;
}

}  // namespace

Observer observer(ObserverKind kind, const Bone& start, const Bone& end) {
  if (kind == ObserverKind::bone_segment)
    return Observer::segment({start.head, end.head}, {start.tail, end.tail});
  if (kind == ObserverKind::bone_head) return Observer::point({start.head, end.head});
  return Observer::point({centre(start), centre(end)});
}

std::vector<ObserverKind> choose_in_reference_pose(const TriangleMesh& mesh, std::span<const Vec3> reference,
                                                   const Rig& rig, const AtomicClusters& clusters) {
  std::vector<ObserverKind> kinds;
  const auto at_rest = [](const Vec3& x) { return x; };
  for (const AtomicClusters::Cluster& cluster : clusters.clusters) {
    const Bone& bone = rig.reference[+cluster.bone];
    const auto positive = [&](ObserverKind kind) {
      return count_positive(mesh, reference, cluster.triangles, observer(kind, bone, bone), at_rest);
    };
    kinds.push_back(positive(ObserverKind::bone_segment) > positive(ObserverKind::bone_centre)
                        ? ObserverKind::bone_segment
                        : ObserverKind::bone_centre);
  }
  return kinds;
}

std::vector<ObserverKind> choose_by_rotation_trial(const TriangleMesh& mesh, std::span<const Vec3> reference,
                                                   const Rig& rig, const AtomicClusters& clusters,
                                                   double theta) {
  const std::array<Eigen::Matrix3d, 4> trials = {Eigen::Matrix3d::Identity(),
                                                 Eigen::AngleAxisd(theta, Vec3::UnitX()).toRotationMatrix(),
                                                 Eigen::AngleAxisd(theta, Vec3::UnitY()).toRotationMatrix(),
                                                 Eigen::AngleAxisd(theta, Vec3::UnitZ()).toRotationMatrix()};
  std::vector<ObserverKind> kinds;
  for (const AtomicClusters::Cluster& cluster : clusters.clusters) {
    const Bone& bone = rig.reference[+cluster.bone];
    std::size_t with_centre = 0, with_segment = 0;
    for (const Eigen::Matrix3d& rotation : trials) {
      const auto rotated = [&](const Vec3& x) -> Vec3 { return bone.head + rotation * (x - bone.head); };
      const Vec3 shift = rotated(centre(bone)) - centre(bone);
      const Bone shifted{bone.head + shift, bone.tail + shift};
      with_centre += count_positive(mesh, reference, cluster.triangles,
                                    observer(ObserverKind::bone_centre, bone, shifted), rotated);
      with_segment += count_positive(mesh, reference, cluster.triangles,
                                     observer(ObserverKind::bone_segment, bone, shifted), rotated);
    }
    kinds.push_back(with_centre > with_segment ? ObserverKind::bone_centre : ObserverKind::bone_segment);
  }
  return kinds;
}

}  // namespace cscd::radial
