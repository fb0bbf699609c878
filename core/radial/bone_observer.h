#pragma once

#include <span>
#include <vector>

#include "core/mesh/rig.h"
#include "core/radial/atomic_clusters.h"
#include "core/radial/orientation.h"

namespace cscd::radial {

// What the triangles of a cluster are viewed from: the centre of its bone, the bone as a segment, or the
// joint at which the bone begins.
enum class ObserverKind { bone_centre, bone_segment, bone_head };

// Returns the observer of one bone, from the bone's positions at the start and at the end of an interval.
Observer observer(ObserverKind kind, const Bone& start, const Bone& end);

// Chooses the kind of observer with more positive triangles in the reference pose, and the centre on a tie,
// because it costs less. This is how we read the 2013 method, whose text on it could not be had.
std::vector<ObserverKind> choose_in_reference_pose(const TriangleMesh& mesh, std::span<const Vec3> reference,
                                                   const Rig& rig, const AtomicClusters& clusters);

// Chooses the kind of observer as section 4.2 of the 2014 paper does: the kind with more positive triangles
// on average over four trials, at rest and with the cluster rotated by `theta` radians about x, y and z at
// the bone's head, and the segment on a tie. In a trial the triangles move from the reference pose to the
// rotated one, the centre moves with them, and the segment's two ends are given the centre's velocity (the
// paper's "zero relative velocity").
std::vector<ObserverKind> choose_by_rotation_trial(const TriangleMesh& mesh, std::span<const Vec3> reference,
                                                   const Rig& rig, const AtomicClusters& clusters,
                                                   double theta);

}  // namespace cscd::radial
