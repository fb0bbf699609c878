#pragma once

#include <span>
#include <vector>

#include "core/radial/atomic_clusters.h"
#include "core/radial/bone_observer.h"

namespace cscd::radial {

// Into what the clusters of bones are divided. The 2014 paper counts more atomic clusters than bones (Table
// 1: 199 for 100 bones, 20 for 11, 71 for 40, 21 for 16), and section 4.1 does not say how a second cluster
// of a bone comes about. These are readings that can give more clusters than bones.
enum class Division {
  none,    // one cluster for each bone
  pieces,  // one for each piece of a bone's triangles that hangs together over shared edges: growth under a
           // constraint can cut pieces off
  joints,  // one for each bone and one for each joint between two bones
};

// Splits every cluster into pieces that hang together. The result is ascending by bone, then component, then
// the piece's first triangle.
AtomicClusters divided_into_pieces(const TriangleMesh& mesh, const AtomicClusters& clusters);

struct JointClusters {
  AtomicClusters clusters;
  // [clusters]: true for the cluster of a joint, whose bone is the one that begins at the joint. Its observer
  // is that point (ObserverKind::bone_head).
  std::vector<bool> at_joint;
};

// Gives a triangle to the nearest of the centre of its own bone and the joints at which this bone meets its
// parent and its children, by the triangle's centroid in the reference pose. Bones with one parent that begin
// at one point share a joint. The result is ascending by bone, the cluster of the bone before that of its
// joint.
JointClusters divided_at_joints(const TriangleMesh& mesh, std::span<const Vec3> reference, const Rig& rig,
                                const AtomicClusters& clusters);

}  // namespace cscd::radial
